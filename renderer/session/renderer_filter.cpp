// Filtered pictures: a finished one on request, and the window's between its samples.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/log.h"
#include "session/renderer.h"

namespace lucerna::session {

namespace {

// Samples of every pixel before the window's picture is first filtered; before that it shows a preview.
constexpr uint32_t k_first_samples = 8;
// The window's picture is filtered again after this factor in samples, and this factor of the filtering time
// in tracing time.
constexpr uint64_t k_more_samples = 2;
constexpr double k_more_seconds = 3;
// Growth of the number of samples after which the filtered picture's error is estimated again.
constexpr double k_more_to_judge = 1.2;
// Share of light from before an edit from which on a preview may be kept in place of a filtered picture.
constexpr double k_some_stale = 0.05;

/// Errors of what tiles look up. All samples share them, so samples cannot measure them.
film::ShownError lookup_errors(const std::vector<film::TileError>& tiles) {
  std::vector<double> errors;
  for (const film::TileError& t : tiles)
    errors.push_back(std::hypot(double(t.relative_records), double(t.relative_interpolation)));
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors[errors.size() * 9 / 10]};
}

}  // namespace

const Filtered& Renderer::filter() {
  if (!engine_ || !film_ || stats().paths == 0) throw Error("filter", "there is no picture to filter yet");
  settle_mix();
  forget_filtered();  // frees its memory first
  PixelSight own(*device_, *compiler_);
  PictureFilter filter(*device_, *compiler_);
  filter.begin(filter_job());
  while (filter.working()) filter.step(*engine_, picture_view(), display_ ? display_->sight() : own, {});
  filtered_ = filter.take();
  return *filtered_;
}

const Filtered* Renderer::filtered() const {
  const bool same = filtered_ && filtered_->paths == stats().paths &&
                    filtered_->film->width() == film_->width() &&
                    filtered_->film->height() == film_->height();
  return same ? &*filtered_ : nullptr;
}

FilterJob Renderer::filter_job() const {
  constexpr uint32_t k_by_way = 1u << 1 | 1u << 2;  // secondary and tertiary: the components of records
  uint32_t looked_up = 0;
  for (const auto& solver : engine_->solvers())
    looked_up |= engine_->plan().components_of(solver->info()) & k_by_way;
  return {*film_, tile_side(), seen_range().floor, stats().paths, looked_up};
}

const Filtered* Renderer::shown_filtered(const film::View& v) const {
  const bool shows =
      shown_filtered_ && v.layer < shared::k_layer_albedo && settings_.text("preview.filter") == "auto";
  return shows ? &*shown_filtered_ : nullptr;
}

bool Renderer::filter_due() const {
  if (!engine_ || !film_ || !display_ || filter_fails_ || mix_pending_ ||
      view().layer >= shared::k_layer_albedo || settings_.text("preview.filter") != "auto" ||
      !film_->fits_storage_buffers())
    return false;
  if (window_filter_ && window_filter_->working()) return true;
  const uint64_t paths = stats().paths;
  if (samples() < 2 || filtered_paths_ == paths) return false;
  if (done()) return true;
  if (preparing() || engine_->learns(samples())) return false;
  return filtered_paths_ > 0 ? paths >= k_more_samples * filtered_paths_ &&
                                   render_s_ - filtered_at_s_ >= k_more_seconds * filter_s_
                             : samples() >= k_first_samples;
}

void Renderer::filter_piece(const std::function<bool()>& cancel) {
  const Timer timer;
  try {
    if (!window_filter_) window_filter_ = std::make_unique<PictureFilter>(*device_, *compiler_);
    if (!window_filter_->working()) {
      window_filter_->begin(filter_job());
      filter_piece_s_ = 0;
    }
    window_filter_->step(*engine_, picture_view(), display_->sight(), cancel);
  } catch (const Error& e) {
    log::warning("{}; the window shows pictures with their noise", e.what());
    filter_fails_ = true;
    return;
  }
  filter_piece_s_ += timer.seconds();
  if (window_filter_->working()) return;
  Filtered next = window_filter_->take();
  filter_s_ = filter_piece_s_, filtered_at_s_ = render_s_;
  filtered_paths_ = judged_paths_ = next.paths;
  // Light from before an edit may be better than what few samples can show.
  const film::PreviewShares preview = shown_filtered_ ? film::PreviewShares{} : display_->shares();
  engine_->wavefront().uncounted(
      [&] { display_->show_filtered(engine_->wavefront().stream(), *film_, next.error, view()); });
  const bool worse = preview.stale > k_some_stale && preview.error &&
                     display_->filtered_error()->median > preview.error->median;
  if (worse && !done()) return;
  shown_filtered_ = std::move(next);
  filter_news_ = true;
}

void Renderer::judge_filtered() {
  if (!shown_filtered_ || !display_ || mix_pending_) return;
  const double pixels = double(film_->width()) * film_->height(), paths = double(stats().paths);
  if (paths < k_more_to_judge * double(judged_paths_) || paths < double(judged_paths_) + pixels) return;
  engine_->wavefront().uncounted([&] { display_->judge_filtered(engine_->wavefront().stream(), *film_); });
  judged_paths_ = stats().paths;
}

void Renderer::forget_filtered() {
  filtered_.reset();
  shown_filtered_.reset();
  filtered_paths_ = 0;
  if (window_filter_) window_filter_->stop();
}

film::PreviewShares Renderer::preview_shares() const {
  if (!display_) return {};
  film::PreviewShares shares = display_->shares();
  if (engine_ && film_ && shown_filtered(view()))
    shares = {.stale = 0, .filtered = 1, .error = display_->filtered_error()};
  if (shares.error && lookup_errors_known()) {
    const film::ShownError lookups = lookup_errors(film::tile_errors(*film_, tile_side()));
    shares.error->median = std::hypot(shares.error->median, lookups.median);
    shares.error->worst_tenth = std::hypot(shares.error->worst_tenth, lookups.worst_tenth);
  }
  return shares;
}

}  // namespace lucerna::session
