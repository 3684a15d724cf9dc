// The screen-space stage of an irradiance cache's placement: where in the picture geometry or irradiance
// changes, on every scale. Read by C++ and GLSL.
//
// It looks at a grid of points over the picture, as a rule one a pixel (shaders/shared/sight.h). Level k of a pyramid over the grid
// has cells of 2^k x 2^k points; those at the right and lower borders hold what is left.
#ifndef LUCERNA_SHARED_IRRADIANCE_CACHE_DISCONTINUITY_H
#define LUCERNA_SHARED_IRRADIANCE_CACHE_DISCONTINUITY_H
#include "shaders/shared/sight.h"
LUCERNA_SHARED_BEGIN

/// What lookups find at all points of the grid.
struct LitPush {
  uint count;
};

/// One level of the pyramid.
struct DetailPush {
  uint across, down;  ///< points of the grid
  uint level;
  uint first, finer;        ///< first entry of this level and of the next finer one in `details`
  float pixel;              ///< width of what a point stands for at a depth of 1 m, or everywhere [m]
  uint parallel;            ///< not 0: everywhere
  float depth_weight;       ///< of the step out of a surface's plane over the cell's width
  float normal_weight;      ///< of the length of the difference of normals
  float irradiance_weight;  ///< of the relative difference of irradiance; 0: geometry counts, else it alone
  float irradiance_noise;   ///< relative difference that does not count
  float least;              ///< luminance that darker irradiance is held against
};

/// Which points become candidates.
struct DitherPush {
  uint across, down;
  uint levels;       ///< of the pyramid
  uint first_level;  ///< the finest that draws
  float density;     ///< candidates a cell of the finest level in which detail is full
  float falloff;     ///< of a point's probability from one level to the next
  float pixel;       ///< as in DetailPush
  uint parallel;
  float finest;     ///< cells narrower than that do not draw [m]
  float flat_side;  ///< `density` candidates in a square of that side where there is no detail [m]; 0: none
  float spacing;  ///< a record nearer than that share of a cell's width satisfies it; 0: any that serves does
  uint key;       ///< of the thresholds
};

struct DiscontinuityDrawPush {
  uint width, height;         ///< of the sheet
  uint across, down, stride;  ///< in its pixels
  uint level, first;  ///< as in DetailPush
};

LUCERNA_SHARED_END
#endif
