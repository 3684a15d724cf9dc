// Candidates for records of an irradiance cache, and the choice among them. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_IRRADIANCE_CACHE_PLACEMENT_H
#define LUCERNA_SHARED_IRRADIANCE_CACHE_PLACEMENT_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

// A candidate is a texel of place_texels: position [m] and reach [m]: the distance within which it stands for
// others; and one of facing_texels: normal, bits: facet, from k_place_origin_shift on k_origin_*.
LUCERNA_CONST uint k_place_origin_shift = 22u;

LUCERNA_CONST uint k_morton_bits = 21u;  ///< of the cells of the box around all candidates, along each axis
/// Candidates of a cluster at most. One invocation goes through them once for every one that it chooses, and
/// lavapipe ends all its loops after 65535 iterations.
LUCERNA_CONST uint k_cluster_most = 240u;
LUCERNA_CONST uint k_bounds_runs = 1024u;

/// How far candidates of paths stand for others: the greatest of these.
struct CollectPush {
  uint count;            ///< slots, or points of the grid
  uint samples;          ///< paths a pixel in the slots
  uint to;               ///< position of the first collected one
  uint screen_too;       ///< 0: skips directly visible surfaces
  uint parallel;         ///< parallel view: distances are 1 m, not from the eye
  float spacing;         ///< [m]
  float spacing_beyond;  ///< [m]; of k_origin_recursive
  float spacing_of_distance;
  float cell;   ///< grid: share of its level's cell
  float pixel;  ///< grid: DetailPush::pixel
  vec3 eye;
};

/// The cells that keys are made of.
struct PlacementGrid {
  vec3 origin;
  float scale;   ///< cells a metre, a power of two
  int exponent;  ///< of a cell's width [m], a power of two
};

struct ChoosePush {
  uint count;  ///< candidates; choosing: clusters
  uint seed;
  float normal_tolerance;
};

LUCERNA_SHARED_END
#endif
