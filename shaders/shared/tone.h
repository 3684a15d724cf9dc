// Tone curves: from exposed linear Rec.709 radiance to display values. Compiled by C++ and by GLSL, so that the
// window, PNG files and tests see one and the same curve. All functions take any value: NaN and negative values count as
// black, infinity as the largest value; results are finite and in 0..1.
#ifndef LUCERNA_SHARED_TONE_H
#define LUCERNA_SHARED_TONE_H
#include "shaders/shared/compat.h"
#ifdef __cplusplus
#define LUCERNA_TONE_FUNCTION inline
#else
#define LUCERNA_TONE_FUNCTION
#endif
LUCERNA_SHARED_BEGIN
#ifdef __cplusplus
using glm::abs;
using glm::clamp;
using glm::cos;
using glm::dot;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::pow;
using glm::sin;
using glm::sqrt;
#endif

// In the order of the setting's choices (film.tone_curve).
LUCERNA_CONST uint k_tone_neutral = 0u;
LUCERNA_CONST uint k_tone_agx = 1u;
LUCERNA_CONST uint k_tone_linear = 2u;

LUCERNA_CONST float k_tone_largest = 65504.0f;  ///< larger radiance looks the same

LUCERNA_TONE_FUNCTION float tone_finite(float x) { return x > 0.0f ? min(x, k_tone_largest) : 0.0f; }
LUCERNA_TONE_FUNCTION vec3 tone_finite(vec3 c) { return vec3(tone_finite(c.x), tone_finite(c.y), tone_finite(c.z)); }

/// Linear 0..1 to the sRGB encoding (IEC 61966-2-1).
LUCERNA_TONE_FUNCTION float srgb_encode(float x) {
  return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f;
}
LUCERNA_TONE_FUNCTION vec3 srgb_encode(vec3 c) { return vec3(srgb_encode(c.x), srgb_encode(c.y), srgb_encode(c.z)); }

/// Khronos PBR Neutral (specification 1.0, Khronos Group 2024), linear to linear. A base colour seen under white light of
/// strength 1 with the 4 % reflection of a dielectric on top comes out as itself up to 0.8 - 0.04; what is brighter is
/// compressed towards 1 by its largest channel and then desaturated, with no shift of hue.
LUCERNA_TONE_FUNCTION vec3 tone_neutral(vec3 c) {
  const float k_f90 = 0.04f, k_start = 0.8f - 0.04f, k_desaturation = 0.15f;
  float low = min(c.x, min(c.y, c.z));
  float offset = low < 2.0f * k_f90 ? low - low * low / (4.0f * k_f90) : k_f90;
  c = c - vec3(offset);
  float peak = max(c.x, max(c.y, c.z));
  if (peak < k_start) return c;
  float room = 1.0f - k_start;
  float new_peak = 1.0f - room * room / (peak + room - k_start);
  float keep = 1.0f / (k_desaturation * (peak - new_peak) + 1.0f);
  return mix(vec3(new_peak), c * (new_peak / peak), keep);
}

/// One channel of the AgX-like curve: position x (0..1) on the logarithmic scale to display value (0..1, encoded with the
/// power 2.2). Middle grey stays where it is: x = 10/16.5 gives 0.18^(1/2.2). About that pivot the curve is
/// y = y0 + s u / (1 + |u|^p)^(1/p), u = slope (x - x0) / s, with p = 1.5 and slope 2.4; s follows, on each side, from
/// the end of the scale reaching 0 or 1: s = (dy^-p - (slope dx)^-p)^(-1/p).
LUCERNA_TONE_FUNCTION float tone_agx_curve(float x) {
  const float k_x0 = 10.0f / 16.5f, k_y0 = 0.458656447f, k_slope = 2.4f;
  const float k_toe = 0.522289828f, k_shoulder = 0.790466852f;
  float s = x < k_x0 ? k_toe : k_shoulder;
  float u = k_slope * (x - k_x0) / s;
  return clamp(k_y0 + s * u / pow(1.0f + pow(abs(u), 1.5f), 2.0f / 3.0f), 0.0f, 1.0f);
}

/// AgX-like, linear to linear; the idea is Troy Sobotka's (AgX, 2022): colours are drawn in towards white before a
/// per-channel curve, so that strong lights bleach instead of turning into pure primaries, and drawn out again
/// afterwards. Here the primaries move 20 % of the way to white in CIE xy (Rec.709, D65); the matrix follows from that
/// alone and a test derives it. The scale is his: 10 stops below to 6.5 above middle grey.
LUCERNA_TONE_FUNCTION vec3 tone_agx(vec3 c) {
  const mat3 k_inset = mat3(0.842398929f, 0.042398929f, 0.042398929f,   // columns
                            0.078430165f, 0.878430165f, 0.078430165f,
                            0.079170906f, 0.079170906f, 0.879170906f);
  const mat3 k_outset = mat3(1.197001339f, -0.052998661f, -0.052998661f,
                             -0.098037706f, 1.151962294f, -0.098037706f,
                             -0.098963632f, -0.098963632f, 1.151036368f);
  c = k_inset * c;
  c = max(c, vec3(1e-10f));
  vec3 x = clamp((log2(c * (1.0f / 0.18f)) + vec3(10.0f)) * (1.0f / 16.5f), vec3(0.0f), vec3(1.0f));
  vec3 display = vec3(tone_agx_curve(x.x), tone_agx_curve(x.y), tone_agx_curve(x.z));
  return k_outset * pow(display, vec3(2.2f));
}

/// Exposed linear radiance -> sRGB-encoded colour, each channel 0..1. `curve` is one of k_tone_*; others are linear.
LUCERNA_TONE_FUNCTION vec3 tone_map(vec3 radiance, uint curve) {
  vec3 c = tone_finite(radiance);
  if (curve == k_tone_neutral) c = tone_neutral(c);
  if (curve == k_tone_agx) c = tone_agx(c);
  return srgb_encode(clamp(c, vec3(0.0f), vec3(1.0f)));
}

/// The exposed luminance from which a curve shows a grey as white: less than about a tenth of a relative change of it is
/// seen, and none where the curve is cut off. linear: 1, neutral: 1.5, agx: the end of its scale.
LUCERNA_TONE_FUNCTION float tone_white(uint curve) {
  return curve == k_tone_neutral ? 1.5f : curve == k_tone_agx ? 16.3f : 1.0f;
}

LUCERNA_SHARED_END
#endif
