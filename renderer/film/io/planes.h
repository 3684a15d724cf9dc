#pragma once
// Colour pictures as planes of a FilmImage.
#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/math.h"
#include "film/io/image_file.h"

namespace lucerna::film {

/// Adds three channels from `plane`, each named `prefix` and one of the three `names` ("RGB", "XYZ").
inline void add_plane(FilmImage& out, const std::string& prefix, const char* names,
                      std::span<const vec3> plane) {
  for (int k = 0; k < 3; ++k) {
    std::vector<float> channel(plane.size());
    for (size_t i = 0; i < plane.size(); ++i) channel[i] = plane[i][k];
    out.channels.emplace_back(prefix + names[k], std::move(channel));
  }
}

using RgbPlanes = std::array<const std::vector<float>*, 3>;
/// The channels R, G and B. Throws Error, located at `where`, that names a missing one and what was
/// `expected`.
inline RgbPlanes rgb_planes(const FilmImage& image, const std::string& where, const char* expected) {
  RgbPlanes planes{};
  for (size_t k = 0; k < 3; ++k) {
    planes[k] = image.find(std::string(1, "RGB"[k]));
    if (!planes[k]) throw_error(where, "no channel '{}'; expected {}", "RGB"[k], expected);
  }
  return planes;
}

}  // namespace lucerna::film
