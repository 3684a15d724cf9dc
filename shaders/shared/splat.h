// Light that paths from lights bring straight to the camera, and where it is summed. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_SPLAT_H
#define LUCERNA_SHARED_SPLAT_H
#include "shaders/shared/wide_sum.h"
LUCERNA_SHARED_BEGIN

// Sums of a round are LongSum, in units of SplatFrame::unit, in a buffer for each colour, which so is smaller than a pixel of
// the film: whole numbers, so that they are the same in whatever order paths come. They cannot wrap: a path brings a pixel less
// than 2^64 at a time, and less than 2^32 times a round.

/// Whose light a pixel's is, by colour, where groups of lights are kept in short (LUCERNA_GROUP_SUMS): that of one path, drawn
/// with the probability of its share of the sum, so that each group's light is expected right. Of n paths, each with an
/// exponential number of a rate that is its light, the least is path i's with the probability of its share (P. Efraimidis and
/// P. Spirakis, "Weighted Random Sampling with a Reservoir", 2006): a minimum, which does not depend on the order. The bits of a
/// float not below 0 are ordered as it is; the last four of them are the group.
struct SplatOwners {
  uint red, green, blue;
};
LUCERNA_CONST uint k_splat_owner_bits = 4u;  ///< k_most_groups

/// What kernels know of the round's picture.
struct SplatFrame {
  uint width, height;  ///< of the picture that is complete, which camera.comp reads; 0: none
  uint component;      ///< that it belongs to
  float unit;          ///< of sums, radiance [W m^-2 sr^-1]
  uint first, pixels;  ///< of the band of pixels that is summed: the first one, and how many there are
};
/// What a path brings at most, in units.
LUCERNA_CONST float k_most_splat = 1.8e19f;

// SplatCounts, uint each.
LUCERNA_CONST uint k_splats_joined = 0u;  ///< vertices that the camera would see, were nothing between
LUCERNA_CONST uint k_splats_pixels = 1u;  ///< that have got light
LUCERNA_CONST uint k_splat_counts = 2u;

struct SplatPush {
  uint count;  ///< pixels of the band
};

LUCERNA_SHARED_END
#endif
