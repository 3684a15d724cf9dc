#pragma once
// The part of a picture that a file stores (EXR: data window) within the whole picture (display window).
#include <algorithm>
#include <cstdint>
#include <vector>

namespace lucerna {

struct PictureWindow {
  int64_t x = 0, y = 0;                      ///< of the part's first pixel, from the picture's
  uint32_t width = 0, height = 0;            ///< of the part
  uint32_t full_width = 0, full_height = 0;  ///< of the picture

  bool whole() const { return x == 0 && y == 0 && width == full_width && height == full_height; }
};

/// Reads the window from OpenImageIO's ImageSpec. Files other than EXR store the whole picture unless they
/// give its size; an offset alone is a position on paper.
template <class Spec>
PictureWindow window_of(const Spec& spec, bool is_exr) {
  const auto size = [](int value) { return static_cast<uint32_t>(value); };
  PictureWindow window{0, 0, size(spec.width), size(spec.height), size(spec.width), size(spec.height)};
  if (spec.full_width <= 0 || spec.full_height <= 0) return window;
  if (!is_exr && spec.full_width == spec.width && spec.full_height == spec.height) return window;
  window.x = int64_t{spec.x} - spec.full_x, window.y = int64_t{spec.y} - spec.full_y;
  window.full_width = size(spec.full_width), window.full_height = size(spec.full_height);
  return window;
}

/// The whole picture, 0 outside the part. Pixels of the part outside the picture (overscan) are dropped.
template <class T>
std::vector<T> fit_to_picture(const std::vector<T>& part, size_t channels, const PictureWindow& window) {
  std::vector<T> picture(channels * window.full_width * window.full_height, T(0));
  const int64_t first = std::max<int64_t>(0, window.x);
  const int64_t last = std::min<int64_t>(window.full_width, window.x + window.width);
  for (int64_t row = std::max<int64_t>(0, window.y);
       first < last && row < std::min<int64_t>(window.full_height, window.y + window.height); ++row) {
    const auto from = part.begin() + static_cast<std::ptrdiff_t>(channels) *
                                         ((row - window.y) * window.width + first - window.x);
    std::copy(from, from + static_cast<std::ptrdiff_t>(channels) * (last - first),
              picture.begin() + static_cast<std::ptrdiff_t>(channels) * (row * window.full_width + first));
  }
  return picture;
}

}  // namespace lucerna
