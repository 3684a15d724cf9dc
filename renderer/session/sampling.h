#pragma once
// Which pixels of the picture get samples next: uniform, balanced or adaptive sampling behind one interface,
// by the settings `samples` and sampling.*.
#include <algorithm>
#include <optional>
#include <vector>

#include "schedule/adaptive.h"
#include "schedule/balanced.h"
#include "schedule/region.h"
#include "schedule/uniform.h"
#include "session/setup.h"

namespace lucerna::session {

class ImageProgress;

class Sampling {
 public:
  /// `interactive`: in the window, where a picture with a region has samples everywhere. `setup` must outlive
  /// it.
  Sampling(const Setup& setup, bool interactive) : setup_(setup), interactive_(interactive) {}

  /// Begins without samples.
  void restart();
  /// Continues from the present samples with another mode, region or tone curve. Adaptive sampling first
  /// estimates errors (`progress`), in a pass over the film.
  void change(const ImageProgress& progress);
  /// Uniform and balanced sampling: the setting `samples` has changed.
  void change_samples();
  /// Adaptive sampling: target error or limits have changed.
  void retarget();

  /// The setting sampling.region: pixels; nullopt: the whole picture.
  std::optional<schedule::Rectangle> chosen_region() const;
  /// Likewise in batch; nullopt in the window, whose pictures have samples around the region too.
  std::optional<schedule::Rectangle> only_region() const {
    return interactive_ ? std::nullopt : chosen_region();
  }
  /// True if the region's own samples can begin: change() then begins them.
  bool region_due() const;
  /// True if another exposure or tone curve has changed errors as seen, by which tiles have stopped: then
  /// call change().
  bool judged_otherwise() const { return adaptive_ && seen_ != setup_.seen_range(); }

  /// Blocks that get samples; without bounds: all. The numbers of samples below are of their pixels.
  const schedule::Rectangle& region() const { return region_; }
  bool whole() const { return region_ == schedule::Rectangle{}; }
  /// State of every tile; null unless sampling is adaptive.
  const schedule::AdaptiveSchedule* adaptive() const { return adaptive_ ? &*adaptive_ : nullptr; }
  schedule::AdaptiveSchedule* adaptive() { return adaptive_ ? &*adaptive_ : nullptr; }
  /// Null unless sampling is balanced.
  const schedule::BalancedSchedule* balanced() const { return balanced_ ? &*balanced_ : nullptr; }
  schedule::BalancedSchedule* balanced() { return balanced_ ? &*balanced_ : nullptr; }
  schedule::UniformSchedule& uniform() { return uniform_; }

  bool done() const;
  /// Number of samples that every pixel has.
  uint32_t samples() const;
  /// Mean over the pixels; adaptive: samples().
  double mean_samples() const { return balanced_ ? balanced_->mean_samples() : samples(); }
  /// Number of samples that some pixel has.
  uint32_t most_samples() const;
  /// Samples a pixel at which the image is finished: of every pixel; balanced: their mean; adaptive: maximum
  /// of any pixel.
  uint32_t max_samples() const;
  /// Samples that every pixel gets before errors decide, if sampling is balanced; else max_samples().
  uint32_t even_samples() const {
    return balanced_ ? std::min(balanced_->options().first, max_samples()) : max_samples();
  }
  /// The power of two that the number of samples has last reached, if that is where passes end; else 0.
  /// Uniform: of every pixel, now; balanced: of the mean before the present round; adaptive: of some pixel,
  /// now.
  uint32_t mark() const;
  /// Complete passes over the picture, or over the tiles that get samples.
  uint32_t passes() const;

 private:
  /// Samples of every block of the picture, in raster order.
  std::vector<uint32_t> counts() const;
  /// Blocks that the next schedule gives samples to: all until every pixel has the window's first samples.
  schedule::Rectangle scheduled_region();
  void start(schedule::UniformSchedule schedule, const schedule::Rectangle& region);
  void start(schedule::AdaptiveSchedule schedule);
  /// Uniform or balanced.
  void start_even(std::vector<uint32_t> have, const schedule::Rectangle& region);
  schedule::AdaptiveOptions adaptive_options(const schedule::Rectangle& region) const;

  /// Samples of every pixel of the window's picture before only a region gets more: one in each half of the
  /// film, so that their noise is known.
  static constexpr uint32_t k_around_region = 2;

  const Setup& setup_;
  bool interactive_;
  schedule::UniformSchedule uniform_;
  std::optional<schedule::AdaptiveSchedule> adaptive_;  ///< replaces the uniform one; this one too:
  std::optional<schedule::BalancedSchedule> balanced_;
  schedule::Rectangle region_;
  bool region_waits_ = false;  ///< its schedule starts when every pixel has k_around_region samples
  film::SeenRange seen_;       ///< seen_range() of the errors in the adaptive schedule
};

}  // namespace lucerna::session
