#pragma once
// Histogram of the shown picture.
#include <array>
#include <cstdint>
#include <span>

#include "layout.h"
#include "session/session.h"

namespace lucerna::ui {

/// Numbers of pixels by their value on the display.
struct Histogram {
  static constexpr size_t k_bins = 256;
  enum Curve : size_t { red, green, blue, luma, curves };
  /// Of the encoded channels, and of luma, their sum with the weights of Rec.709.
  std::array<std::array<uint32_t, k_bins>, curves> counts{};
  uint32_t pixels = 0;
  uint32_t white = 0;  ///< with a channel at its maximum
  uint32_t black = 0;  ///< with all channels 0
};
/// `rgba`: four bytes a pixel.
Histogram histogram_of(std::span<const uint8_t> rgba);

/// Keeps the histogram of the newest picture.
class HistogramView {
 public:
  bool on = false;
  /// Draws it over the lower right corner of the picture, or of the `room` around a small one; nothing where
  /// there is no room.
  void draw(const session::Snapshot& picture, const Area& frame, const Area& room);

 private:
  uint64_t id_ = 0;
  Histogram histogram_;
};

}  // namespace lucerna::ui
