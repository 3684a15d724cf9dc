#pragma once
// Compares a picture with the same picture without one of its effects: what the effect contributes.
#include <cstdint>

namespace lucerna::film {
struct Image;
}

namespace lucerna::pilot {

struct Difference {
  double light = 0;  ///< the effect's part of the picture's mean luminance; below 0: it absorbs light
  /// Root mean square of the change of luminance, in blocks of 8x8 pixels, relative to the luminance there
  /// (LocalLight::scale): how much of the effect is seen. Estimated without the noise of both pictures.
  double seen = 0;
  /// Part of the variance of one sample, over the squared luminance there (of the picture with the effect),
  /// that the effect adds; below 0: the picture without it has more.
  double noise = 0;
};

/// Pictures of one size and one number of samples a pixel, half of them odd.
Difference difference(const film::Image& with, const film::Image& without, uint32_t samples);

}  // namespace lucerna::pilot
