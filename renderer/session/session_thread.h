#pragma once
// The session's thread: its state, and its work between commands.
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "base/log.h"
#include "base/timer.h"
#include "film/io/stochastic.h"
#include "session/effect_measurement.h"
#include "session/renderer.h"
#include "session/session.h"
#include "session/tev_link.h"
#include "solvers/registry.h"
#include "stats/forecast.h"

namespace lucerna::session {

inline constexpr double k_publish_seconds = 0.1;  // between pictures while the image refines
inline constexpr double k_numbers_seconds = 0.5;  // between read-backs of the film for shares

/// Thrown by a command that was cancelled as requested.
struct Abandoned {};

struct SessionThread {
  using Command = session::Command<Renderer>;

  explicit SessionThread(const Options& options);
  /// Ends the thread, with pending saves written.
  ~SessionThread();

  Options options;
  std::thread thread;
  mutable std::mutex mutex;
  std::condition_variable wake;
  CommandQueue<Renderer> queue;
  std::atomic<bool> quit{false}, pending{false};
  uint64_t done = 0;  // number of the last command carried out
  // Loads and edits of objects are numbered in order of request; those up to a number are cancelled.
  std::atomic<uint64_t> loads{0}, given_up{0};
  std::shared_ptr<const Snapshot> snapshot;
  State state;
  std::function<void()> published;

  // Used by the session thread only.
  Snapshot next;
  SceneId scene_id = 0;  // of the renderer's scene; the snapshot has it with the first picture
  AccuracyKeeper accuracy;
  Timer since_publish, since_numbers, since_given_up;
  bool paused = false, dirty = true, coarse_wanted = false, better_wanted = false, recall_wanted = false,
       draft_given_up = false, size_known = false;
  bool filled = false;
  double publish_seconds = k_publish_seconds;  // display takes at most a fifth of the time
  double numbers_seconds = k_numbers_seconds;  // and read-backs at most a twentieth
  struct Save {
    std::filesystem::path file;
    std::string solver;  // solver whose data is saved; "": the picture
    bool as_shown = false;
    bool reference = false;  // Session::save_reference
    std::shared_ptr<std::promise<void>> promise;
  };
  std::vector<Save> saves;  // waiting for their data
  struct Measure {
    std::optional<vec2> at;
    std::shared_ptr<std::promise<film::Brightness>> promise;
  };
  std::vector<Measure> measures;                          // waiting for a picture
  std::vector<std::function<void(Renderer&)>> questions;  // likewise; they throw nothing
  std::unique_ptr<EffectMeasurement> effects;             // while it is at work
  std::unique_ptr<TevLink> tev;                           // null: none

  bool works(Renderer& r) const {
    return r.ready() && !paused && (!r.done() || r.output().filter_due()) && !r.waits();
  }

  /// True if the save can run now, or can never succeed (saving reports why).
  bool due(Renderer& r, const Save& save) const {
    if (!save.solver.empty()) {
      const solvers::Solver* solver = r.solver(save.solver);
      return !solver || solvers::ready(*solver);
    }
    // As shown: the finished picture is filtered first.
    if (save.as_shown && r.done() && works(r)) return false;
    return r.samples() > 0 || !works(r);
  }

  static void write(Renderer& r, const Save& save) {
    try {
      if (save.reference)
        film::write_exr(save.file, film::stochastic_layers(r.output().film_image_with_halves(), ""));
      else if (save.solver.empty())
        r.output().save(save.file, save.as_shown);
      else
        r.solvers().save(save.solver, save.file);
      log::info("saved {}", save.file.string());
      save.promise->set_value();
    } catch (const std::exception& e) {
      log::error("{}", e.what());
      save.promise->set_exception(std::current_exception());
    }
  }

  void write_due(Renderer& r) {
    std::erase_if(saves, [&](const Save& save) {
      const bool now = due(r, save);
      if (now) write(r, save);
      return now;
    });
  }

  void measure_due(Renderer& r) {
    if (r.samples() == 0 && !r.previews().begun() && works(r)) return;
    for (const Measure& m : std::exchange(measures, {})) try {
        r.mix().settle();
        m.promise->set_value(r.output().measure(m.at));
      } catch (...) {
        m.promise->set_exception(std::current_exception());
      }
  }

  /// Answers with `answer(renderer)` as soon as the picture has a sample, or rendering rests without.
  template <class T>
  Answer<T> when_pictured(std::function<T(Renderer&)> answer, const char* subject, SceneId scene) {
    auto task = std::make_shared<std::packaged_task<T(Renderer&)>>(std::move(answer));
    Answer<T> result = task->get_future().share();
    const auto question = [this, task](Renderer& r) {
      (*task)(r);
      dirty = true;
    };
    post({.run = [this, question](Renderer&) { questions.push_back(question); },
          .subject = subject,
          .scene = scene});
    return result;
  }

  void answer_due(Renderer& r) {
    if (r.samples() == 0 && works(r)) return;
    for (const auto& question : std::exchange(questions, {})) question(r);
  }

  /// Sends the picture to the viewer if it is time; forgets a viewer that has failed.
  void follow_tev(Renderer& r) {
    try {
      if (!tev || tev->follow(r)) return;
    } catch (const std::exception& e) {
      log::warning("{}; no picture is sent to the viewer", e.what());
    }
    tev.reset();
    dirty = true;
  }

  void serve_due(Renderer& r) {
    write_due(r);
    measure_due(r);
    answer_due(r);
  }

  void give_up_saves(const char* why) {
    for (const Save& save : saves) {
      const std::string before = save.solver.empty() ? std::string("the picture had a sample")
                                                     : solvers::find(save.solver)->title + " was complete";
      const Error error(save.file.string(), fmt::format("not written: {} before {}", why, before));
      log::error("{}", error.what());
      save.promise->set_exception(std::make_exception_ptr(error));
    }
    saves.clear();
  }

  Saved post_save(const std::filesystem::path& file, const std::string& solver, SceneId scene,
                  bool as_shown = false, bool reference = false) {
    // A promise dropped for lack of a device is reported as a failure to its waiter.
    auto promise = std::make_shared<std::promise<void>>();
    Saved saved = promise->get_future().share();
    const auto run = [this, file, solver, as_shown, reference, promise](Renderer& r) {
      saves.push_back({file, solver, as_shown, reference, promise});
      if (!solver.empty() && !due(r, saves.back()))
        log::info("{}: will be written when {} is complete", file.string(), solvers::find(solver)->title);
    };
    post({.run = run, .subject = file.string(), .scene = scene, .saves = true});
    return saved;
  }

  void post(Command command) {
    {
      std::lock_guard lock(mutex);
      queue.push(std::move(command));
      pending = true;
    }
    wake.notify_one();
  }

  /// Lists it as refused in further snapshots.
  void refuse(const Command& command) {
    auto all = next.refused ? std::make_shared<std::vector<uint64_t>>(*next.refused)
                            : std::make_shared<std::vector<uint64_t>>();
    all->push_back(command.number);
    next.refused = std::move(all);
  }

  void publish_activity(const std::string& what, float fraction) {
    next.activity = what;
    next.progress = fraction;
    publish();
  }

  void publish() {
    auto copy = std::make_shared<Snapshot>(next);
    copy->id = ++next.id;
    std::function<void()> call;
    {
      std::lock_guard lock(mutex);
      snapshot = std::move(copy);
      call = published;
    }
    if (call) call();
  }

  void restarted() {
    coarse_wanted = better_wanted = recall_wanted = dirty = true;
    filled = false;
  }

  stats::WorkPace pace;  // of preparation

  /// Updates preparation progress from the solvers' reports and times.
  void update_preparing() {
    next.preparing.clear(), next.preparing_done = -1, next.preparing_left.reset();
    const auto first_with = [this](std::string solvers::Report::*text) {
      return std::find_if(next.reports.begin(), next.reports.end(),
                          [&](const auto& report) { return !((*report).*text).empty(); });
    };
    const auto refining = first_with(&solvers::Report::refining);
    next.refining = refining == next.reports.end() ? "" : (*refining)->refining;
    const auto preparing = first_with(&solvers::Report::preparing);
    if (preparing == next.reports.end()) {
      pace = {};
      return;
    }
    next.preparing = (*preparing)->preparing;
    if (!(*preparing)->progress) return;
    const solvers::Report::Progress& progress = *(*preparing)->progress;
    next.preparing_done = progress.done;
    // Solver time excludes display and preview samples.
    const double done_ms = progress.left_ms * progress.done / std::max(1e-9, 1 - progress.done);
    next.preparing_left = pace.follow(next.seconds, done_ms, progress.left_ms);
  }

  void fill_snapshot(Renderer& r, bool numbers) {
    next.scene_id = scene_id;
    next.width = r.film().width();
    next.height = r.film().height();
    if (dirty || next.rgba.empty() || !r.output().shows_the_same()) {
      const Timer shown;
      next.rgba = r.output().shown_picture(!filled, [&] { return pending.load() || quit; });
      next.scale = r.overlays().scale();
      publish_seconds = std::max(k_publish_seconds, 4 * shown.seconds());
    }
    const film::PreviewShares shares = r.output().preview_shares();
    next.stale_is_preview = r.output().former_is_preview();
    next.stale = shares.stale, next.filtered = shares.filtered, next.shown_error = shares.error;
    const film::View view = r.output().view();
    next.legend = {};
    if (!shared::is_light_layer(view.layer)) next.legend = {.layer = view.layer, .hi = view.scale};
    if (view.layer >= shared::k_layer_samples && !shared::is_own_layer(view.layer))
      next.legend = {view.layer, view.heat.ramp, view.heat.logarithmic, view.heat.lo, view.heat.hi};
    next.tiles = view.tiles > 0;
    next.samples = r.samples();
    next.max_samples = r.sampling().max_samples();
    next.coarse = !filled;
    next.lights_together = r.relight().why_not;
    next.tev = tev ? tev->address() : "";
    next.paused = paused;
    next.finished = r.done();
    next.resting = !works(r) && !effects && !r.overlays().waits() && !r.mix().pending();
    next.seconds = r.progress().seconds();
    next.prepared_seconds = r.progress().prepared_seconds();
    next.reports = r.solvers().reports();
    update_preparing();
    next.path_pace = r.previews().path_pace();
    next.camera = r.camera();
    next.tracer = r.tracer_name();
    next.device = r.device().info().name;
    next.device_mb = double(r.device().allocated_bytes()) / (1 << 20);
    const transport::TransportStats& stats = r.stats();
    next.rays = stats.rays;
    const double tracing = r.progress().render_seconds();
    next.mrays_per_second = tracing > 0 ? 1e-6 * double(stats.rays) / tracing : 0;
    next.dropped = stats.dropped;
    next.stages.clear();
    for (const auto& s : stats.stages) next.stages.push_back({s.name, s.ms, s.host});
    next.mean_samples = double(stats.paths) / (double(next.width) * next.height);
    accuracy.follow(r, scene_id);
    next.accuracy = accuracy.publish(r, numbers || dirty);
    const auto ms = r.progress().component_ms_a_sample();
    for (const int c : k_components) {
      next.components[c].solver = r.choices()[size_t(c)].solver;
      next.components[c].reason = r.choices()[size_t(c)].reason;
      next.components[c].ms_per_sample = ms[size_t(c)];
      const auto& ledger = r.progress().ledger().entries();
      next.components[c].error = ledger.empty() || !ledger.back().has_error
                                     ? std::nullopt
                                     : std::optional(ledger.back().error[size_t(c) + 1]);
    }
    if (numbers) {
      const Timer taken;
      next.host_mb = peak_host_mb();
      const film::Image& image = r.image();
      const auto means = film::Film::means(image);
      double total = 0;
      for (const vec3& m : means) total += luminance(m);
      for (const int c : k_components) {
        next.components[c].mean_luminance = luminance(means[c]);
        next.components[c].share = total > 0 ? luminance(means[c]) / total : 0;
      }
      next.layers = r.layer_status(image);
      numbers_seconds = std::max(k_numbers_seconds, 20 * taken.seconds());
    }
  }

  /// Null if there is no device; logs the reason.
  std::unique_ptr<Renderer> make_renderer();
  /// Runs the first command of the queue. `lock` is held before and after, not meanwhile.
  void carry_out_next(Renderer* renderer, std::unique_lock<std::mutex>& lock);
  /// Traces a preview sample or, with `work`, a work item of the picture; publishes it if it is time.
  void advance(Renderer& renderer, bool work);
  void publish_picture(Renderer& renderer, bool numbers);
  /// Does a part of the measurement of effects.
  void measure_effects();
  /// Ends it, with its result or without.
  void end_effects(std::shared_ptr<const EffectCosts> result);
  /// Writes pending saves before the thread ends; `lock` is held before, not after.
  void end(Renderer* renderer, std::unique_lock<std::mutex>& lock);
  void run();
};

}  // namespace lucerna::session
