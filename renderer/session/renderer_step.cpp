// Work items of the picture: preparation, samples, learning.
#include <algorithm>
#include <utility>

#include "base/log.h"
#include "pilot/findings.h"
#include "session/renderer.h"

namespace lucerna::session {

bool Renderer::step(const std::function<bool()>& cancel) {
  if (setup_.engine) mix_.settle();
  if (setup_.engine && samples() > 0 && sampling_.judged_otherwise()) sampling_.change(progress_);
  if (output_.filter_due()) {
    output_.step_filter(cancel);
    return true;
  }
  if (!setup_.engine || done()) return false;
  progress_.resume();
  const Timer timer;
  setup_.engine->begin_samples(picture_view());
  const bool prepares = preparing(), learns = setup_.engine->learns(samples());
  const uint64_t rays = stats().rays + stats().shadow_rays;
  const bool progress = render_item(cancel);
  if (sampling_.region_due()) sampling_.change(progress_);
  output_.judge_filtered();
  progress_.add_render_seconds(timer.seconds());
  output_.worked(timer.seconds());
  if (prepares) {
    progress_.note_prepared();
    hurry();
  } else if (progress && !learns)
    progress_.note(false);
  if (!prepares && choosing()) {
    if (!learns) judge_pilot(timer.seconds(), stats().rays + stats().shadow_rays - rays);
  } else if (!prepares)
    review_choice();
  if (done()) progress_.rest();
  return progress;
}

void Renderer::hurry() {
  if (options_.patience && progress_.seconds() > plan::k_most_preparation * *options_.patience &&
      preparing() && !solvers_.stepped() && solvers_.usable())
    solvers_.finish_early();
}

bool Renderer::render_item(const std::function<bool()>& cancel) {
  const PictureView view = picture_view();
  transport::Wavefront& wavefront = setup_.engine->wavefront();
  if (setup_.engine->learns(samples())) return setup_.engine->learn(view, cancel);
  if (solvers::Solver* next = setup_.engine->unready()) {
    const bool rounds = setup_.engine->in_rounds(), went = setup_.engine->prepare(*next, view, cancel);
    if (setup_.engine->in_rounds() != rounds && samples() == 0) sampling_.restart();
    return went;
  }
  if (const std::optional<bool> went = lookups_.step(cancel)) return *went;
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
  if (schedule::BalancedSchedule* balanced = sampling_.balanced()) {  // no solver works in rounds
    if (balanced->waits()) balanced->judge(progress_.block_squares());
    const schedule::BalancedSchedule before = *balanced;
    if (wavefront.run(balanced->next(), *setup_.film, cancel)) return true;
    *balanced = before;
    return false;
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

void Renderer::judge_pilot(double seconds, uint64_t rays) {
  pilot_.note(samples(), seconds, rays);
  if (!pilot_.complete(plan::goal_of(setup_.settings, nullptr), seconds_limit_, sampling_.even_samples()))
    return;
  findings_ = pilot::evaluate(setup_.film->read(), samples());
  findings_->pixels = double(setup_.width) * setup_.height;
  findings_->rays = pilot_.sample_rays() / findings_->pixels;
  findings_->seconds = pilot_.sample_seconds();
  if (seconds_limit_ && findings_->seconds > 0) {
    // Other solvers begin the picture again.
    findings_->begun = solvers::Findings::Begun{
        .samples = double(samples()), .sample = 1, .spent = progress_.seconds() / findings_->seconds};
    findings_->begun->solvers.fill("path");
  }
  choose_solvers();
}

void Renderer::choose_by_previews() {
  if (!choosing()) return;
  if (std::optional<solvers::Findings> findings = previews_.findings()) {
    findings_ = findings;
    choose_solvers();
  }
}

void Renderer::choose_solvers() {
  review_.restart();
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
  if (changes.settings.empty()) return;
  notify_settings_changed();
  restart(changes);
  if (Display* display = output_.display()) display->goes_on();
}

void Renderer::review_choice() {
  if (!seconds_limit_ || !findings_ || reviewed_ || findings_->seconds <= 0) return;
  const std::array<plan::Choice, 4>& chosen = choices();
  // Paths cost what the pilot has measured.
  if (std::all_of(chosen.begin(), chosen.end(),
                  [](const plan::Choice& c) { return c.reason.empty() || c.solver == "path"; }))
    return;
  const auto begun = review_.note(samples(), progress_.seconds(), findings_->seconds);
  if (!begun) return;
  findings_->begun = begun, reviewed_ = true;
  for (size_t c = 0; c < chosen.size(); ++c) findings_->begun->solvers[c] = chosen[c].solver;
  choose_solvers();
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

}  // namespace lucerna::session
