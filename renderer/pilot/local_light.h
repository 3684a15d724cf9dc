#pragma once
// Luminance around pixels, to which errors as seen are relative: the mean of blocks of 8x8 pixels.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "film/film.h"

namespace lucerna::pilot {

class LocalLight {
 public:
  static constexpr uint32_t k_block = 8;  ///< pixels, along each side

  /// Of the sum of all components.
  explicit LocalLight(const film::Image& image);
  size_t blocks() const { return light_.size(); }
  /// Block of a pixel; blocks at the right and lower border may have fewer pixels.
  size_t block_of(size_t pixel) const {
    return pixel / width_ / k_block * across_ + pixel % width_ / k_block;
  }
  double pixels(size_t block) const { return pixels_[block]; }
  /// Mean luminance of the block.
  double light(size_t block) const { return light_[block]; }
  /// Luminance to which an error there is relative: that of the block plus a twentieth of the blocks' median,
  /// since darkness hides noise. Above 0.
  double scale(size_t block) const { return light_[block] + floor_; }

 private:
  uint32_t width_, across_;
  std::vector<double> light_, pixels_;
  double floor_ = 0;
};

}  // namespace lucerna::pilot
