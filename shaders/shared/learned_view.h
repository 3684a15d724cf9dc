// Display of learned light selection (shaders/shared/learned_lights.h). Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_LEARNED_VIEW_H
#define LUCERNA_SHARED_LEARNED_VIEW_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// The surface that a pixel shows.
struct LearnedPoint {
  vec3 position;
  uint solid;   ///< 0: no surface, no row
  vec3 normal;  ///< unit
  uint row;     ///< row of learned_rows at the surface
};

struct LearnedViewPush {
  uint width, height;
  uint pixel;  ///< inspected pixel
  uint rows;   ///< number of rows with a share of unblocked shadow rays
};

LUCERNA_SHARED_END
#endif
