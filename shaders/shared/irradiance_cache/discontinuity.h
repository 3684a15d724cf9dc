// The screen-space stage of an irradiance cache's placement: finds changes of geometry or irradiance in the
// picture on every scale. Read by C++ and GLSL.
//
// It uses a grid of points over the picture, usually one a pixel (shaders/shared/sight.h). Level k of a pyramid over the grid
// has cells of 2^k x 2^k points; those at the right and lower borders may be smaller.
#ifndef LUCERNA_SHARED_IRRADIANCE_CACHE_DISCONTINUITY_H
#define LUCERNA_SHARED_IRRADIANCE_CACHE_DISCONTINUITY_H
#include "shaders/shared/sight.h"
LUCERNA_SHARED_BEGIN

/// Lookups at all points of the grid.
struct LitPush {
  uint count;
};

/// One level of the pyramid.
struct DetailPush {
  uint across, down;  ///< points of the grid
  uint level;
  uint first, finer;        ///< first entry of this level and of the next finer one in `details`
  float pixel;              ///< width of a point's cell, at a depth of 1 m unless `parallel` [m]
  uint parallel;            ///< not 0: parallel view, `pixel` holds at all depths
  float depth_weight;       ///< weight of the step out of a surface's plane over the cell's width
  float normal_weight;      ///< weight of the length of the difference of normals
  float irradiance_weight;  ///< weight of the relative difference of irradiance; 0: geometry is used instead
  float irradiance_noise;   ///< relative difference that does not count
  float least;              ///< minimum luminance for relative differences
};

/// Selection of points as candidates.
struct DitherPush {
  uint across, down;
  uint levels;       ///< number of levels of the pyramid
  uint first_level;  ///< finest level that draws candidates
  float density;     ///< candidates per cell of the finest level at full detail
  float falloff;     ///< factor on a point's probability from one level to the next
  float pixel;       ///< as in DetailPush
  uint parallel;
  float finest;     ///< minimum width of cells that draw candidates [m]
  float flat_side;  ///< side of a square with `density` candidates where there is no detail [m]; 0: none
  float spacing;  ///< maximum distance of a record that satisfies a cell, over its width; 0: any valid record does
  uint key;       ///< random key of the thresholds
};

struct DiscontinuityDrawPush {
  uint width, height;         ///< of the sheet
  uint across, down, stride;  ///< in its pixels
  uint level, first;  ///< as in DetailPush
};

LUCERNA_SHARED_END
#endif
