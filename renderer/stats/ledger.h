#pragma once
// Cost and quality of a render over time: one line each time the work has grown by a quarter or half, so that
// a long render has a few dozen lines, evenly spaced in log time.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
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
  double render_s = 0;  ///< part of it spent tracing: the time of the same picture without display
  /// Part of wall_s and of the rays spent on lookup data before the first sample.
  double prepared_s = 0;
  uint64_t prepared_rays = 0;
  double device_s = 0;  ///< sum of the stages, on the device and on the host
  uint64_t paths = 0, rays = 0;
  double samples = 0;  ///< a pixel, on average
  /// True if every pixel has samples in both halves of the film; otherwise errors are unknown, and 0.
  bool has_error = false;
  /// Estimated noise of the paths, as seen (film::ImageError::seen).
  std::array<double, k_layers> error{};
  /// Likewise, of the layers by path expressions; 0 also if a layer lacks light (LayerSet::Routed).
  std::vector<double> layers;
  double degrees = 0;  ///< degrees of freedom of error[0]^2 (film::ImageError::seen_degrees)
  /// The other parts of the sum's error, as seen: the noise of records, and the mean error of lookups
  /// (film/error.h). More samples do not reduce them, except the blur of photons, slowly, as their discs
  /// shrink.
  double records = 0, interpolation = 0;
  /// Estimated error of the sum, from all three.
  double sum() const { return error_sum(error[0], records, interpolation); }
  /// The part that more samples do not reduce at present.
  double floor() const { return records + interpolation; }
  /// A component's share of the noise, 0..1, as film::ImageError::share; component 0..3.
  double share(int component) const;
  /// Likewise, of the mean: rms of the pixels' errors in luminance over the sum's mean luminance.
  struct OfMean {
    std::array<double, k_layers> error{};
    std::vector<double> layers;
    double records = 0, interpolation = 0;
    double sum() const { return error_sum(error[0], records, interpolation); }
  } of_mean;
  /// Error of the tiles, of the sum, each over its own pixels' luminance (film::TileError::relative_sum): the
  /// median, and the value that a tenth of the tiles exceed.
  double tile_median = 0, tile_worst_tenth = 0;
  std::array<double, k_layers> component_s{};  ///< device time by component; [0] all
  std::optional<std::array<double, k_layers>>
      truth;  ///< of_mean against a reference, without the reference's noise
  /// Likewise of the layers by path expressions that the reference has.
  std::vector<std::optional<double>> truth_of_layers;
  std::optional<Band> total_rays;  ///< forecast for the whole render, in adaptive sampling
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
  /// Names of the layers by path expressions, in the order of Entry::layers.
  void name_layers(std::vector<std::string> names) { layers_ = std::move(names); }
  const std::vector<std::string>& layers() const { return layers_; }
  /// Number of times entries were added or removed.
  uint64_t changes() const { return changes_; }

  /// A table with a heading and a line per entry; unknown values are empty.
  std::string csv() const;

 private:
  std::vector<Entry> entries_;
  std::vector<std::string> layers_;
  uint64_t changes_ = 0;
};

}  // namespace lucerna::stats
