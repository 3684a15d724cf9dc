// Visible surfaces of the picture's pixels, found by rays through their centres. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_SIGHT_H
#define LUCERNA_SHARED_SIGHT_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

// surface_texels: 2 a point, in raster order:
//   0: position, off its surface [m]; depth along the view axis [m], or k_surface_none, k_surface_bent
//   1: smooth normal on the side that is seen; bits facet | media << k_surface_media_shift, where these are noted
LUCERNA_CONST uint k_surface_texels = 2u;
LUCERNA_CONST uint k_surface_media_shift = 22u;
LUCERNA_CONST uint k_surface_media = 1u << 10;  ///< media numbers are below this
LUCERNA_CONST float k_surface_none = -1.0f;  ///< no diffuse surface
/// The surface is diffuse, but its normal map is too steep for stored light, or too many media enclose it.
LUCERNA_CONST float k_surface_bent = -2.0f;

/// Grid of the traced points over the picture.
struct SightGrid {
  uint across;  ///< points per row; 0: not traced yet
  uint stride;  ///< pixels from one to the next
};

/// Rays through points `first` to `first + count` of the grid, one a path slot.
struct SeePush {
  uint first, count;
  uint across, down;  ///< points of the grid
  uint stride;        ///< pixels from one to the next
};

LUCERNA_SHARED_END
#endif
