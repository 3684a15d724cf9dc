// Work items of the picture: preparation, samples, learning; and preview samples.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/log.h"
#include "session/renderer.h"

namespace lucerna::session {

bool Renderer::step(const std::function<bool()>& cancel) {
  if (setup_.engine) settle_mix();
  if (setup_.engine && samples() > 0 && judged_otherwise()) change_schedule();
  if (filter_due()) {
    window_filter_->step(*setup_.engine, picture_view(), *display_, filter_job(), view(), filter_progress(),
                         cancel);
    return true;
  }
  if (!setup_.engine || done()) return false;
  progress_.resume();
  const Timer timer;
  setup_.engine->begin_samples(picture_view());
  const bool prepares = preparing() || choosing(), learns = setup_.engine->learns(samples());
  const bool progress = render_item(cancel);
  if (region_waits_ && samples() >= k_around_region) change_schedule();
  if (window_filter_ && !mix_pending_)
    window_filter_->judge(*setup_.engine, *display_, *setup_.film, stats().paths);
  progress_.add_render_seconds(timer.seconds());
  if (display_) display_->plan().worked(timer.seconds());
  if (display_ && samples() > 0) {
    display_->warm(setup_.engine->wavefront().stream(), *setup_.film);
    setup_.engine->developer().prepare_mix(setup_.engine->wavefront().stream(), *setup_.film, view());
  }
  if (prepares)
    progress_.note_prepared();
  else if (progress && !learns)
    progress_.note(false);
  if (done()) rest();
  return progress;
}

bool Renderer::render_item(const std::function<bool()>& cancel) {
  const PictureView view = picture_view();
  transport::Wavefront& wavefront = setup_.engine->wavefront();
  if (choosing()) return run_pilot(cancel);
  if (setup_.engine->learns(samples())) return setup_.engine->learn(view, cancel);
  if (solvers::Solver* next = setup_.engine->unready()) {
    const bool rounds = setup_.engine->in_rounds(), went = setup_.engine->prepare(*next, view, cancel);
    if (setup_.engine->in_rounds() != rounds && samples() == 0) start_schedule();
    return went;
  }
  // As soon as every pixel has a sample, so that the picture does not wait, and before errors are published.
  if (solvers::Solver* solver = samples() > 0 ? setup_.engine->owing_errors(*setup_.film) : nullptr) {
    const bool restarted = errors_restart_ != restarts_ || errors_of_ != solver;
    errors_restart_ = restarts_, errors_of_ = solver;
    return setup_.engine->with(*solver, view, [&](const solvers::Picture& picture) {
      return solvers::offered<solvers::LookupErrors>(*solver)->estimate_errors(wavefront, *setup_.film,
                                                                               picture, restarted, cancel);
    });
  }
  if (const std::optional<bool> went = refine(cancel)) return *went;
  if (schedule::AdaptiveSchedule* adaptive = sampling_.adaptive()) {
    const schedule::WorkItem item = adaptive->next();
    if (const std::optional<bool> went = prepare_round(item, cancel)) {
      adaptive->give_back();
      return *went;
    }
    if (!wavefront.run(item, *setup_.film, cancel)) {
      adaptive->give_back();
      return false;
    }
    const std::vector<uint32_t>& tiles = adaptive->to_report();
    std::vector<schedule::TileErrors> errors(tiles.size());
    // One sample a pixel gives no error estimate and decides nothing.
    if (!tiles.empty() && adaptive->tiles()[tiles[0]].samples + item.sample_count > 1) {
      setup_.engine->estimator().estimate_stopping(wavefront.stream(), item.blocks, *setup_.film,
                                                   setup_.seen_range());
      wavefront.account_stages();
      for (size_t i = 0; i < tiles.size(); ++i) {
        const film::RelativeError e = film::relative_error(*setup_.film, adaptive->blocks_of(tiles[i]));
        errors[i] = {float(e.paths), float(e.lookup_noise), float(e.interpolation)};
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
  if (wavefront.run(item, *setup_.film, cancel)) return true;
  sampling_.uniform() = before;
  return false;
}

bool Renderer::run_pilot(const std::function<bool()>& cancel) {
  if (!pilot_) pilot_ = std::make_unique<Pilot>(*device_, *setup_.engine, setup_.width, setup_.height);
  if (!pilot_->step(*setup_.engine, picture_view(), cancel)) return false;
  if (!pilot_->done()) return true;
  findings_ = pilot_->findings(setup_.settings.text("lights.sampling") == "learned");
  pilot_.reset();
  const std::array<plan::Choice, 4> before = setup_.engine->plan().choices;
  scene::Changes changes;
  try {
    apply_plan(Transaction::Target(setup_), changes);
  } catch (const Error& e) {
    log::warning("components: the automatic choice failed, path tracing is used: {}", e.what());
    plan::Plan paths = setup_.engine->plan();
    paths.undecided = false;
    setup_.engine->set_plan(paths);
  }
  const std::array<plan::Choice, 4>& now = setup_.engine->plan().choices;
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
  solvers::Solver* next = setup_.engine->unready_for(sample);
  if (!next) return std::nullopt;
  return setup_.engine->with(*next, picture_view(), [&](const solvers::Picture& picture) {
    return solvers::offered<solvers::Rounds>(*next)->prepare_round(setup_.engine->wavefront(), picture,
                                                                   sample, cancel);
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
      std::any_of(setup_.engine->solvers().begin(), setup_.engine->solvers().end(), holds_light))
    return;
  transport::Wavefront& wavefront = setup_.engine->wavefront();
  wavefront.uncounted([&] {
    setup_.engine->estimator().estimate(wavefront.stream(), *setup_.coarse, setup_.seen_range());
    wavefront.account_stages();
  });
  const double samples = before + 1, pixels = double(setup_.coarse->width()) * setup_.coarse->height();
  path_pace_ = {.seconds = coarse_s_ / (samples * pixels),
                .noise = film::image_error(setup_.coarse->errors()).seen(0) * std::sqrt(samples)};
}

std::optional<stats::SamplePace> Renderer::path_pace() const {
  if (!path_pace_) return std::nullopt;
  return stats::SamplePace{.seconds = path_pace_->seconds * setup_.width * setup_.height,
                           .noise = path_pace_->noise};
}

bool Renderer::draw_draft(const std::function<bool()>& cancel) {
  if (!setup_.engine || !display_) return false;
  const bool prepares = preparing() || choosing();
  if (std::exchange(draft_preparing_, prepares) && !prepares) display_->light_changed();
  const bool filled = samples() > 0;
  const bool sight = !filled && previewed(view()) && display_->sight_wanted(*setup_.engine, picture_view());
  const std::optional<film::ShownError> off = display_->shares().error;
  const DraftPlan::Next what =
      display_->plan().next(prepares, filled, sight, off ? std::optional(off->median) : std::nullopt);
  if (what == DraftPlan::Next::nothing) return false;
  progress_.resume();
  const Timer timer;
  if (!display_->draw(what, *setup_.engine, picture_view(), *setup_.coarse, cancel)) return false;
  if (what == DraftPlan::Next::coarse) note_path_pace(timer.seconds());
  display_->plan().drawn(
      what, timer.seconds(),
      what != DraftPlan::Next::sight || !display_->sight_wanted(*setup_.engine, picture_view()));
  return true;
}

}  // namespace lucerna::session
