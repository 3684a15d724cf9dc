#pragma once
// Entrances of distant light. Few paths of the sun and the sky, which cross the disk of the whole scene, pass
// the openings of a house in it. A pilot records the first hits of those that contribute, and further paths
// are aimed there (light_source.h): a line to such a position passes the opening.
#include <vector>

#include "base/math.h"

namespace lucerna::transport {

/// First diffuse surface of a light path, and the path's contribution to the picture from there on.
struct FirstHit {
  vec3 place{0};  ///< [m]
  double contribution = 0;
};

inline constexpr uint32_t k_most_first_hit_boxes = 16;

/// At most k_most_first_hit_boxes boxes around the hits with 95 % of the contribution, slightly enlarged so
/// that none is flat. Empty without any contribution.
std::vector<Box> first_hit_boxes(std::vector<FirstHit> hits);

inline constexpr uint32_t k_most_nested_boxes = 12;

/// Boxes around the centre of these positions (weighted median of each axis) with 50, 80 and 95 % of their
/// weight, and wider ones, four times each, up to `extent` [m] and the farthest position: for places so
/// widely spread that a few clusters would be random. The density of paths aimed at all of them falls with
/// the distance. At most k_most_nested_boxes; empty without weight.
std::vector<Box> nested_boxes(std::vector<FirstHit> places, float extent);

}  // namespace lucerna::transport
