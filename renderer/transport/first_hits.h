#pragma once
// Where light from afar gets in. Of the sun's and the sky's paths, which cross the whole scene's disk, few
// come through the openings of a house that stands in it; so a pilot notes where those that come to be of use
// arrive first, and further paths are aimed there (light_source.h): a line to such a place leads through the
// opening.
#include <vector>

#include "base/math.h"

namespace lucerna::transport {

/// Where a path from a light has met its first diffuse surface, and what it has brought to the picture since.
struct FirstHit {
  vec3 place{0};  ///< [m]
  double contribution = 0;
};

inline constexpr uint32_t k_most_first_hit_boxes = 16;

/// At most k_most_first_hit_boxes boxes around the places of those that have brought 95 % of it all, a little
/// wider than these, so that no box is flat. Empty where nothing has brought anything.
std::vector<Box> first_hit_boxes(std::vector<FirstHit> hits);

inline constexpr uint32_t k_most_nested_boxes = 12;

/// Boxes around the middle of these places (the weighted median of each axis), within which lie 50, 80 and
/// 95 % of their weight, and then wider ones up to `extent` [m], four times each: for what is spread so
/// widely that a few clusters would be chance. What is aimed at them all gets ever rarer with the distance.
/// At most k_most_nested_boxes; empty where there is no weight.
std::vector<Box> nested_boxes(std::vector<FirstHit> places, float extent);

}  // namespace lucerna::transport
