#include "compare_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/error.h"
#include "film/io/ocio.h"
#include "film/tonemap.h"

namespace lucerna::ui {

session::HeldPicture reduced(const session::HeldPicture& picture, uint32_t width) {
  const uint32_t side = std::max(1u, (picture.width + width - 1) / std::max(1u, width));
  session::HeldPicture small{.width = std::max(1u, picture.width / side),
                             .height = std::max(1u, picture.height / side),
                             .light = {}};
  small.light.assign(size_t{small.width} * small.height, vec3(0));
  for (uint32_t y = 0; y < small.height; ++y)
    for (uint32_t x = 0; x < small.width; ++x) {
      vec3 sum(0);
      float count = 0;
      for (uint32_t v = y * side; v < std::min(picture.height, (y + 1) * side); ++v)
        for (uint32_t u = x * side; u < std::min(picture.width, (x + 1) * side); ++u)
          sum += picture.light[size_t{v} * picture.width + u], ++count;
      small.light[size_t{y} * small.width + x] = sum / std::max(count, 1.0f);
    }
  return small;
}

std::string ComparePictures::display() const {
  return open_.setting("film.ev") + " " + open_.setting("film.tone_curve") + " " + open_.setting("film.ocio");
}

namespace {

/// The light by the display and view of film.ocio; empty if it is not used, or has become unreadable.
std::vector<uint8_t> displayed_by_ocio(std::span<const vec3> light, float ev, const std::string& ocio) {
  if (ocio.empty()) return {};
  try {
    const auto config = film::ocio_config();
    if (!config) return {};
    std::vector<vec3> colors(light.begin(), light.end());
    for (vec3& c : colors) c *= film::exposure_factor(ev);
    const auto [display, view] = config->split(ocio);
    config->show(display, view, colors);
    std::vector<uint8_t> rgba;
    rgba.reserve(4 * colors.size());
    for (const vec3& c : colors) {
      for (int k = 0; k < 3; ++k)
        rgba.push_back(static_cast<uint8_t>((c[k] > 0 ? std::min(c[k], 1.0f) : 0) * 255 + 0.5f));
      rgba.push_back(255);
    }
    return rgba;
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

std::vector<uint8_t> ComparePictures::displayed(std::span<const vec3> light) const {
  const auto ev = static_cast<float>(open_.setting_real("film.ev"));
  if (std::vector<uint8_t> rgba = displayed_by_ocio(light, ev, open_.setting("film.ocio")); !rgba.empty())
    return rgba;
  const std::vector<std::string>& curves = plan::find_option("film.tone_curve")->choices;
  const auto curve =
      std::find(curves.begin(), curves.end(), open_.setting("film.tone_curve")) - curves.begin();
  return film::tone_map_picture(light, ev, static_cast<film::ToneCurve>(curve));
}

unsigned ComparePictures::held(const commands::HeldResult& held) const {
  if (!texture) return 0;
  return texture("held", fmt::format("{} {}", held.id, display()), false, [&] {
    return PictureBytes{held.picture->width, held.picture->height, displayed(held.picture->light)};
  });
}

unsigned ComparePictures::thumbnail(const commands::HeldResult& held, uint32_t width) const {
  if (!texture) return 0;
  return texture(fmt::format("thumbnail {}", held.id), fmt::format("{} {}", width, display()), true, [&] {
    const session::HeldPicture small = reduced(*held.picture, width);
    return PictureBytes{small.width, small.height, displayed(small.light)};
  });
}

unsigned ComparePictures::difference(const commands::Comparing& compare,
                                     const commands::HeldResult& held) const {
  const auto live = compare.live.light();
  if (!texture || !live || live->light.size() != held.picture->light.size()) return 0;
  const float times = compare.results.difference_times;
  const std::string content =
      fmt::format("{} {} {} {}", held.id, compare.live.version(), times, open_.setting("film.ev"));
  return texture("difference", content, false, [&] {
    const float gain = times * film::exposure_factor(static_cast<float>(open_.setting_real("film.ev")));
    return PictureBytes{live->width, live->height,
                        film::difference_colors(live->light, held.picture->light, gain)};
  });
}

}  // namespace lucerna::ui
