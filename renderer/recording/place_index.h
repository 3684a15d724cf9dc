#pragma once
// A tree over the places at which the light of recorded paths is received, so that a search in a part of the
// scene reads only the paths that it needs. One per chunk of a file (file.h).
//
// Rows (query.h) are sorted along a Morton curve (G. M. Morton, 1966) and grouped into leaves of up to
// k_leaf_rows; each leaf has the box of its places.
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/math.h"
#include "recording/recording.h"

namespace lucerna::recording {

/// Where the light of an event is received: the surface that scatters it to the path, or, of light seen
/// directly, the emitter itself [m].
vec3 lit_place(std::span<const Event> path, uint32_t event);

struct PlaceIndex {
  static constexpr uint32_t k_leaf_rows = 16;
  struct Row {
    uint32_t path, event;  ///< its number in the path
  };
  std::vector<Box> leaves;
  std::vector<Row> rows;       ///< k_leaf_rows for each leaf, fewer for the last
  double light = 0;            ///< luminance of all rows
  std::vector<uint64_t> hash;  ///< by path, of it and its events: they are read alone
};

PlaceIndex make_place_index(const Recording& recording);
/// Paths with a row in a leaf that meets the box, ascending. They include all that have a row in the box.
std::vector<uint32_t> paths_in(const PlaceIndex& index, const Box& box);

/// Checksum of bytes, 64 bits: FNV-1a over words of 8 bytes, the last one filled with zeros. Any change of
/// one word changes it.
uint64_t checksum(std::string_view bytes, uint64_t before = 0xcbf29ce484222325ull);
uint64_t path_checksum(const Path& path, std::span<const Event> events);

}  // namespace lucerna::recording
