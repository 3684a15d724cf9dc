// Display of the places of an irradiance cache's records during their selection. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_IRRADIANCE_CACHE_PLACEMENT_VIEW_H
#define LUCERNA_SHARED_IRRADIANCE_CACHE_PLACEMENT_VIEW_H
#include "shaders/shared/ramp.h"
LUCERNA_SHARED_BEGIN

// State of a place, in drawing order.
LUCERNA_CONST uint k_placed_candidate = 0u;  ///< candidate only
LUCERNA_CONST uint k_placed_rejected = 1u;   ///< tried, but a wider record covers it
LUCERNA_CONST uint k_placed_tried = 2u;      ///< drawn from its cluster
LUCERNA_CONST uint k_placed_chosen = 3u;     ///< becomes a record
LUCERNA_CONST uint k_placed_mask = 3u;
LUCERNA_CONST uint k_placed_origin_shift = 2u;   ///< 2 bits: k_origin_*
LUCERNA_CONST uint k_placed_cluster_shift = 4u;  ///< remaining bits: 1 + its cluster; 0: unknown

/// A drawn place, with a ring in its plane if it has a radius.
struct PlacedPoint {
  vec3 position;
  uint bits;  ///< k_placed_*
  vec3 normal;
  float radius;  ///< [m]; 0: no ring
};

/// Draws a dot for each of `count` places, and a ring for the first `rings` of them.
struct PlacementPush {
  uint count;
  uint rings;
  float dot;        ///< radius of a candidate's dot [pixels]
  float tried_dot;  ///< ... of a chosen place; other tried ones are smaller
  uint by_cluster;  ///< not 0: candidates are coloured by cluster, else by origin
};

/// Encoded colours of tried places, 0..1, also used by the legend. Chosen places have the accent of records in use.
LUCERNA_CONST vec3 k_tried_ink = vec3(1.0f, 1.0f, 1.0f);
LUCERNA_CONST vec3 k_chosen_ink = vec3(1.0f, 0.86f, 0.45f);
LUCERNA_CONST vec3 k_rejected_ink = vec3(0.62f, 0.62f, 0.62f);
/// Colour of a cluster. Clusters are numbered along a curve; adjacent ones differ in hue, or at least in lightness.
LUCERNA_TONE_FUNCTION vec3 placed_cluster_ink(uint cluster) {
  return (1.0f - 0.2f * float(cluster % 3u)) * ramp_hue(cluster);
}

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::PlacedPoint) == 32);
#endif
#endif
