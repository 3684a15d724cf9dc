// Light that paths from lights bring straight to the camera, and where it is summed. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_SPLAT_H
#define LUCERNA_SHARED_SPLAT_H
#include "shaders/shared/wide_sum.h"
LUCERNA_SHARED_BEGIN

/// Sums of a round, in units of SplatFrame::unit, by colour: whole numbers, so that they are the same in whatever order paths
/// come. They cannot wrap: a path brings a pixel less than 2^64 at a time, and less than 2^32 times a round.
struct SplatSum {
  LongSum red, green, blue;
};

/// What kernels know of the round's picture.
struct SplatFrame {
  uint width, height;  ///< of the picture that is complete, which camera.comp reads; 0: none
  uint component;      ///< that it belongs to
  float unit;          ///< of sums, radiance [W m^-2 sr^-1]
};
/// What a path brings at most, in units.
LUCERNA_CONST float k_most_splat = 1.8e19f;

// SplatCounts, uint each.
LUCERNA_CONST uint k_splats_joined = 0u;  ///< vertices that the camera would see, were nothing between
LUCERNA_CONST uint k_splats_pixels = 1u;  ///< that have got light
LUCERNA_CONST uint k_splat_counts = 2u;

struct SplatPush {
  uint count;  ///< pixels
};

LUCERNA_SHARED_END
#endif
