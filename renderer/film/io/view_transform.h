#pragma once
// How radiance becomes the colours of a display: exposure, then a tone curve or a view of OpenColorIO.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/math.h"
#include "shaders/shared/tone.h"

namespace lucerna::film {

struct ViewTransform {
  float ev = 0;                             ///< exposure: radiance is multiplied by 2^ev
  uint32_t curve = shared::k_tone_neutral;  ///< shared::k_tone_*
  std::string ocio = {};                    ///< ocio_text(), in place of the curve; "": none
  bool operator==(const ViewTransform&) const = default;
};

/// Colours of linear Rec.709 radiance on the display, encoded, 0..1. An `ocio` that cannot be used, because
/// its file has changed, counts as none.
std::vector<vec3> shown_colors(const ViewTransform& view, std::span<const vec3> radiance);
/// Likewise as RGBA bytes, rounded to nearest, alpha 255.
std::vector<uint8_t> shown_picture(const ViewTransform& view, std::span<const vec3> radiance);
/// Encoded colours 0..1 as such bytes.
std::vector<uint8_t> picture_bytes(std::span<const vec3> colors);

/// Luminance of grey radiance from which on it is shown as white: shared::tone_white(), or
/// OcioConfig::white(), over the exposure.
float shown_white(const ViewTransform& view);

}  // namespace lucerna::film
