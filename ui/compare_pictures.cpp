#include "compare_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "commands/view_transform.h"
#include "film/tonemap.h"

namespace lucerna::ui {

session::HeldPicture reduced(const session::HeldPicture& picture, uint32_t width) {
  const uint32_t side = std::max(1u, (picture.width + width - 1) / std::max(1u, width));
  session::HeldPicture small{.width = std::max(1u, picture.width / side),
                             .height = std::max(1u, picture.height / side),
                             .light = {},
                             .displayed = picture.displayed};
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

std::vector<uint8_t> ComparePictures::displayed(const session::HeldPicture& picture) const {
  if (!picture.displayed) return film::shown_picture(commands::view_transform(open_), picture.light);
  std::vector<vec3> colors = picture.light;
  for (vec3& c : colors) c = shared::srgb_encode(c);
  return film::picture_bytes(colors);
}

unsigned ComparePictures::held(const commands::HeldResult& held) const {
  if (!texture) return 0;
  return texture("held", fmt::format("{} {}", held.id, display()), false, [&] {
    return PictureBytes{held.picture->width, held.picture->height, displayed(*held.picture)};
  });
}

unsigned ComparePictures::thumbnail(const commands::HeldResult& held, uint32_t width) const {
  if (!texture) return 0;
  return texture(fmt::format("thumbnail {}", held.id), fmt::format("{} {}", width, display()), true, [&] {
    const session::HeldPicture small = reduced(*held.picture, width);
    return PictureBytes{small.width, small.height, displayed(small)};
  });
}

unsigned ComparePictures::difference(const commands::Comparing& compare,
                                     const commands::HeldResult& held) const {
  const auto live = compare.live.light();
  if (!texture || !live || live->light.size() != held.picture->light.size()) return 0;
  const float times = compare.results.difference_times;
  const std::string content = fmt::format("{} {} {} {}", held.id, compare.live.version(), times,
                                          held.picture->displayed ? display() : open_.setting("film.ev"));
  return texture("difference", content, false, [&] {
    if (held.picture->displayed) {
      const std::vector<vec3> shown = film::shown_light(commands::view_transform(open_), live->light);
      return PictureBytes{live->width, live->height,
                          film::difference_colors(shown, held.picture->light, times)};
    }
    const float gain = times * film::exposure_factor(static_cast<float>(open_.setting_real("film.ev")));
    return PictureBytes{live->width, live->height,
                        film::difference_colors(live->light, held.picture->light, gain)};
  });
}

}  // namespace lucerna::ui
