#include "session/session.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "base/log.h"
#include "base/timer.h"
#include "session/renderer.h"
#include "solvers/registry.h"
#include "stats/forecast.h"

namespace lucerna::session {

const std::array<const char*, k_components> k_component_names = paths::k_component_names;

namespace {
constexpr double k_publish_seconds = 0.1;  // between pictures while the image refines
constexpr double k_draft_seconds = 0.5;    // without a draft at most, while edits come one after the other
// Without another mix, after which the last one is taken up in full.
constexpr double k_mix_pause_seconds = 0.2;
constexpr double k_numbers_seconds = 0.5;  // between read-backs of the film for shares
constexpr int k_nice = 10;                 // rendering yields to the window's thread

/// Thrown by a command that has ended without effect, as was wished.
struct Abandoned {};
}  // namespace

struct Session::Impl {
  Options options;
  std::thread thread;
  mutable std::mutex mutex;
  std::condition_variable wake;
  CommandQueue queue;
  std::atomic<bool> quit{false}, pending{false};
  uint64_t done = 0;  // number of the last command that was carried out
  // Loads are numbered as they are asked for; those up to a number are given up.
  std::atomic<uint64_t> loads{0}, given_up{0};
  std::shared_ptr<const Snapshot> snapshot;
  State state;
  std::function<void()> published;

  // Of the session thread alone.
  Snapshot next;
  SceneId scene_id = 0;  // of the renderer's scene; the snapshot has it with the first picture
  AccuracyKeeper accuracy;
  Timer since_publish, since_numbers, since_given_up;
  bool paused = false, dirty = true, coarse_wanted = false, better_wanted = false, recall_wanted = false,
       draft_given_up = false, size_known = false;
  bool filled = false;
  double publish_seconds = k_publish_seconds;  // showing takes no more than a fifth of the time
  double numbers_seconds = k_numbers_seconds;  // and read-backs no more than a twentieth
  struct Save {
    std::filesystem::path file;
    std::string solver;  // whose work it keeps; "": the picture
    bool as_shown = false;
    std::shared_ptr<std::promise<void>> promise;
  };
  std::vector<Save> saves;  // that wait for what they are to write
  struct Measure {
    std::optional<vec2> at;
    std::shared_ptr<std::promise<film::Brightness>> promise;
  };
  std::vector<Measure> measures;  // that wait for a picture

  bool works(Renderer& r) const { return r.ready() && !paused && !r.done() && !r.waits(); }

  /// Whether it is to be written now, or cannot be, which writing will tell.
  bool due(Renderer& r, const Save& save) const {
    if (!save.solver.empty()) {
      const solvers::Solver* solver = r.solver(save.solver);
      return !solver || solver->ready();
    }
    return r.samples() > 0 || !works(r);
  }

  static void write(Renderer& r, const Save& save) {
    try {
      if (save.solver.empty())
        r.save(save.file, save.as_shown);
      else
        r.solver_save(save.solver, save.file);
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
    if (r.samples() == 0 && !r.has_draft() && works(r)) return;
    for (const Measure& m : std::exchange(measures, {})) try {
        r.settle_mix();
        m.promise->set_value(r.measure(m.at));
      } catch (...) {
        m.promise->set_exception(std::current_exception());
      }
  }

  void serve_due(Renderer& r) {
    write_due(r);
    measure_due(r);
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
                  bool as_shown = false) {
    // A promise that is dropped, for want of a device, is a failure to the one who waits.
    auto promise = std::make_shared<std::promise<void>>();
    Saved saved = promise->get_future().share();
    const auto run = [this, file, solver, as_shown, promise](Renderer& r) {
      saves.push_back({file, solver, as_shown, promise});
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

  /// The snapshots from now on say that this one was refused.
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

  stats::WorkPace pace;  // of what is prepared

  /// From the reports of the solvers and the time that their work has taken so far.
  void tell_preparing() {
    next.preparing.clear(), next.preparing_done = -1, next.preparing_left.reset();
    const auto told = std::find_if(next.reports.begin(), next.reports.end(),
                                   [](const auto& report) { return !report->preparing.empty(); });
    if (told == next.reports.end()) {
      pace = {};
      return;
    }
    next.preparing = (*told)->preparing;
    if (!(*told)->progress) return;
    const solvers::Report::Progress& progress = *(*told)->progress;
    next.preparing_done = progress.done;
    // The solver is not at work all the time: pictures are shown and preview samples drawn between.
    const double done_ms = progress.left_ms * progress.done / std::max(1e-9, 1 - progress.done);
    next.preparing_left = pace.follow(next.seconds, done_ms, progress.left_ms);
  }

  void fill_snapshot(Renderer& r, bool numbers) {
    next.scene_id = scene_id;
    next.width = r.film().width();
    next.height = r.film().height();
    if (dirty || next.rgba.empty() || !r.shows_the_same()) {
      const Timer shown;
      next.rgba = r.shown_picture(!filled, [&] { return pending.load() || quit; });
      publish_seconds = std::max(k_publish_seconds, 4 * shown.seconds());
    }
    const film::PreviewShares shares = r.preview_shares();
    next.stale = shares.stale, next.filtered = shares.filtered, next.shown_error = shares.error;
    const film::View view = r.view();
    next.legend = {};
    if (view.layer >= shared::k_layer_samples)
      next.legend = {view.layer, view.heat.ramp, view.heat.logarithmic, view.heat.lo, view.heat.hi};
    next.tiles = view.tiles > 0;
    next.samples = r.samples();
    next.max_samples = r.max_samples();
    next.coarse = !filled;
    next.lights_together = r.relight().why_not;
    next.paused = paused;
    next.finished = r.done();
    next.seconds = r.seconds();
    next.reports = r.reports();
    tell_preparing();
    next.path_pace = r.path_pace();
    next.camera = r.camera();
    next.tracer = r.tracer_name();
    next.device = r.device().info().name;
    next.device_mb = double(r.device().allocated_bytes()) / (1 << 20);
    const transport::TransportStats& stats = r.stats();
    next.rays = stats.rays;
    const double tracing = r.render_seconds();
    next.mrays_per_second = tracing > 0 ? 1e-6 * double(stats.rays) / tracing : 0;
    next.dropped = stats.dropped;
    next.stages.clear();
    for (const auto& s : stats.stages) next.stages.push_back({s.name, s.ms, s.host});
    next.mean_samples = double(stats.paths) / (double(next.width) * next.height);
    accuracy.follow(r, scene_id);
    next.accuracy = accuracy.publish(r, numbers || dirty);
    const auto ms = r.component_ms_a_sample();
    for (int c = 0; c < k_components; ++c) {
      next.components[c].solver = r.settings().text(std::string("components.") + k_component_names[c]);
      next.components[c].ms_per_sample = ms[size_t(c)];
    }
    if (numbers) {
      const Timer taken;
      next.host_mb = peak_host_mb();
      const auto means = film::Film::means(r.image());
      double total = 0;
      for (const vec3& m : means) total += luminance(m);
      for (int c = 0; c < k_components; ++c) {
        next.components[c].mean_luminance = luminance(means[c]);
        next.components[c].share = total > 0 ? luminance(means[c]) / total : 0;
      }
      numbers_seconds = std::max(k_numbers_seconds, 20 * taken.seconds());
    }
  }

  /// Null where there is no device to render with, which is told.
  std::unique_ptr<Renderer> make_renderer();
  /// The first command of the queue. `lock` is held before and after, not meanwhile.
  void carry_out_next(Renderer* renderer, std::unique_lock<std::mutex>& lock);
  /// A draft or, where there is `work`, a piece of the picture; publishes it when it is time.
  void advance(Renderer& renderer, bool work);
  void publish_picture(Renderer& renderer, bool numbers);
  /// What is still to be written, before the thread ends; `lock` is held before and not after.
  void end(Renderer* renderer, std::unique_lock<std::mutex>& lock);
  void run();
};

std::unique_ptr<Renderer> Session::Impl::make_renderer() {
  try {
    auto renderer = std::make_unique<Renderer>(
        RendererOptions{options.device, options.validation, options.shaders, {}, true, options.scenes});
    next.device = renderer->device().info().name;
    publish();
    return renderer;
  } catch (const std::exception& e) {
    log::error("{}", e.what());
    publish_activity(std::string("no device: ") + e.what(), -1);
    return nullptr;
  }
}

void Session::Impl::carry_out_next(Renderer* renderer, std::unique_lock<std::mutex>& lock) {
  Command command = queue.pop();
  const uint64_t number = command.number;
  lock.unlock();
  try {
    if (!renderer) throw Error("device", "there is none to render with");
    if (command.scene == k_any_scene || command.scene == scene_id) {
      command.run(*renderer);
    } else {
      log::warning("a command for {} was left out: another scene was loaded before its turn",
                   command.subject);
      refuse(command);
    }
  } catch (const Abandoned&) {
    refuse(command);
  } catch (const std::exception& e) {
    log::error("{}", e.what());
    refuse(command);
  }
  command = {};
  if (renderer) {
    try {
      serve_due(*renderer);
    } catch (const std::exception& e) {
      log::error("{}", e.what());
    }
    lock.lock();
    state = {scene_id, renderer->scene(), renderer->settings()};
    pending = !queue.empty();
    lock.unlock();
  }
  next.activity.clear();
  next.progress = -1;
  next.commands = number;
  dirty = true;
  lock.lock();
  done = next.commands;
}

void Session::Impl::advance(Renderer& renderer, bool work) {
  // What was there before, as it is seen now, does not wait for new light.
  if (std::exchange(recall_wanted, false) && renderer.remembers()) publish_picture(renderer, false);
  bool changed = dirty;
  // A row of edits that come faster than drafts are drawn shows some of them all the same.
  const auto draft_cancelled = [&] {
    return quit || (pending && (!draft_given_up || since_given_up.seconds() < k_draft_seconds));
  };
  if (!paused && renderer.draw_draft(draft_cancelled)) {
    draft_given_up = false;
    changed = changed || renderer.draft_news();
    // The first one is shown at once, and the first of light that has got better; more of them as pictures
    // are.
    if (renderer.has_draft())
      changed = changed || std::exchange(coarse_wanted, false);
    else
      coarse_wanted = coarse_wanted || std::exchange(better_wanted, false);
  } else if (pending && coarse_wanted) {
    if (!std::exchange(draft_given_up, true)) since_given_up.restart();
  } else if (work && renderer.step([&] { return pending.load() || quit; })) {
    accuracy.follow(renderer, scene_id);
  }
  // The last line of the ledger is that of the finished image.
  if (renderer.done() && !renderer.ledger().entries().empty() &&
      renderer.ledger().entries().back().paths != renderer.stats().paths)
    renderer.finish_ledger();
  if (!filled && renderer.samples() > 0) filled = changed = true;
  if (changed || since_publish.seconds() > publish_seconds || renderer.done() || renderer.waits())
    publish_picture(renderer, renderer.samples() > 0 && !renderer.mix_pending() &&
                                  (since_numbers.seconds() > numbers_seconds || renderer.done() || paused));
}

/// `numbers`: with what has to be read back from the film.
void Session::Impl::publish_picture(Renderer& renderer, bool numbers) {
  if (numbers) since_numbers.restart();
  fill_snapshot(renderer, numbers);
  publish();
  since_publish.restart();
  dirty = false;
}

void Session::Impl::end(Renderer* renderer, std::unique_lock<std::mutex>& lock) {
  while (!queue.empty())
    if (const Command command = queue.pop();
        command.saves && renderer && (command.scene == k_any_scene || command.scene == scene_id))
      command.run(*renderer);
  lock.unlock();
  std::erase_if(saves, [&](const Save& save) {
    if (save.solver.empty()) write(*renderer, save);
    return save.solver.empty();
  });
  give_up_saves("the program ended");
}

void Session::Impl::run() {
  // Threads that the device starts inherit this, so that the window is served first.
  setpriority(PRIO_PROCESS, id_t(syscall(SYS_gettid)), k_nice);
  const std::unique_ptr<Renderer> renderer = make_renderer();
  std::unique_lock lock(mutex);
  while (!quit) {
    while (!queue.empty() && !quit) carry_out_next(renderer.get(), lock);
    pending = false;
    // A drag at a group's slider: what it shows comes first, the film's sums and more samples when it pauses.
    const bool mixing = renderer && renderer->mix_pending();
    if (mixing && !dirty && wake.wait_for(lock, std::chrono::duration<double>(k_mix_pause_seconds), [&] {
          return quit || !queue.empty();
        }))
      continue;
    const bool work = renderer && works(*renderer) && !(mixing && dirty);
    if (renderer && !work) renderer->rest();
    if (!work && !dirty && !mixing) {
      wake.wait(lock, [&] { return quit || !queue.empty(); });
      continue;
    }
    lock.unlock();
    try {
      if (renderer && renderer->ready()) {
        if (mixing && !dirty) {
          // A drag has shown samples as they are, which may be few: the filter comes before more of them.
          renderer->settle_mix();
          publish_picture(*renderer, false);
        }
        advance(*renderer, work);
      } else {
        publish();
        dirty = false;
      }
    } catch (const std::exception& e) {
      log::error("{}", e.what());
      next.activity.clear();
      next.progress = -1;
      next.paused = paused = true;
      // A picture of the scene before is none of this one.
      if (next.scene_id != scene_id && renderer)
        next.scene_id = scene_id, next.camera = renderer->camera(), next.rgba.clear();
      publish();
      dirty = false;
    }
    if (renderer) serve_due(*renderer);
    lock.lock();
  }
  end(renderer.get(), lock);
}

Session::Session(const Options& options) : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->thread = std::thread([this] { impl_->run(); });
}

Session::~Session() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->quit = true;
    impl_->given_up = impl_->loads.load();
    impl_->pending = true;
  }
  impl_->wake.notify_one();
  impl_->thread.join();
}

void Session::load(const std::filesystem::path& file) {
  const uint64_t number = ++impl_->loads;
  const auto run = [s = impl_.get(), file, number](Renderer& r) {
    Timer since;
    const auto goes_on = [&] { return number > s->given_up; };
    try {
      r.load(file, [&](float fraction, const std::string& what) {
        if (since.seconds() > 0.05 || fraction == 0) {
          s->publish_activity(fmt::format("loading {}: {}", file.filename().string(), what), fraction);
          since.restart();
        }
        return goes_on();
      });
    } catch (const Error&) {
      if (goes_on()) throw;
      log::info("{}: loading was given up", file.string());
      throw Abandoned();
    }
    ++s->scene_id;
    s->restarted();
    s->give_up_saves("another scene was loaded");
    const auto count = [](uint64_t n, const char* what) {
      return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
    };
    log::info("{} loaded: {}, {}, {}", file.string(), count(scene::count_triangles(*r.scene()), "triangle"),
              count(r.scene()->lights.size(), "lamp"), count(r.scene()->cameras.size(), "camera"));
  };
  impl_->post({.run = run, .subject = file.string()});
}

void Session::set(const std::string& key, const std::string& value, SceneId scene) {
  const auto run = [s = impl_.get(), key, value](Renderer& r) {
    const uint64_t before = r.restarts();
    r.settings().set(key, value, "setting");
    r.apply_settings();
    if (r.restarts() != before) s->restarted();
  };
  impl_->post({.run = run, .subject = key, .scene = scene});
}

void Session::set_camera(const scene::Camera& camera, SceneId scene) {
  const auto run = [s = impl_.get(), camera](Renderer& r) {
    r.set_camera(camera);
    s->restarted();
  };
  impl_->post({.run = run, .subject = "the camera", .scene = scene, .camera = true});
}

void Session::set_size(uint32_t width, uint32_t height) {
  const auto run = [s = impl_.get(), width, height](Renderer& r) {
    r.set_size(width, height);
    s->restarted();
  };
  impl_->post({.run = run, .subject = "the size"});
}

void Session::set_light(uint32_t index, const scene::Light& light, SceneId scene) {
  const auto run = [s = impl_.get(), index, light](Renderer& r) {
    r.set_light(index, light);
    s->restarted();
  };
  impl_->post({.run = run, .subject = "a light", .scene = scene});
}

void Session::set_environment(float scale, float rotation_degrees, SceneId scene) {
  const auto run = [s = impl_.get(), scale, rotation_degrees](Renderer& r) {
    r.set_environment(scale, rotation_degrees);
    s->restarted();
  };
  impl_->post({.run = run, .subject = "the environment", .scene = scene});
}

void Session::set_environment_file(const std::filesystem::path& file, std::optional<float> scale,
                                   std::optional<float> rotation_degrees, SceneId scene) {
  const auto run = [s = impl_.get(), file, scale, rotation_degrees](Renderer& r) {
    if (!file.empty()) s->publish_activity(fmt::format("reading {}", file.filename().string()), -1);
    r.set_environment_file(file, scale, rotation_degrees);
    s->restarted();
    if (!file.empty()) log::info("{} lights the scene", file.string());
  };
  impl_->post({.run = run, .subject = "the environment", .scene = scene});
}

void Session::set_material(uint32_t index, const scene::Material& material, SceneId scene) {
  const auto run = [s = impl_.get(), index, material](Renderer& r) {
    r.set_material(index, material);
    s->restarted();
  };
  impl_->post({.run = run, .subject = "a material", .scene = scene});
}

void Session::set_lights(const LightsEdit& edit, SceneId scene) {
  const auto run = [s = impl_.get(), edit](Renderer& r) {
    const uint64_t before = r.restarts();
    r.set_lights(edit);
    if (r.restarts() != before) s->restarted();
  };
  impl_->post({.run = run, .subject = "the lights", .scene = scene});
}

void Session::set_paused(bool paused) {
  const auto run = [s = impl_.get(), paused](Renderer&) { s->paused = paused; };
  impl_->post({.run = run, .subject = "rendering"});
}

void Session::restart() {
  const auto run = [s = impl_.get()](Renderer& r) {
    r.restart();
    s->restarted();
  };
  impl_->post({.run = run, .subject = "rendering"});
}

void Session::reload_shaders() {
  const auto run = [s = impl_.get()](Renderer& r) {
    const Timer timer;
    r.reload_shaders();
    s->restarted();
    log::info("shaders reloaded in {:.2f} s", timer.seconds());
  };
  impl_->post({.run = run, .subject = "the shaders"});
}

void Session::set_reference(const std::filesystem::path& file, SceneId scene) {
  const auto run = [file](Renderer& r) {
    r.set_reference(file);
    r.finish_ledger();  // what there is is held against it at once
    log::info("{} is the reference", file.string());
  };
  impl_->post({.run = run, .subject = "the reference", .scene = scene});
}

void Session::clear_reference() {
  const auto run = [](Renderer& r) { r.clear_reference(); };
  impl_->post({.run = run, .subject = "the reference"});
}

void Session::inspect(std::optional<vec2> at, SceneId scene) {
  const auto run = [at](Renderer& r) { r.inspect(at); };
  impl_->post({.run = run, .subject = "a place of the picture", .scene = scene});
}

std::shared_future<film::Brightness> Session::measure(std::optional<vec2> at, SceneId scene) {
  auto promise = std::make_shared<std::promise<film::Brightness>>();
  auto result = promise->get_future().share();
  const auto run = [s = impl_.get(), at, promise](Renderer&) { s->measures.push_back({at, promise}); };
  impl_->post({.run = run, .subject = "the exposure", .scene = scene});
  return result;
}

Saved Session::save(const std::filesystem::path& file, bool as_shown) {
  return impl_->post_save(file, "", k_any_scene, as_shown);
}

Saved Session::solver_save(const std::string& solver, const std::filesystem::path& file, SceneId scene) {
  return impl_->post_save(file, solver, scene);
}

void Session::solver_load(const std::string& solver, const std::filesystem::path& file, SceneId scene) {
  const auto run = [s = impl_.get(), solver, file](Renderer& r) {
    r.solver_load(solver, file);
    s->restarted();
  };
  impl_->post({.run = run, .subject = file.string(), .scene = scene});
}

void Session::solver_command(const std::string& solver, const std::string& command, SceneId scene) {
  const auto run = [s = impl_.get(), solver, command](Renderer& r) {
    const solvers::SolverInfo* info = solvers::find(solver);
    if (!info || !solvers::find_command(*info, command))
      throw Error(solver, fmt::format("there is no command '{}'", command));
    r.solver_command(solver, command);
    s->paused = false;
  };
  impl_->post({.run = run, .subject = solver + "." + command, .scene = scene});
}

uint64_t Session::commands() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->queue.given();
}

uint64_t Session::commands_done() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->done;
}

void Session::cancel() { impl_->given_up = impl_->loads.load(); }

std::shared_ptr<const Snapshot> Session::snapshot() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->snapshot;
}

State Session::state() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->state;
}

void Session::on_publish(std::function<void()> call) {
  std::lock_guard lock(impl_->mutex);
  impl_->published = std::move(call);
}

}  // namespace lucerna::session
