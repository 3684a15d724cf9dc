// The screen-space stage of an irradiance cache's placement: where in the picture geometry or irradiance
// changes, on every scale. Read by C++ and GLSL.
//
// It looks at a grid of points over the picture, as a rule one a pixel. Level k of a pyramid over the grid
// has cells of 2^k x 2^k points; those at the right and lower borders hold what is left.
#ifndef LUCERNA_SHARED_DISCONTINUITY_H
#define LUCERNA_SHARED_DISCONTINUITY_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

// surface_texels: 2 a point, in raster order:
//   0: position, off its surface [m]; depth along the view axis [m], or k_surface_none, k_surface_bent
//   1: smooth normal on the side that is seen; bits facet
LUCERNA_CONST uint k_surface_texels = 2u;
LUCERNA_CONST float k_surface_none = -1.0f;  ///< nothing diffuse is seen
/// What is seen is diffuse, but its normal map leads too far off for records to serve it.
LUCERNA_CONST float k_surface_bent = -2.0f;

/// How the points lie over the picture, for those who ask what a pixel shows.
struct SightGrid {
  uint across;  ///< points a row; 0: nobody has looked yet
  uint stride;  ///< pixels from one to the next
};

/// Rays through points `first` to `first + count` of the grid, one a path slot.
struct SeePush {
  uint first, count;
  uint across, down;  ///< points of the grid
  uint stride;        ///< pixels from one to the next
};

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
  uint width, height;  ///< of the picture
  uint across, down, stride;
  uint level, first;  ///< as in DetailPush
};

LUCERNA_SHARED_END
#endif
