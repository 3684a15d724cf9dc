#include "film/io/picture_match.h"

#include <algorithm>
#include <cmath>

#include "film/io/planes.h"

namespace lucerna::film {

FilmImage display_picture(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba) {
  FilmImage image{.width = width, .height = height};
  for (size_t k = 0; k < 3; ++k) {
    std::vector<float> plane(size_t{width} * height);
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(rgba[4 * i + k]) / 255.0f;
    image.channels.emplace_back(std::string(1, "RGB"[k]), std::move(plane));
  }
  return image;
}

PictureMatch match_pictures(const FilmImage& now, const FilmImage& reference, const MatchOptions& options,
                            const std::string& where) {
  if (now.width != reference.width || now.height != reference.height)
    throw_error(where, "is {}x{} pixels; the picture has {}x{}", reference.width, reference.height, now.width,
                now.height);
  constexpr const char* k_expected = "a colour picture";
  const RgbPlanes a = rgb_planes(now, "the picture", k_expected),
                  b = rgb_planes(reference, where, k_expected);
  PictureMatch match;
  size_t cells = 0, over = 0;
  for (uint32_t y0 = 0; y0 < now.height; y0 += options.cell)
    for (uint32_t x0 = 0; x0 < now.width; x0 += options.cell) {
      const uint32_t x1 = std::min(x0 + options.cell, now.width),
                     y1 = std::min(y0 + options.cell, now.height);
      double difference = 0;
      for (size_t k = 0; k < 3; ++k) {
        double sum = 0;
        for (uint32_t y = y0; y < y1; ++y)
          for (uint32_t x = x0; x < x1; ++x) {
            const size_t i = size_t{y} * now.width + x;
            sum += double((*a[k])[i]) - double((*b[k])[i]);
          }
        difference = std::max(difference, std::abs(sum) / (double(x1 - x0) * (y1 - y0)));
      }
      ++cells, over += difference > options.within;
      if (difference > match.largest) match.largest = difference, match.x = x0, match.y = y0;
    }
  match.share = cells ? double(over) / double(cells) : 0;
  match.matches = match.share <= options.share;
  return match;
}

std::string to_text(const PictureMatch& match) {
  return fmt::format("{} in {:.2f} % of its area, most at {},{} ({:.3f})",
                     match.matches ? "matches; other" : "differs", 100 * match.share, match.x, match.y,
                     match.largest);
}

}  // namespace lucerna::film
