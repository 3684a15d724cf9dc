// The film's layout and what tone mapping is told. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_FILM_H
#define LUCERNA_SHARED_FILM_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// Sum of half of a pixel's samples of one component: the value is sum + compensation. Radiance.
struct FilmHalf {
  vec3 sum;
  vec3 compensation;
};

struct FilmPush {
  uint width, height;
  uint first_tile;       ///< 8x8 tiles in raster order
  uint pixel_count;      ///< slots a sample: tiles * 64
  uint first_sample;
  uint sample_count;
};

LUCERNA_CONST uint k_layer_beauty = 0u;   ///< sum of the shown components
LUCERNA_CONST uint k_layer_primary = 1u;  ///< ... to 4: one component
LUCERNA_CONST uint k_layer_albedo = 5u;
LUCERNA_CONST uint k_layer_normal = 6u;
LUCERNA_CONST uint k_layer_depth = 7u;
LUCERNA_CONST uint k_layer_samples = 8u;

struct TonePush {
  uint width, height;
  uint layer;
  uint show;             ///< bit i: component i is part of the beauty layer
  uint curve;            ///< ToneCurve
  float exposure;        ///< factor, 2^EV
  float scale;           ///< depth and samples: value shown white
  uint coarse_width, coarse_height;  ///< of the coarse film; 0: none
  uint use_coarse_film;  ///< 1: this dispatch reads the coarse film and fills pixels that the film has not reached
};

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::FilmHalf) == 24);
#endif
#endif
