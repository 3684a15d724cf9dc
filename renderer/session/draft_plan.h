#pragma once
// Schedule of preview samples: pictures of lower resolution shown until the picture has samples. Pure state;
// no device.
#include <bit>
#include <cstdint>
#include <optional>

namespace lucerna::session {

class DraftPlan {
 public:
  static constexpr uint32_t k_coarse_samples = 4;
  /// Time of preparation over its cost: most of its first seconds go to preview samples, then a third.
  static constexpr double k_waiting = 2;

  enum class Next {
    nothing,  ///< the picture's work continues
    coarse,   ///< a preview sample at a quarter of the resolution
    fine,     ///< ... at half of it
    sight     ///< a part of the visible surfaces
  };
  /// A new picture begins.
  void restart() { *this = {}; }
  /// Light read by preview samples has improved: accumulation restarts. If there was a fine sample, only with
  /// fine ones: a coarse one would be worse.
  void light_changed() {
    fine_first_ = fine_first_ || fine_ > 0;
    coarse_ = fine_ = 0;
  }
  /// Call when that is done, with its duration; `complete`: nothing of its kind remains.
  void drawn(Next what, double seconds, bool complete = true) {
    if (what == Next::coarse) ++coarse_;
    if (what == Next::fine) ++fine_;
    if (what == Next::coarse || what == Next::fine) draft_s_ += seconds;
    news_ = (what == Next::sight && complete) || (what == Next::coarse && coarse_ == k_coarse_samples) ||
            (what == Next::fine && shows_fine() && std::has_single_bit(fine_));
  }
  /// ... the same for the picture's work.
  void worked(double seconds) { work_s_ += seconds; }

  /// `preparing`: the picture's samples wait for lookup data, maybe for long; `filled`: every pixel has one.
  /// A first preview sample comes at once, then a few more, because the picture's first samples fill it from
  /// one side to the other. While waiting, the preview is refined: two fine samples at once, then most of the
  /// time until `error`, estimated for the shown picture, suffices to judge a room, for some seconds at most;
  /// then a third of the time, so that the picture gets better until it is replaced. `sight`: the visible
  /// surfaces are not known yet; the first preview sample does not wait for them.
  Next next(bool preparing, bool filled, bool sight = false, std::optional<double> error = {}) const {
    if (filled) return Next::nothing;
    const bool coarse = !fine_first_ || !preparing;
    if (!begun()) return coarse ? Next::coarse : Next::fine;
    if (sight) return Next::sight;
    if (coarse && coarse_ < k_coarse_samples) return Next::coarse;
    if (!preparing) return Next::nothing;
    const bool rough = error.value_or(1) > k_good_error && draft_s_ < k_patience_s;
    const double share = fine_ < 2 ? 1 : rough ? 0.75 : fine_ < 4 ? 0.5 : 1 / 3.0;
    return draft_s_ <= share * (draft_s_ + work_s_) ? Next::fine : Next::nothing;
  }
  /// True if there is a preview sample.
  bool begun() const { return coarse_ + fine_ > 0; }
  /// True if the latest one changes the display enough to show it at once.
  bool news() const { return news_; }
  /// True if the fine film is better than the coarse one: with equally many rays its noise estimate is less
  /// reliable.
  bool shows_fine() const { return fine_ > (coarse_ > 0 ? 1 : 0); }
  uint32_t coarse_samples() const { return coarse_; }
  uint32_t fine_samples() const { return fine_; }

 private:
  /// Relative error below which preview samples are not urgent, and seconds after which they never are.
  static constexpr double k_good_error = 0.06, k_patience_s = 6;
  uint32_t coarse_ = 0, fine_ = 0;
  bool fine_first_ = false;  ///< a restart begins with fine samples
  bool news_ = false;
  double draft_s_ = 0, work_s_ = 0;
};

}  // namespace lucerna::session
