#pragma once
// Tone mapping on the host, for files and tests. The maths is in shaders/shared/tone.h, which the device
// compiles too.
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "shaders/shared/tone.h"

namespace lucerna::film {

/// The curves, in the order of the choices of the setting film.tone_curve.
enum class ToneCurve : uint32_t {
  neutral = shared::k_tone_neutral,  ///< Khronos PBR Neutral
  agx = shared::k_tone_agx,          ///< AgX-like
  linear = shared::k_tone_linear,    ///< clamped to 0..1
};

/// 2^ev, what radiance is multiplied with before the curve. `ev` in stops, brighter when larger.
float exposure_factor(float ev);

/// Linear Rec.709 radiance -> sRGB-encoded colour, each channel 0..1. NaN and negative channels count as 0,
/// infinite ones as very bright.
vec3 tone_map(const vec3& radiance, float ev, ToneCurve curve);

/// tone_map of every pixel as 8-bit RGBA, rounded to nearest, alpha 255; for write_png.
std::vector<uint8_t> tone_map_picture(std::span<const vec3> radiance, float ev, ToneCurve curve);

}  // namespace lucerna::film
