// Work items of the picture: preparation, samples, learning; and preview samples.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/log.h"
#include "session/renderer.h"

namespace lucerna::session {

bool Renderer::step(const std::function<bool()>& cancel) {
  if (engine_) settle_mix();
  if (engine_ && samples() > 0 && judged_otherwise()) change_schedule();
  if (filter_due()) {
    window_filter_->step(*engine_, picture_view(), *display_, filter_job(), view(), filter_progress(),
                         cancel);
    return true;
  }
  if (!engine_ || done()) return false;
  clock_.go();
  const Timer timer;
  engine_->begin_samples(picture_view());
  const bool prepares = preparing() || choosing(), learns = engine_->learns(samples());
  const bool progress = render_item(cancel);
  if (window_filter_ && !mix_pending_) window_filter_->judge(*engine_, *display_, *film_, stats().paths);
  render_s_ += timer.seconds();
  if (display_) display_->plan().worked(timer.seconds());
  if (display_ && samples() > 0) {
    display_->warm(engine_->wavefront().stream(), *film_);
    engine_->developer().prepare_mix(engine_->wavefront().stream(), *film_, view());
  }
  if (prepares)
    prepared_s_ = clock_.seconds(), prepared_ = stats();
  else if (progress && !learns)
    note_progress(false);
  if (done()) rest();
  return progress;
}

bool Renderer::render_item(const std::function<bool()>& cancel) {
  const PictureView view = picture_view();
  transport::Wavefront& wavefront = engine_->wavefront();
  if (choosing()) return run_pilot(cancel);
  if (engine_->learns(samples())) return engine_->learn(view, cancel);
  if (solvers::Solver* next = engine_->unready()) {
    const bool rounds = engine_->in_rounds(), went = engine_->prepare(*next, view, cancel);
    if (engine_->in_rounds() != rounds && samples() == 0) start_schedule();
    return went;
  }
  // As soon as every pixel has a sample, so that the picture does not wait, and before errors are published.
  if (solvers::Solver* solver = samples() > 0 ? engine_->owing_errors(*film_) : nullptr) {
    const bool restarted = errors_restart_ != restarts_ || errors_of_ != solver;
    errors_restart_ = restarts_, errors_of_ = solver;
    return engine_->with(*solver, view, [&](const solvers::Picture& picture) {
      return solvers::offered<solvers::LookupErrors>(*solver)->estimate_errors(wavefront, *film_, picture,
                                                                               restarted, cancel);
    });
  }
  if (const std::optional<bool> went = refine(cancel)) return *went;
  if (schedule::AdaptiveSchedule* adaptive = sampling_.adaptive()) {
    const schedule::WorkItem item = adaptive->next();
    if (const std::optional<bool> went = prepare_round(item, cancel)) {
      adaptive->give_back();
      return *went;
    }
    if (!wavefront.run(item, *film_, cancel)) {
      adaptive->give_back();
      return false;
    }
    const std::vector<uint32_t>& tiles = adaptive->to_report();
    std::vector<schedule::TileErrors> errors(tiles.size());
    // One sample a pixel gives no error estimate and decides nothing.
    if (!tiles.empty() && adaptive->tiles()[tiles[0]].samples + item.sample_count > 1) {
      engine_->estimator().estimate_stopping(wavefront.stream(), item.blocks, *film_, seen_range());
      wavefront.account_stages();
      for (size_t i = 0; i < tiles.size(); ++i) {
        const film::RelativeError e = film::relative_error(*film_, adaptive->blocks_of(tiles[i]));
        errors[i] = {float(e.paths), float(e.records), float(e.interpolation)};
      }
    }
    adaptive->report(errors);
    return true;
  }
  const schedule::UniformSchedule before = sampling_.uniform();
  const schedule::WorkItem item = sampling_.uniform().next();
  if (const std::optional<bool> went = prepare_round(item, cancel)) {
    sampling_.uniform() = before;
    return *went;
  }
  if (wavefront.run(item, *film_, cancel)) return true;
  sampling_.uniform() = before;
  return false;
}

bool Renderer::run_pilot(const std::function<bool()>& cancel) {
  if (!pilot_) pilot_ = std::make_unique<Pilot>(*device_, *engine_, width_, height_);
  if (!pilot_->step(*engine_, picture_view(), cancel)) return false;
  if (!pilot_->done()) return true;
  findings_ = pilot_->findings();
  pilot_.reset();
  const std::array<plan::Choice, 4> before = engine_->plan().choices;
  scene::Changes changes;
  try {
    apply_plan(changes);
  } catch (const Error& e) {
    log::warning("components: paths compute what is chosen automatically: {}", e.what());
    plan::Plan paths = engine_->plan();
    paths.undecided = false;
    engine_->set_plan(paths);
  }
  const std::array<plan::Choice, 4>& now = engine_->plan().choices;
  for (size_t c = 0; c < now.size(); ++c) {
    const std::string key = std::string("components.") + paths::k_component_names[c];
    if (now[c].reason != before[c].reason) log::info("{}: {}: {}", key, now[c].solver, now[c].reason);
    if (now[c].solver != before[c].solver) changes.settings.insert(key);
  }
  // Nothing but paths: the picture goes on as it was begun.
  if (changes.settings.empty()) return true;
  notify_settings_changed();
  restart(changes);
  return true;
}

std::optional<bool> Renderer::prepare_round(const schedule::WorkItem& item,
                                            const std::function<bool()>& cancel) {
  if (item.blocks.empty()) return std::nullopt;
  const uint32_t sample = item.blocks.front().first_sample;  // of all of them
  solvers::Solver* next = engine_->unready_for(sample);
  if (!next) return std::nullopt;
  return engine_->with(*next, picture_view(), [&](const solvers::Picture& picture) {
    return solvers::offered<solvers::Rounds>(*next)->prepare_round(engine_->wavefront(), picture, sample,
                                                                   cancel);
  });
}

void Renderer::note_path_pace(double seconds) {
  const uint32_t before = display_->plan().coarse_samples();
  coarse_s_ = before == 0 ? seconds : coarse_s_ + seconds;
  const auto holds_light = [](const auto& solver) {
    const auto* statistics = solvers::offered<solvers::Statistics>(*solver);
    if (!statistics) return false;
    for (const auto& [name, value] : statistics->figures())
      if (value > 0) return true;
    return false;
  };
  if (before + 1 < DraftPlan::k_coarse_samples || !preparing() ||
      std::any_of(engine_->solvers().begin(), engine_->solvers().end(), holds_light))
    return;
  transport::Wavefront& wavefront = engine_->wavefront();
  wavefront.uncounted([&] {
    engine_->estimator().estimate(wavefront.stream(), *coarse_, seen_range());
    wavefront.account_stages();
  });
  const double samples = before + 1, pixels = double(coarse_->width()) * coarse_->height();
  path_pace_ = {.seconds = coarse_s_ / (samples * pixels),
                .noise = film::image_error(coarse_->errors()).seen(0) * std::sqrt(samples)};
}

std::optional<stats::SamplePace> Renderer::path_pace() const {
  if (!path_pace_) return std::nullopt;
  return stats::SamplePace{.seconds = path_pace_->seconds * width_ * height_, .noise = path_pace_->noise};
}

bool Renderer::draw_draft(const std::function<bool()>& cancel) {
  if (!engine_ || !display_) return false;
  const bool prepares = preparing();
  if (std::exchange(draft_preparing_, prepares) && !prepares) display_->light_changed();
  const bool filled = samples() > 0;
  const bool sight = !filled && previewed(view()) && display_->sight_wanted(*engine_, picture_view());
  const std::optional<film::ShownError> off = display_->shares().error;
  const DraftPlan::Next what =
      display_->plan().next(prepares, filled, sight, off ? std::optional(off->median) : std::nullopt);
  if (what == DraftPlan::Next::nothing) return false;
  clock_.go();
  const Timer timer;
  if (!display_->draw(what, *engine_, picture_view(), *coarse_, cancel)) return false;
  if (what == DraftPlan::Next::coarse) note_path_pace(timer.seconds());
  display_->plan().drawn(what, timer.seconds(),
                         what != DraftPlan::Next::sight || !display_->sight_wanted(*engine_, picture_view()));
  return true;
}

}  // namespace lucerna::session
