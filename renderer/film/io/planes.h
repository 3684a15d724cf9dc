#pragma once
// Colour pictures as planes of a FilmImage.
#include <span>
#include <string>
#include <vector>

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

}  // namespace lucerna::film
