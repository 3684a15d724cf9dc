// Colour ramps of heat maps and of the tile overlay, and the position of a value on them. Compiled by C++ and by GLSL, so that
// a legend and its picture agree. Colours are sRGB-encoded, 0..1; ramps are even in perceived lightness, which
// increases throughout, so that they are readable without hues.
#ifndef LUCERNA_SHARED_RAMP_H
#define LUCERNA_SHARED_RAMP_H
#include "shaders/shared/tone.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_ramp_viridis = 0u;
LUCERNA_CONST uint k_ramp_magma = 1u;
LUCERNA_CONST uint k_ramp_tiles = 2u;  ///< from far above the target to the target

// Minimax polynomials of the ramps of that name (S. van der Walt and N. Smith, 2015; public
// domain), measured at 129 places: 0.013 at most in any channel. t is 0..1.
LUCERNA_TONE_FUNCTION vec3 ramp_viridis(float t) {
  vec3 c = vec3(0.7164f, -1.1696f, 43.3753f);
  c = c * t + vec3(-16.0074f, 3.5737f, -115.6730f);
  c = c * t + vec3(32.3520f, -5.1107f, 112.4065f);
  c = c * t + vec3(-19.7434f, 3.9961f, -47.8133f);
  c = c * t + vec3(3.6607f, -1.9444f, 6.6866f);
  c = c * t + vec3(-0.2745f, 1.5487f, 0.8343f);
  c = c * t + vec3(0.2783f, 0.0088f, 0.3392f);
  return c;
}
LUCERNA_TONE_FUNCTION vec3 ramp_magma(float t) {
  vec3 c = vec3(-23.8458f, 39.3278f, -66.2381f);
  c = c * t + vec3(100.4283f, -153.7940f, 225.6344f);
  c = c * t + vec3(-161.1767f, 233.0279f, -315.6443f);
  c = c * t + vec3(126.6834f, -174.9720f, 235.5424f);
  c = c * t + vec3(-54.0069f, 69.9789f, -95.1389f);
  c = c * t + vec3(13.0003f, -14.0557f, 15.2546f);
  c = c * t + vec3(-0.0967f, 1.4786f, 1.3009f);
  c = c * t + vec3(0.0080f, -0.0108f, 0.0254f);
  return c;
}
/// Even steps in OKLab (B. Ottosson, 2020): lightness 0.50 to 0.90 and hue 25 to 140 degrees, chroma near 0.15: from a dark
/// red over amber to a light green. Red and green differ by their lightness first.
LUCERNA_TONE_FUNCTION vec3 ramp_tiles(float t) {
  vec3 c = vec3(0.2659f, -0.5274f, -2.1756f);
  c = c * t + vec3(-0.7526f, 1.5719f, 15.4691f);
  c = c * t + vec3(0.2652f, -1.9309f, -30.6454f);
  c = c * t + vec3(0.3193f, 1.4033f, 24.5799f);
  c = c * t + vec3(-0.5804f, -0.6974f, -6.8806f);
  c = c * t + vec3(0.4142f, 0.9927f, 0.0332f);
  c = c * t + vec3(0.6883f, 0.1649f, 0.1676f);
  return c;
}

/// The ramp's colour at t, clamped to 0..1; NaN counts as 0.
LUCERNA_TONE_FUNCTION vec3 ramp_color(uint ramp, float t) {
  float x = t > 0.0f ? min(t, 1.0f) : 0.0f;
  vec3 c;
  if (ramp == k_ramp_tiles) c = ramp_tiles(x);
  else if (ramp == k_ramp_magma) c = ramp_magma(x);
  else c = ramp_viridis(x);
  return clamp(c, vec3(0.0f), vec3(1.0f));
}

/// Position of a value between lo and hi (lo < hi; 0 < lo if `logarithmic` is not 0), clamped to 0..1; NaN counts as 0.
LUCERNA_TONE_FUNCTION float ramp_position(float value, float lo, float hi, uint logarithmic) {
  float t = (value - lo) / (hi - lo);
  if (logarithmic != 0u) t = value > lo ? log2(value / lo) / log2(hi / lo) : 0.0f;
  return t > 0.0f ? min(t, 1.0f) : 0.0f;
}

/// Distinct hues of equal lightness for numbered items (OKLab: lightness 0.8, chroma 0.13; the golden angle keeps
/// neighbours apart). Encoded by a square root.
LUCERNA_TONE_FUNCTION vec3 ramp_hue(uint index) {
  float angle = 0.9f + 2.399963f * float(index);
  float a = 0.13f * cos(angle), b = 0.13f * sin(angle);
  vec3 lms = vec3(0.8f + 0.3963377774f * a + 0.2158037573f * b, 0.8f - 0.1055613458f * a - 0.0638541728f * b,
                  0.8f - 0.0894841775f * a - 1.2914855480f * b);
  lms = lms * lms * lms;
  vec3 linear = vec3(dot(lms, vec3(4.0767416621f, -3.3077115913f, 0.2309699292f)),
                     dot(lms, vec3(-1.2684380046f, 2.6097574011f, -0.3413193965f)),
                     dot(lms, vec3(-0.0041960863f, -0.7034186147f, 1.7076147010f)));
  return sqrt(clamp(linear, vec3(0.0f), vec3(1.0f)));
}

// Number of valid records at a pixel: viridis up to this number, 0 in a separate colour.
LUCERNA_CONST float k_overlap_scale = 12.0f;
LUCERNA_CONST vec3 k_unserved_ink = vec3(0.75f, 0.12f, 0.16f);
LUCERNA_CONST vec3 k_gathered_ink = vec3(0.45f, 0.47f, 0.52f);  ///< no valid record: paths gather

// Mark of one tile for the tiles' overlay.
struct TileMark {
  float position;  ///< on k_ramp_tiles; negative: unknown error
  uint bits;       ///< 0-1 one of k_tile_*, then the flags
};
LUCERNA_CONST uint k_tile_waiting = 0u;  ///< waits for the minimum of samples
LUCERNA_CONST uint k_tile_active = 1u;
LUCERNA_CONST uint k_tile_done = 2u;
LUCERNA_CONST uint k_tile_capped = 3u;   ///< stopped by the maximum above the target
LUCERNA_CONST uint k_tile_state = 3u;    ///< mask
LUCERNA_CONST uint k_tile_heavy = 4u;    ///< flag: heavy-tailed

struct TilesPush {
  uint width, height;
  uint side;    ///< side of a tile, pixels
  uint across;  ///< tiles in a row
  uint line;    ///< width of an outline, pixels
};

struct HeatPush {
  uint width, height;
  uint layer;        ///< k_layer_samples, k_layer_error, k_layer_cost
  uint ramp;         ///< k_ramp_*
  uint logarithmic;  ///< not 0: logarithmic scale from lo to hi
  float lo, hi;
  float unit;        ///< cost: time of a vertex
};

LUCERNA_SHARED_END
#endif
