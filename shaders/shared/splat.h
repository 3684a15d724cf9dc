// Sums of the light of light paths that are connected to the camera. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_SPLAT_H
#define LUCERNA_SHARED_SPLAT_H
#include "shaders/shared/wide_sum.h"
LUCERNA_SHARED_BEGIN

// The sums of a round are LongSum, in units of SplatFrame::unit, in one buffer per colour channel, which is smaller than a
// pixel of the film. Integers, so that the order of paths does not matter. They cannot wrap: a path contributes less than
// 2^64 to a pixel at a time, and fewer than 2^32 times per round.

/// Group of a pixel's light by colour channel, with compact groups (LUCERNA_GROUP_SUMS): that of one path, drawn in
/// proportion to its share of the sum, so each group's light is unbiased. Each of n paths draws an exponential number with
/// its light as the rate; the minimum belongs to path i with the probability of its share (P. Efraimidis and P. Spirakis,
/// "Weighted Random Sampling with a Reservoir", 2006), and does not depend on the order. The bits of a nonnegative float
/// sort like it; the last four of them store the group.
struct SplatOwners {
  uint red, green, blue;
};
LUCERNA_CONST uint k_splat_owner_bits = 4u;  ///< k_most_groups

/// Parameters of the round's picture.
struct SplatFrame {
  uint width, height;  ///< size of the complete picture, which camera.comp reads; 0: none
  uint component;      ///< component of that picture
  float unit;          ///< unit of the sums, radiance [W m^-2 sr^-1]
  uint first, pixels;  ///< band of pixels being summed: first pixel and number
};
/// Maximum contribution of a path, in units.
LUCERNA_CONST float k_most_splat = 1.8e19f;

// SplatCounts, uint each.
LUCERNA_CONST uint k_splats_joined = 0u;  ///< vertices in view, before the visibility test
LUCERNA_CONST uint k_splats_pixels = 1u;  ///< pixels that received light
LUCERNA_CONST uint k_splat_counts = 2u;

struct SplatPush {
  uint count;  ///< pixels of the band
};

LUCERNA_SHARED_END
#endif
