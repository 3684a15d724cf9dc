#include "session/preview_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pilot/findings.h"

namespace lucerna::session {

void PreviewSamples::restart(bool same_light) {
  preparing_ = false;
  if (!same_light) pace_.reset();
}

void PreviewSamples::note_pace(double seconds) {
  const uint32_t before = plan()->coarse_samples();
  coarse_s_ = before == 0 ? seconds : coarse_s_ + seconds;
  const auto holds_light = [](const auto& solver) {
    const auto* statistics = solvers::offered<solvers::Statistics>(*solver);
    if (!statistics) return false;
    for (const auto& [name, value] : statistics->figures())
      if (value > 0) return true;
    return false;
  };
  if (before + 1 < DraftPlan::k_coarse_samples || !setup_.engine->unready() ||
      std::any_of(setup_.engine->solvers().begin(), setup_.engine->solvers().end(), holds_light))
    return;
  transport::Wavefront& wavefront = setup_.engine->wavefront();
  wavefront.uncounted([&] {
    setup_.engine->estimator().estimate(wavefront.stream(), *setup_.coarse, setup_.seen_range());
    wavefront.account_stages();
  });
  const double samples = before + 1, pixels = double(setup_.coarse->width()) * setup_.coarse->height();
  pace_ = {.seconds = coarse_s_ / (samples * pixels),
           .noise = film::image_error(setup_.coarse->errors()).seen(0) * std::sqrt(samples)};
}

std::optional<stats::SamplePace> PreviewSamples::path_pace() const {
  if (!pace_) return std::nullopt;
  return stats::SamplePace{.seconds = pace_->seconds * setup_.width * setup_.height, .noise = pace_->noise};
}

std::optional<solvers::Findings> PreviewSamples::findings() {
  constexpr double k_least_paths = 1 << 14;
  if (!plan() || plan()->coarse_samples() < DraftPlan::k_coarse_samples) return std::nullopt;
  const uint32_t samples = plan()->coarse_samples();
  const double paths = double(samples) * setup_.coarse->width() * setup_.coarse->height();
  if (paths < k_least_paths) return std::nullopt;
  solvers::Findings findings = pilot::evaluate(setup_.coarse->read(), samples);
  findings.pixels = double(setup_.width) * setup_.height;
  findings.rays = double(output_.display()->coarse_rays()) / paths;
  findings.seconds = coarse_s_ / paths * findings.pixels;
  findings.waiting = DraftPlan::k_waiting;
  return findings;
}

bool PreviewSamples::draw(const std::function<bool()>& cancel) {
  Display* const display = output_.display();
  if (!setup_.engine || !display) return false;
  const PictureView view = setup_.view(context_.automaton);
  const bool prepares = setup_.engine->unready() || setup_.engine->plan().undecided;
  if (std::exchange(preparing_, prepares) && !prepares) display->light_changed();
  const bool filled = sampling_.samples() > 0;
  const bool sight =
      !filled && output_.previewed(output_.view()) && display->sight_wanted(*setup_.engine, view);
  const std::optional<film::ShownError> off = display->shares().error;
  const DraftPlan::Next what =
      display->plan().next(prepares, filled, sight, off ? std::optional(off->median) : std::nullopt);
  if (what == DraftPlan::Next::nothing) return false;
  progress_.resume();
  const Timer timer;
  if (!display->draw(what, *setup_.engine, view, *setup_.coarse, cancel)) return false;
  if (what == DraftPlan::Next::coarse) note_pace(timer.seconds());
  display->plan().drawn(what, timer.seconds(),
                        what != DraftPlan::Next::sight || !display->sight_wanted(*setup_.engine, view));
  return true;
}

}  // namespace lucerna::session
