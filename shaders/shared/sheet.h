// The sheet for overlays: the picture at the window's resolution. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_SHEET_H
#define LUCERNA_SHARED_SHEET_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

struct SheetView {
  uint film_width, film_height;
  uint scale;            ///< pixels of the sheet per pixel of the film, along a side
  uint surfaces_known;   ///< not 0: sheet_surfaces has the surface of each pixel of the sheet
};

struct EnlargePush {
  uint width, height;  ///< of the film
  uint scale;
};

LUCERNA_SHARED_END
#endif
