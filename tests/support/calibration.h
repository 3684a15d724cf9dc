#pragma once
// A picture with its estimated errors, and the comparison of tiles with a noisy reference.
#include "film/error.h"
#include "support/render.h"

namespace lucerna::test {

struct Shot {
  film::ImageError error;
  std::vector<film::TileError> tiles;
  std::vector<float> luminance;
};

inline Shot shot_of(session::Renderer& renderer) {
  finish(renderer);
  Shot shot{renderer.image_error(), renderer.progress().tile_errors(), {}};
  const film::Image image = renderer.image();
  for (size_t i = 0; i < image.samples.size(); ++i)
    shot.luminance.push_back(lucerna::luminance(sum_at(image, i)));
  return shot;
}

/// The tile with the reference's noise added to its own (B. L. Welch 1947).
inline film::TileError with_noise_of(film::TileError tile, const film::TileError& reference) {
  const double vr = reference.standard_error * reference.standard_error,
               va = tile.standard_error * tile.standard_error;
  tile.degrees = (va + vr) * (va + vr) / (va * va / tile.degrees + vr * vr / reference.degrees);
  tile.standard_error = std::sqrt(va + vr);
  return tile;
}

}  // namespace lucerna::test
