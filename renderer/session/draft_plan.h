#pragma once
// When the window gets samples of drafts: pictures of fewer pixels that stand for the picture until it has
// samples of its own. No device: pure state.
#include <bit>
#include <cstdint>
#include <optional>

namespace lucerna::session {

class DraftPlan {
 public:
  static constexpr uint32_t k_coarse_samples = 4;

  enum class Next {
    nothing,  ///< the picture's own work goes on
    coarse,   ///< a sample of the draft of a quarter of the resolution
    fine,     ///< ... of half of it
    sight     ///< a piece of what surfaces the picture's pixels show
  };
  /// The picture begins anew.
  void restart() { *this = {}; }
  /// Light that drafts have looked up has got better: they begin anew. Where there was a finer one, the
  /// coarse would be worse than that.
  void light_changed() {
    fine_first_ = fine_first_ || fine_ > 0;
    coarse_ = fine_ = 0;
  }
  /// That has been done, and took so long; `complete`: no more of it is to be done.
  void drawn(Next what, double seconds, bool complete = true) {
    if (what == Next::coarse) ++coarse_;
    if (what == Next::fine) ++fine_;
    if (what == Next::coarse || what == Next::fine) draft_s_ += seconds;
    news_ = (what == Next::sight && complete) || (what == Next::coarse && coarse_ == k_coarse_samples) ||
            (what == Next::fine && shows_fine() && std::has_single_bit(fine_));
  }
  /// ... the picture's own work, which took so long.
  void worked(double seconds) { work_s_ += seconds; }

  /// `preparing`: the picture's samples wait for what they look up, maybe for long; `filled`: every pixel has
  /// one. A first sample comes at once. Then a few more: the picture's first samples fill it from one side to
  /// the other. While they wait the draft is all that there is to be seen, and gets finer: two fine
  /// samples at once, then most of the time until `error`, which is told of what is shown, is such that a
  /// room can be judged by it, for some seconds at most; then less and less as more helps less. `sight`: it
  /// is not known yet what surfaces pixels show; the first draft does not wait for that.
  Next next(bool preparing, bool filled, bool sight = false, std::optional<double> error = {}) const {
    if (filled) return Next::nothing;
    const bool coarse = !fine_first_ || !preparing;
    if (!begun()) return coarse ? Next::coarse : Next::fine;
    if (sight) return Next::sight;
    if (coarse && coarse_ < k_coarse_samples) return Next::coarse;
    if (!preparing || fine_ >= k_fine_samples) return Next::nothing;
    const bool rough = error.value_or(1) > k_good_error && draft_s_ < k_patience_s;
    const double share = fine_ < 2 ? 1 : rough ? 0.75 : fine_ < 4 ? 0.5 : fine_ < 16 ? 0.25 : 0.1;
    return draft_s_ <= share * (draft_s_ + work_s_) ? Next::fine : Next::nothing;
  }
  /// Whether there is a draft.
  bool begun() const { return coarse_ + fine_ > 0; }
  /// Whether what was drawn last makes so much of a difference that it is to be shown at once.
  bool news() const { return news_; }
  /// Whether the fine draft is better than the coarse one: of as many rays it knows less of its noise.
  bool shows_fine() const { return fine_ > (coarse_ > 0 ? 1 : 0); }
  uint32_t coarse_samples() const { return coarse_; }
  uint32_t fine_samples() const { return fine_; }

 private:
  static constexpr uint32_t k_fine_samples = 64;
  /// Relative error from which on drafts are no hurry, and seconds after which they are none in any case.
  static constexpr double k_good_error = 0.06, k_patience_s = 6;
  uint32_t coarse_ = 0, fine_ = 0;
  bool fine_first_ = false;  ///< drafts that begin anew are fine ones
  bool news_ = false;
  double draft_s_ = 0, work_s_ = 0;
};

}  // namespace lucerna::session
