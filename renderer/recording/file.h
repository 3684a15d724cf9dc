#pragma once
// Recordings in files (.lpath): a header with a schema, then chunks of paths, each with a checksum and an
// index over places, then an end.
//
// All numbers are little-endian; hashes are checksum(). The file begins with "LUCPATHS", its version
// (uint32), the bytes of the header (uint32) and their hash (uint64). The header is JSON: picture, seed,
// scene, names of materials, lights and groups, what was selected, and `schema`: the fields of a path and of
// an event with type, count and offset. A chunk is "CHNK", its number of paths (uint32) and of events
// (uint64), the hash of its paths and events, then these. Behind each is "TREE", its number of leaves
// (uint32) and of rows (uint64), the luminance of all rows (float64) and a hash of all this and of what
// follows: the hashes of the paths (uint64), the leaves (two corners, float32), the rows (path and event,
// uint32; PlaceIndex). The end is "DONE" with the sums over all chunks, and their hash: a file without it was
// cut.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/output_file.h"
#include "recording/place_index.h"

namespace lucerna::recording {

inline constexpr const char* k_file_ending = ".lpath";

/// Writes a file in parts; the file is there after finish(). Throws Error located at the file.
class Writer {
 public:
  /// `names`: picture and names; its paths are ignored. `about`: more for the header: what was selected.
  Writer(const std::filesystem::path& file, const Recording& names, const nlohmann::ordered_json& about = {});
  /// Appends the paths of a recording as a chunk.
  void add(const Recording& part);
  void finish();
  uint64_t paths() const { return paths_; }
  uint64_t events() const { return events_; }

 private:
  OutputFile out_;
  uint64_t paths_ = 0, events_ = 0;
};

/// Reads a file chunk by chunk. Errors are located at the file, and say at which byte: foreign, of another
/// version, cut, damaged.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file);
  /// Picture and names, without paths.
  const Recording& names() const { return names_; }
  const nlohmann::ordered_json& header() const { return header_; }
  /// The next chunk's paths and events, with the names; nullopt at the end of the file. With a box, only
  /// paths that may receive light in it: all that have a row (query.h) with its lit_place() there. Other
  /// paths are then neither read nor checked.
  std::optional<Recording> next(const std::optional<Box>& places = {});
  /// Of the chunks so far, with all their paths.
  uint64_t paths() const { return paths_; }
  uint64_t rows() const { return rows_; }
  double light() const { return light_; }  ///< luminance of all rows

 private:
  [[noreturn]] void refuse(const std::string& what) const;
  void read(void* to, uint64_t bytes, const char* what);
  void move_to(uint64_t at);
  PlaceIndex read_index(uint32_t paths);
  /// Reads these paths of a chunk whose paths begin at byte `begin`.
  void read_paths(const PlaceIndex& index, const std::vector<uint32_t>& which, uint64_t begin,
                  uint64_t events, Recording& into);
  void check(const Recording& chunk, const Path& path, uint64_t events) const;

  std::filesystem::path file_;
  std::ifstream in_;
  uint64_t size_ = 0, at_ = 0;
  Recording names_;
  nlohmann::ordered_json header_;
  uint64_t paths_ = 0, events_ = 0, rows_ = 0;
  double light_ = 0;
};

}  // namespace lucerna::recording
