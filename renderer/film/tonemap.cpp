#include "film/tonemap.h"

#include <cmath>

namespace lucerna::film {

float exposure_factor(float ev) { return std::exp2(ev); }

vec3 tone_map(const vec3& radiance, float ev, ToneCurve curve) {
  return shared::tone_map(radiance * exposure_factor(ev), static_cast<uint32_t>(curve));
}

std::vector<uint8_t> tone_map_picture(std::span<const vec3> radiance, float ev, ToneCurve curve) {
  std::vector<uint8_t> rgba;
  rgba.reserve(radiance.size() * 4);
  for (const vec3& pixel : radiance) {
    const vec3 bytes = tone_map(pixel, ev, curve) * 255.0f + 0.5f;
    for (int c = 0; c < 3; ++c) rgba.push_back(static_cast<uint8_t>(bytes[c]));
    rgba.push_back(255);
  }
  return rgba;
}

}  // namespace lucerna::film
