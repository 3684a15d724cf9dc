#pragma once
// What a render has cost so far and how good it is: one line each time the work has grown by a quarter or
// half, so that the whole story of a long render is a few dozen lines, evenly spaced in log time.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error_sum.h"

namespace lucerna::stats {

inline constexpr int k_layers = 5;  ///< the sum, then primary, secondary, tertiary, caustic
extern const std::array<const char*, k_layers> k_layer_names;

/// A forecast as a band; low <= middle <= high.
struct Band {
  double low = 0, middle = 0, high = 0;
};

struct Entry {
  /// Wall time from the image's first work on, without pauses. Includes display, error estimates and
  /// comparison with a reference. Forecasts use this time.
  double wall_s = 0;
  double render_s = 0;  ///< of that, spent tracing: the time of the same picture without display
  /// Part of wall_s and of the rays spent on lookup data before the first sample.
  double prepared_s = 0;
  uint64_t prepared_rays = 0;
  double device_s = 0;  ///< sum of the stages, on the device and on the host
  uint64_t paths = 0, rays = 0;
  double samples = 0;  ///< a pixel, on average
  /// True if every pixel has samples in both halves of the film; otherwise errors are unknown, and 0.
  bool has_error = false;
  /// Noise of the paths, estimated, as it is seen (film::ImageError::seen).
  std::array<double, k_layers> error{};
  double degrees = 0;  ///< of freedom of error[0]^2 (film::ImageError::seen_degrees)
  /// What of the sum's error is not the paths', as `error`: the noise of records that they read, and what
  /// lookups are off by in the mean (film/error.h). Samples do not take it away, or, where it is the blur of
  /// photons, slowly as their discs shrink.
  double records = 0, interpolation = 0;
  /// Estimated error of the sum, from all three.
  double sum() const { return error_sum(error[0], records, interpolation); }
  /// What more samples do not go below, as things are.
  double floor() const { return records + interpolation; }
  /// A component's share of the noise, 0..1, as film::ImageError::share; component 0..3.
  double share(int component) const;
  /// The same errors, of the mean: rms of the pixels' errors in luminance over the sum's mean luminance.
  struct OfMean {
    std::array<double, k_layers> error{};
    double records = 0, interpolation = 0;
    double sum() const { return error_sum(error[0], records, interpolation); }
  } of_mean;
  /// Error of the tiles, of the sum, each over its own pixels' luminance (film::TileError::relative_sum): of
  /// the median tile, and what a tenth of the tiles are over.
  double tile_median = 0, tile_worst_tenth = 0;
  std::array<double, k_layers> component_s{};  ///< device time by component; [0] all
  std::optional<std::array<double, k_layers>>
      truth;                       ///< of_mean against a reference, its own noise taken off
  std::optional<Band> total_rays;  ///< forecast of the whole render's, in adaptive sampling
};

class Ledger {
 public:
  /// True if it is time for an entry, for a picture of that many pixels: the first with two samples a pixel
  /// (with fewer there is no estimate), then after half as many more, and from 32 samples on after a quarter
  /// more: an entry costs a pass over the film, which matters in short renders.
  bool due(uint64_t paths, uint64_t pixels) const {
    if (paths < 2 * pixels) return false;
    const uint64_t last = entries_.empty() ? 0 : entries_.back().paths;
    return last < 32 * pixels ? paths >= last + last / 2 : paths >= last + last / 4;
  }
  void add(const Entry& entry);
  void clear() { entries_.clear(), ++changes_; }
  const std::vector<Entry>& entries() const { return entries_; }
  /// Number of times entries were added or removed.
  uint64_t changes() const { return changes_; }

  /// A table with a heading and a line per entry; unknown values are empty.
  std::string csv() const;

 private:
  std::vector<Entry> entries_;
  uint64_t changes_ = 0;
};

}  // namespace lucerna::stats
