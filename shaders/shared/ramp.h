// Colour ramps of heat maps and of the tiles' overlay, and where a value lies on them. Compiled by C++ and by GLSL, so that
// a legend and the picture beside it agree. Colours are sRGB-encoded, 0..1; ramps are even in perceived lightness, which
// rises all the way, so that they can be read without seeing hues.
#ifndef LUCERNA_SHARED_RAMP_H
#define LUCERNA_SHARED_RAMP_H
#include "shaders/shared/tone.h"
LUCERNA_SHARED_BEGIN
#ifdef __cplusplus
using glm::floor;
#endif

LUCERNA_CONST uint k_ramp_viridis = 0u;
LUCERNA_CONST uint k_ramp_magma = 1u;
LUCERNA_CONST uint k_ramp_tiles = 2u;  ///< far from the target .. at it

// Measured at 17 even places of the ramps of that name (S. van der Walt and N. Smith, 2015; public domain).
LUCERNA_CONST vec3 k_viridis[17] = {
    vec3(0.2671f, 0.0052f, 0.3295f),
    vec3(0.2823f, 0.0952f, 0.4173f),
    vec3(0.2788f, 0.1756f, 0.4834f),
    vec3(0.2589f, 0.2516f, 0.5248f),
    vec3(0.2296f, 0.3224f, 0.5457f),
    vec3(0.1993f, 0.3875f, 0.5546f),
    vec3(0.1726f, 0.4488f, 0.5579f),
    vec3(0.1491f, 0.5081f, 0.5572f),
    vec3(0.1273f, 0.5669f, 0.5506f),
    vec3(0.1205f, 0.6258f, 0.5335f),
    vec3(0.1580f, 0.6838f, 0.5017f),
    vec3(0.2460f, 0.7389f, 0.4520f),
    vec3(0.3692f, 0.7889f, 0.3829f),
    vec3(0.5159f, 0.8312f, 0.2942f),
    vec3(0.6785f, 0.8638f, 0.1894f),
    vec3(0.8456f, 0.8873f, 0.0999f),
    vec3(0.9932f, 0.9062f, 0.1437f)};
LUCERNA_CONST vec3 k_magma[17] = {
    vec3(0.0013f, 0.0000f, 0.0142f),
    vec3(0.0401f, 0.0310f, 0.1334f),
    vec3(0.1132f, 0.0657f, 0.2769f),
    vec3(0.2118f, 0.0620f, 0.4186f),
    vec3(0.3167f, 0.0719f, 0.4854f),
    vec3(0.4147f, 0.1103f, 0.5047f),
    vec3(0.5128f, 0.1482f, 0.5077f),
    vec3(0.6136f, 0.1817f, 0.4985f),
    vec3(0.7164f, 0.2151f, 0.4753f),
    vec3(0.8169f, 0.2560f, 0.4365f),
    vec3(0.9043f, 0.3196f, 0.3881f),
    vec3(0.9610f, 0.4184f, 0.3596f),
    vec3(0.9867f, 0.5356f, 0.3822f),
    vec3(0.9961f, 0.6537f, 0.4462f),
    vec3(0.9969f, 0.7696f, 0.5349f),
    vec3(0.9924f, 0.8844f, 0.6401f),
    vec3(0.9871f, 0.9914f, 0.7495f)};
// OKLab (B. Ottosson, 2020): lightness 0.50 to 0.90 and hue 25 to 140 degrees in even steps, chroma near 0.15: from a dark
// red over amber to a light green. Red and green differ by their lightness first.
LUCERNA_CONST vec3 k_tiles[9] = {
    vec3(0.6884f, 0.1648f, 0.1749f),
    vec3(0.7317f, 0.2803f, 0.1053f),
    vec3(0.7610f, 0.3853f, 0.0263f),
    vec3(0.7792f, 0.4852f, 0.0042f),
    vec3(0.7874f, 0.5825f, 0.0777f),
    vec3(0.7830f, 0.6793f, 0.1700f),
    vec3(0.7599f, 0.7774f, 0.2723f),
    vec3(0.7091f, 0.8773f, 0.3940f),
    vec3(0.6199f, 0.9771f, 0.5410f)};

/// The ramp's colour at t, 0..1 (held to it; NaN counts as 0).
LUCERNA_TONE_FUNCTION vec3 ramp_color(uint ramp, float t) {
  float steps = ramp == k_ramp_tiles ? 8.0f : 16.0f;
  float x = (t > 0.0f ? min(t, 1.0f) : 0.0f) * steps;
  uint i = uint(min(floor(x), steps - 1.0f));
  float f = x - float(i);
  if (ramp == k_ramp_tiles) return mix(k_tiles[i], k_tiles[i + 1u], f);
  if (ramp == k_ramp_magma) return mix(k_magma[i], k_magma[i + 1u], f);
  return mix(k_viridis[i], k_viridis[i + 1u], f);
}

/// Where a value lies between lo and hi (lo < hi; 0 < lo where `logarithmic` is not 0): 0..1, held to it; NaN counts as 0.
LUCERNA_TONE_FUNCTION float ramp_position(float value, float lo, float hi, uint logarithmic) {
  float t = (value - lo) / (hi - lo);
  if (logarithmic != 0u) t = value > lo ? log2(value / lo) / log2(hi / lo) : 0.0f;
  return t > 0.0f ? min(t, 1.0f) : 0.0f;
}

// What the tiles' overlay is told of a tile.
struct TileMark {
  float position;  ///< on k_ramp_tiles; negative: its error is not known
  uint bits;       ///< 0-1 one of k_tile_*, then the flags
};
LUCERNA_CONST uint k_tile_waiting = 0u;  ///< for the minimum of samples
LUCERNA_CONST uint k_tile_active = 1u;
LUCERNA_CONST uint k_tile_done = 2u;
LUCERNA_CONST uint k_tile_capped = 3u;   ///< given up over the target
LUCERNA_CONST uint k_tile_state = 3u;    ///< mask
LUCERNA_CONST uint k_tile_heavy = 4u;    ///< flag: heavy-tailed

struct TilesPush {
  uint width, height;
  uint side;    ///< of a tile, pixels
  uint across;  ///< tiles in a row
  uint line;    ///< width of an outline, pixels
};

struct HeatPush {
  uint width, height;
  uint layer;        ///< k_layer_samples, k_layer_error, k_layer_cost
  uint ramp;         ///< k_ramp_*
  uint logarithmic;  ///< of the scale, from lo to hi
  float lo, hi;
  float unit;        ///< cost: what a vertex took
};

LUCERNA_SHARED_END
#endif
