#include "session/session.h"

#include "session/session_thread.h"

namespace lucerna::session {

Session::Session(const Options& options) : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  if (!options.idle) impl_->thread = std::thread([this] { impl_->run(); });
}

Session::~Session() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->quit = true;
    impl_->given_up = impl_->loads.load();
    impl_->pending = true;
  }
  impl_->wake.notify_one();
  if (impl_->thread.joinable()) impl_->thread.join();
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
      log::info("{}: loading was cancelled", file.string());
      throw Abandoned();
    }
    ++s->scene_id;
    if (s->tev)
      s->tev = std::make_unique<TevLink>(film::parse_tev_address(s->tev->address(), ""), r.scene()->name);
    s->end_effects(nullptr);
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

void Session::set_window_scale(uint32_t scale) {
  const auto run = [s = impl_.get(), scale](Renderer& r) {
    r.set_window_scale(scale);
    s->dirty = true;
  };
  impl_->post({.run = run, .subject = "the scale of the window"});
}

void Session::set_light(uint32_t index, const scene::Light& light, SceneId scene) {
  const auto run = [s = impl_.get(), index, light](Renderer& r) {
    r.set_light(index, light);
    s->restarted();
  };
  impl_->post({.run = run, .subject = "a light", .scene = scene});
}

void Session::set_light_list(const std::vector<scene::Light>& lights, SceneId scene) {
  const auto run = [s = impl_.get(), lights](Renderer& r) {
    const uint64_t before = r.restarts();
    r.set_light_list(lights);
    if (r.restarts() != before) s->restarted();
  };
  impl_->post({.run = run, .subject = "the lights", .scene = scene});
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

void Session::set_environment_sky(const scene::SkyModel& sky, float scale, SceneId scene) {
  const auto run = [s = impl_.get(), sky, scale](Renderer& r) {
    r.set_environment_sky(sky, scale);
    s->restarted();
  };
  impl_->post({.run = run, .subject = "the sky", .scene = scene});
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

void Session::set_instances(const std::vector<ObjectEdit>& edits, SceneId scene) {
  const uint64_t number = ++impl_->loads;
  const auto run = [s = impl_.get(), edits, number](Renderer& r) {
    constexpr double k_silent_seconds = 0.3;
    const Timer timer;
    Timer since;
    const uint64_t before = r.restarts();
    try {
      r.set_instances(edits, [&](float fraction, const std::string& what) {
        if (timer.seconds() > k_silent_seconds && since.seconds() > 0.05) {
          s->publish_activity("moving objects: " + what, fraction);
          since.restart();
        }
        return number > s->given_up;
      });
    } catch (const Error&) {
      if (number > s->given_up) throw;
      log::info("the edit of objects was cancelled: they stay where they were");
      throw Abandoned();
    }
    if (r.restarts() != before) s->restarted();
  };
  impl_->post({.run = run, .subject = "an object", .scene = scene});
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
    r.finish_ledger();  // the present samples are compared at once
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

void Session::measure_effects(SceneId scene) {
  const auto run = [s = impl_.get()](Renderer& r) {
    s->effects = std::make_unique<EffectMeasurement>(
        r, RendererOptions{.shaders = s->options.shaders, .scenes = s->options.scenes});
    s->next.measures_effects = true;
  };
  impl_->post({.run = run, .subject = "the effects", .scene = scene});
}

void Session::stop_measuring_effects() {
  const auto run = [s = impl_.get()](Renderer&) {
    if (s->effects) s->end_effects(s->next.effect_costs);
  };
  impl_->post({.run = run, .subject = "the effects"});
}

std::shared_future<film::FilmImage> Session::layers(SceneId scene) {
  auto promise = std::make_shared<std::promise<film::FilmImage>>();
  auto result = promise->get_future().share();
  const auto run = [promise](Renderer& r) {
    try {
      promise->set_value(r.film_image_with_halves());
    } catch (...) {
      promise->set_exception(std::current_exception());
    }
  };
  impl_->post({.run = run, .subject = "the layers", .scene = scene});
  return result;
}

std::shared_future<std::shared_ptr<const recording::Recording>> Session::trace_paths(const vec2& at,
                                                                                     uint32_t samples,
                                                                                     SceneId scene) {
  return impl_->when_pictured<std::shared_ptr<const recording::Recording>>(
      [at, samples](Renderer& r) {
        const uvec2 pixel = pixel_at(at, r.film().width(), r.film().height());
        recording::Recording all = r.begin_recording();
        r.record_paths(choices_of({.left = pixel.x,
                                   .top = pixel.y,
                                   .right = pixel.x + 1,
                                   .bottom = pixel.y + 1,
                                   .samples = samples},
                                  all.width, all.height),
                       all);
        auto recorded = std::make_shared<const recording::Recording>(std::move(all));
        r.show_paths({recorded});
        return recorded;
      },
      "the paths of a pixel", scene);
}

void Session::show_paths(const ShownPaths& paths, SceneId scene) {
  const auto run = [paths](Renderer& r) { r.show_paths(paths); };
  impl_->post({.run = run, .subject = "recorded paths", .scene = scene});
}

std::shared_future<recording::NoiseReport> Session::explain_noise(const vec2& lo, const vec2& hi,
                                                                  SceneId scene) {
  return impl_->when_pictured<recording::NoiseReport>(
      [lo, hi](Renderer& r) { return r.explain_noise(lo, hi); }, "the noise of the picture", scene);
}

std::shared_future<std::shared_ptr<const HeldPicture>> Session::held_picture(SceneId scene) {
  return impl_->when_pictured<std::shared_ptr<const HeldPicture>>(
      [](Renderer& r) { return std::make_shared<const HeldPicture>(r.held_picture()); },
      "the picture to be held", scene);
}

void Session::send_to_tev(const std::optional<std::string>& address) {
  const auto run = [s = impl_.get(), address](Renderer& r) {
    s->tev.reset();
    if (!address) return;
    const film::TevAddress to = film::parse_tev_address(*address, "tev.send");
    if (!r.scene()) throw Error("tev.send", "no scene is open");
    s->tev = std::make_unique<TevLink>(to, r.scene()->name);
    s->follow_tev(r);
  };
  impl_->post({.run = run, .subject = "the viewer"});
}

Saved Session::save(const std::filesystem::path& file, bool as_shown) {
  return impl_->post_save(file, "", k_any_scene, as_shown);
}

Saved Session::save_reference(const std::filesystem::path& file) {
  return impl_->post_save(file, "", k_any_scene, false, true);
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
