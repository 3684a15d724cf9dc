// Candidates for records of an irradiance cache, and their selection. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_IRRADIANCE_CACHE_PLACEMENT_H
#define LUCERNA_SHARED_IRRADIANCE_CACHE_PLACEMENT_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

// A candidate is a texel of place_texels: position [m] and reach [m], the distance within which it represents
// others; and one of facing_texels: normal, bits: facet, k_origin_* from k_place_origin_shift.
LUCERNA_CONST uint k_place_origin_shift = 22u;

LUCERNA_CONST uint k_morton_bits = 21u;  ///< bits of a cell's coordinate along each axis of the box around all candidates
/// Maximum candidates of a cluster. One invocation iterates over them once for every chosen one, and lavapipe
/// ends loops after 65535 iterations.
LUCERNA_CONST uint k_cluster_most = 240u;
LUCERNA_CONST uint k_bounds_runs = 1024u;

/// Parameters of the reach of candidates from paths, the maximum of several.
struct CollectPush {
  uint count;            ///< slots, or points of the grid
  uint samples;          ///< paths a pixel in the slots
  uint to;               ///< position of the first collected one
  uint screen_too;       ///< 0: skips directly visible surfaces
  uint parallel;         ///< parallel view: distances are 1 m, not from the eye
  float spacing;         ///< [m]
  float spacing_beyond;  ///< likewise, for k_origin_recursive [m]
  float spacing_of_distance;
  float cell;   ///< grid: share of its level's cell
  float pixel;  ///< grid: DetailPush::pixel
  vec3 eye;
};

/// Grid of the sort keys.
struct PlacementGrid {
  vec3 origin;
  float scale;   ///< cells a metre, a power of two
  int exponent;  ///< binary exponent of a cell's width [m]
};

struct ChoosePush {
  uint count;  ///< number of candidates; in the selection: of clusters
  uint seed;
  float normal_tolerance;
};

LUCERNA_SHARED_END
#endif
