// Records that know each other: what the kernels are told that bound radii by the records around. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_IRRADIANCE_CACHE_NEIGHBOURS_H
#define LUCERNA_SHARED_IRRADIANCE_CACHE_NEIGHBOURS_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// Neighbours of a record that are looked at in different directions.
LUCERNA_CONST uint k_neighbours = 12u;
/// A pair's key: the record, above that many bits of its distance. A float below 1 has as many.
LUCERNA_CONST uint k_neighbour_distance_bits = 30u;

struct NeighbourPush {
  uint count;    ///< of the records
  uint pairs;    ///< bound.comp: of all
  float apart;   ///< cosine of the least angle between two neighbours' directions
  float gap;     ///< greatest angle between directions next to each other, all around a record that is bounded [radians]
};

LUCERNA_SHARED_END
#endif
