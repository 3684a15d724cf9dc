// What is shown of lights that are learned (shaders/shared/learned_lights.h). Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_LEARNED_VIEW_H
#define LUCERNA_SHARED_LEARNED_VIEW_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// The surface that a pixel shows.
struct LearnedPoint {
  vec3 position;
  uint solid;   ///< 0: none, and no row
  vec3 normal;  ///< unit
  uint row;     ///< of learned_rows, that serves it
};

struct LearnedViewPush {
  uint width, height;
  uint pixel;  ///< that is inspected
  uint rows;   ///< of which the share of rays that arrive is given
};

LUCERNA_SHARED_END
#endif
