#include "session/window_filter.h"

#include <utility>

#include "base/log.h"
#include "base/timer.h"

namespace lucerna::session {

namespace {

// Samples of every pixel before the picture is first filtered; before that it shows a preview.
constexpr uint32_t k_first_samples = 8;
// The picture is filtered again after this factor in samples, and this factor of the filtering time in
// tracing time.
constexpr uint64_t k_more_samples = 2;
constexpr double k_more_seconds = 3;
// Growth of the number of samples after which the filtered picture's error is estimated again.
constexpr double k_more_to_judge = 1.2;
// Share of light from before an edit from which on a preview may be kept in place of a filtered picture.
constexpr double k_some_stale = 0.05;

}  // namespace

bool WindowFilter::due(const Progress& at) const {
  if (fails_) return false;
  if (filter_ && filter_->working()) return true;
  if (at.samples < 2 || filtered_paths_ == at.paths) return false;
  if (at.done) return true;
  if (at.prepares) return false;
  return filtered_paths_ > 0 ? at.paths >= k_more_samples * filtered_paths_ &&
                                   at.render_s - filtered_at_s_ >= k_more_seconds * filter_s_
                             : at.samples >= k_first_samples;
}

void WindowFilter::step(Engine& engine, const PictureView& view, Display& display, const FilterJob& job,
                        const film::View& shown, const Progress& at, const std::function<bool()>& cancel) {
  const Timer timer;
  try {
    if (!filter_) filter_ = std::make_unique<PictureFilter>(device_, compiler_);
    if (!filter_->working()) {
      filter_->begin(job);
      piece_s_ = 0;
    }
    filter_->step(engine, view, display.sight(), cancel);
  } catch (const Error& e) {
    log::warning("{}; the window shows pictures with their noise", e.what());
    fails_ = true;
    return;
  }
  piece_s_ += timer.seconds();
  if (filter_->working()) return;
  Filtered next = filter_->take();
  filter_s_ = piece_s_, filtered_at_s_ = at.render_s;
  filtered_paths_ = judged_paths_ = next.paths;
  // Light from before an edit may be better than what few samples can show.
  const film::PreviewShares preview = result_ ? film::PreviewShares{} : display.shares();
  engine.wavefront().uncounted(
      [&] { display.show_filtered(engine.wavefront().stream(), job.film, next.error, shown); });
  const bool worse = preview.stale > k_some_stale && preview.error &&
                     display.filtered_error()->median > preview.error->median;
  if (worse && !at.done) return;
  result_ = std::move(next);
  news_ = true;
}

void WindowFilter::judge(Engine& engine, Display& display, const film::Film& film, uint64_t paths) {
  if (!result_) return;
  const double pixels = double(film.width()) * film.height(), judged = double(judged_paths_);
  if (double(paths) < k_more_to_judge * judged || double(paths) < judged + pixels) return;
  engine.wavefront().uncounted([&] { display.judge_filtered(engine.wavefront().stream(), film); });
  judged_paths_ = paths;
}

void WindowFilter::forget() {
  result_.reset();
  filtered_paths_ = 0;
  if (filter_) filter_->stop();
}

}  // namespace lucerna::session
