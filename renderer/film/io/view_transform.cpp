#include "film/io/view_transform.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "film/io/ocio.h"

namespace lucerna::film {
namespace {

/// Exposed radiance by the display and view of `ocio`; nullopt: there is none, or it cannot be used.
std::optional<std::vector<vec3>> colors_by_ocio(const std::string& ocio, std::vector<vec3> exposed) {
  if (ocio.empty()) return std::nullopt;
  try {
    const auto config = ocio_config();
    if (!config) return std::nullopt;
    const auto [display, name] = config->split(ocio);
    config->show(display, name, exposed);
  } catch (const Error&) {
    return std::nullopt;
  }
  for (vec3& c : exposed)
    for (int k = 0; k < 3; ++k) c[k] = c[k] > 0 ? std::min(c[k], 1.0f) : 0;  // NaN becomes black
  return exposed;
}

}  // namespace

std::vector<vec3> shown_colors(const ViewTransform& view, std::span<const vec3> radiance) {
  std::vector<vec3> colors(radiance.begin(), radiance.end());
  const float exposure = std::exp2(view.ev);
  for (vec3& c : colors) c *= exposure;
  if (auto shown = colors_by_ocio(view.ocio, colors)) return std::move(*shown);
  for (vec3& c : colors) c = shared::tone_map(c, view.curve);
  return colors;
}

std::vector<uint8_t> picture_bytes(std::span<const vec3> colors) {
  std::vector<uint8_t> rgba;
  rgba.reserve(4 * colors.size());
  for (const vec3& c : colors) {
    for (int k = 0; k < 3; ++k) rgba.push_back(static_cast<uint8_t>(c[k] * 255 + 0.5f));
    rgba.push_back(255);
  }
  return rgba;
}

std::vector<uint8_t> shown_picture(const ViewTransform& view, std::span<const vec3> radiance) {
  return picture_bytes(shown_colors(view, radiance));
}

float shown_white(const ViewTransform& view) {
  const float exposure = std::exp2(view.ev);
  if (!view.ocio.empty()) {
    try {
      if (const auto config = ocio_config()) {
        const auto [display, name] = config->split(view.ocio);
        return config->white(display, name) / exposure;
      }
    } catch (const Error&) {
    }
  }
  return shared::tone_white(view.curve) / exposure;
}

}  // namespace lucerna::film
