#include "session/session.h"

#include "session/session_thread.h"

namespace lucerna::session {
namespace {

constexpr uint64_t k_camera = 1;  // Command::replaces

/// The same for steps of a drag of a material's number: the material and its textures.
uint64_t drag_of(uint32_t material, const std::optional<scene::TextureSources>& textures) {
  uint64_t key = material;
  const auto add = [&key](uint64_t value) { key = (key ^ value) * 0x9e3779b97f4a7c15u; };
  add(textures.has_value());
  if (textures)
    for (const auto& [slot, source] : *textures)
      add(slot), add(uint64_t(source.kind)), add(source.material), add(std::hash<std::string>()(source.file));
  return key | uint64_t{1} << 63;
}

/// Sends each command to the session's thread.
class RenderSession final : public Session {
 public:
  explicit RenderSession(const Options& options) : thread_(options) {}

  void load(const std::filesystem::path& file, bool outside, bool choose) override {
    const uint64_t number = ++thread_.loads;
    const auto run = [s = &thread_, file, number, outside, choose](Renderer& r) {
      Timer since;
      const auto goes_on = [&] { return number > s->given_up; };
      try {
        r.load(
            file,
            [&](float fraction, const std::string& what) {
              if (since.seconds() > 0.05 || fraction == 0) {
                s->publish_activity(fmt::format("loading {}: {}", file.filename().string(), what), fraction);
                since.restart();
              }
              return goes_on();
            },
            {}, outside, choose);
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
      const uint64_t glowing =
          uint64_t(std::count_if(r.scene()->materials.begin(), r.scene()->materials.end(),
                                 [](const scene::Material& m) { return m.emission != vec3(0); }));
      log::info("{} loaded: {}, {}{}, {}", file.string(),
                count(scene::count_triangles(*r.scene()), "triangle"),
                count(r.scene()->lights.size(), "lamp"),
                glowing > 0 ? ", " + count(glowing, "emissive material") : std::string(),
                count(r.scene()->cameras.size(), "camera"));
    };
    thread_.post({.run = run, .subject = file.string()});
  }

  void set(const std::string& key, const std::string& value, SceneId scene) override {
    const auto run = [s = &thread_, key, value](Renderer& r) {
      const uint64_t before = r.restarts();
      r.settings().set(key, value, "setting");
      r.apply_settings();
      if (r.restarts() != before) s->restarted();
    };
    thread_.post({.run = run, .subject = key, .scene = scene});
  }

  void set_camera(const scene::Camera& camera, SceneId scene) override {
    const auto run = [s = &thread_, camera](Renderer& r) {
      r.set_camera(camera);
      s->restarted();
    };
    thread_.post({.run = run, .subject = "the camera", .scene = scene, .replaces = k_camera});
  }

  void set_size(uint32_t width, uint32_t height) override {
    const auto run = [s = &thread_, width, height](Renderer& r) {
      r.set_size(width, height);
      s->restarted();
    };
    thread_.post({.run = run, .subject = "the size"});
  }

  void set_window_scale(uint32_t scale) override {
    const auto run = [s = &thread_, scale](Renderer& r) {
      r.overlays().set_window_scale(scale);
      s->dirty = true;
    };
    thread_.post({.run = run, .subject = "the scale of the window"});
  }

  void set_light(uint32_t index, const scene::Light& light, SceneId scene) override {
    const auto run = [s = &thread_, index, light](Renderer& r) {
      r.set_light(index, light);
      s->restarted();
    };
    thread_.post({.run = run, .subject = "a light", .scene = scene});
  }

  void set_light_list(const std::vector<scene::Light>& lights, SceneId scene) override {
    const auto run = [s = &thread_, lights](Renderer& r) {
      const uint64_t before = r.restarts();
      r.set_light_list(lights);
      if (r.restarts() != before) s->restarted();
    };
    thread_.post({.run = run, .subject = "the lights", .scene = scene});
  }

  void set_environment(float scale, float rotation_degrees, SceneId scene) override {
    const auto run = [s = &thread_, scale, rotation_degrees](Renderer& r) {
      r.set_environment(scale, rotation_degrees);
      s->restarted();
    };
    thread_.post({.run = run, .subject = "the environment", .scene = scene});
  }

  void set_environment_file(const std::filesystem::path& file, std::optional<float> scale,
                            std::optional<float> rotation_degrees, SceneId scene) override {
    const auto run = [s = &thread_, file, scale, rotation_degrees](Renderer& r) {
      if (!file.empty()) s->publish_activity(fmt::format("reading {}", file.filename().string()), -1);
      r.set_environment_file(file, scale, rotation_degrees);
      s->restarted();
      if (!file.empty()) log::info("{} lights the scene", file.string());
    };
    thread_.post({.run = run, .subject = "the environment", .scene = scene});
  }

  void set_environment_sky(const scene::SkyModel& sky, float scale, SceneId scene) override {
    const auto run = [s = &thread_, sky, scale](Renderer& r) {
      r.set_environment_sky(sky, scale);
      s->restarted();
    };
    thread_.post({.run = run, .subject = "the sky", .scene = scene});
  }

  void set_material(uint32_t index, const scene::Material& material,
                    const std::optional<scene::TextureSources>& textures, SceneId scene) override {
    edit_surfaces(
        "a material", "changing a material", "the material stays as it was", scene,
        [index, material, textures](Renderer& r, const Progress& progress) {
          r.set_material(index, material, textures, progress);
        },
        drag_of(index, textures));
  }

  void set_lights(const LightsEdit& edit, SceneId scene) override {
    const auto run = [s = &thread_, edit](Renderer& r) {
      const uint64_t before = r.restarts();
      r.set_lights(edit);
      if (r.restarts() != before) s->restarted();
    };
    thread_.post({.run = run, .subject = "the lights", .scene = scene});
  }

  void set_instances(const std::vector<ObjectEdit>& edits, SceneId scene) override {
    edit_surfaces("an object", "moving objects", "they stay where they were", scene,
                  [edits](Renderer& r, const Progress& progress) { r.set_instances(edits, progress); });
  }

  void set_paused(bool paused) override {
    const auto run = [s = &thread_, paused](Renderer&) { s->paused = paused; };
    thread_.post({.run = run, .subject = "rendering"});
  }

  void restart() override {
    const auto run = [s = &thread_](Renderer& r) {
      r.restart();
      s->restarted();
    };
    thread_.post({.run = run, .subject = "rendering"});
  }

  void reload_shaders() override {
    const auto run = [s = &thread_](Renderer& r) {
      const Timer timer;
      r.reload_shaders();
      s->restarted();
      log::info("shaders reloaded in {:.2f} s", timer.seconds());
    };
    thread_.post({.run = run, .subject = "the shaders"});
  }

  void set_reference(const std::filesystem::path& file, SceneId scene) override {
    const auto run = [file](Renderer& r) {
      r.progress().set_reference(file);
      r.finish_ledger();  // the present samples are compared at once
      log::info("{} is the reference", file.string());
    };
    thread_.post({.run = run, .subject = "the reference", .scene = scene});
  }

  void clear_reference() override {
    const auto run = [](Renderer& r) { r.progress().clear_reference(); };
    thread_.post({.run = run, .subject = "the reference"});
  }

  void inspect(std::optional<vec2> at, SceneId scene) override {
    const auto run = [at](Renderer& r) { r.overlays().inspect(at); };
    thread_.post({.run = run, .subject = "a place of the picture", .scene = scene});
  }

  Answer<film::Brightness> measure(std::optional<vec2> at, SceneId scene) override {
    auto promise = std::make_shared<std::promise<film::Brightness>>();
    auto result = promise->get_future().share();
    const auto run = [s = &thread_, at, promise](Renderer&) { s->measures.push_back({at, promise}); };
    thread_.post({.run = run, .subject = "the exposure", .scene = scene});
    return result;
  }

  void measure_effects(SceneId scene) override {
    const auto run = [s = &thread_](Renderer& r) {
      s->effects = std::make_unique<EffectMeasurement>(
          r, RendererOptions{.shaders = s->options.shaders, .scenes = s->options.scenes});
      s->next.measures_effects = true;
    };
    thread_.post({.run = run, .subject = "the effects", .scene = scene});
  }

  void stop_measuring_effects() override {
    const auto run = [s = &thread_](Renderer&) {
      if (s->effects) s->end_effects(s->next.effect_costs);
    };
    thread_.post({.run = run, .subject = "the effects"});
  }

  Answer<film::FilmImage> layers(SceneId scene) override {
    auto task = std::make_shared<std::packaged_task<film::FilmImage(Renderer&)>>(
        [](Renderer& r) { return r.output().film_image_with_halves(); });
    Answer<film::FilmImage> result = task->get_future().share();
    const auto run = [task](Renderer& r) { (*task)(r); };
    thread_.post({.run = run, .subject = "the layers", .scene = scene});
    return result;
  }

  Answer<std::shared_ptr<const recording::Recording>> trace_paths(const vec2& at, uint32_t samples,
                                                                  SceneId scene) override {
    return thread_.when_pictured<std::shared_ptr<const recording::Recording>>(
        [at, samples](Renderer& r) {
          const uvec2 pixel = pixel_at(at, r.film().width(), r.film().height());
          recording::Recording all = r.paths().begin();
          r.paths().record(choices_of({.left = pixel.x,
                                       .top = pixel.y,
                                       .right = pixel.x + 1,
                                       .bottom = pixel.y + 1,
                                       .samples = samples},
                                      all.width, all.height),
                           all);
          auto recorded = std::make_shared<const recording::Recording>(std::move(all));
          r.overlays().show_paths({recorded});
          return recorded;
        },
        "the paths of a pixel", scene);
  }

  void show_paths(const ShownPaths& paths, SceneId scene) override {
    const auto run = [paths](Renderer& r) { r.overlays().show_paths(paths); };
    thread_.post({.run = run, .subject = "recorded paths", .scene = scene});
  }

  Answer<recording::NoiseReport> explain_noise(const vec2& lo, const vec2& hi, SceneId scene) override {
    return thread_.when_pictured<recording::NoiseReport>(
        [lo, hi](Renderer& r) { return r.paths().explain_noise(lo, hi); }, "the noise of the picture", scene);
  }

  Answer<std::shared_ptr<const HeldPicture>> held_picture(SceneId scene) override {
    return thread_.when_pictured<std::shared_ptr<const HeldPicture>>(
        [](Renderer& r) { return std::make_shared<const HeldPicture>(r.output().held_picture()); },
        "the picture to be held", scene);
  }

  void send_to_tev(const std::optional<std::string>& address) override {
    const auto run = [s = &thread_, address](Renderer& r) {
      s->tev.reset();
      if (!address) return;
      const film::TevAddress to = film::parse_tev_address(*address, "tev.send");
      if (!r.scene()) throw Error("tev.send", "no scene is open");
      s->tev = std::make_unique<TevLink>(to, r.scene()->name);
      s->follow_tev(r);
    };
    thread_.post({.run = run, .subject = "the viewer"});
  }

  Saved save(const std::filesystem::path& file, bool as_shown) override {
    return thread_.post_save(file, "", k_any_scene, as_shown);
  }

  Saved save_reference(const std::filesystem::path& file) override {
    return thread_.post_save(file, "", k_any_scene, false, true);
  }

  Saved solver_save(const std::string& solver, const std::filesystem::path& file, SceneId scene) override {
    return thread_.post_save(file, solver, scene);
  }

  void solver_load(const std::string& solver, const std::filesystem::path& file, SceneId scene) override {
    const auto run = [s = &thread_, solver, file](Renderer& r) {
      r.solver_load(solver, file);
      s->restarted();
    };
    thread_.post({.run = run, .subject = file.string(), .scene = scene});
  }

  void solver_command(const std::string& solver, const std::string& command, SceneId scene) override {
    const auto run = [s = &thread_, solver, command](Renderer& r) {
      const solvers::SolverInfo* info = solvers::find(solver);
      if (!info || !solvers::find_command(*info, command))
        throw Error(solver, fmt::format("there is no command '{}'", command));
      r.solvers().command(solver, command);
      s->paused = false;
    };
    thread_.post({.run = run, .subject = solver + "." + command, .scene = scene});
  }

  uint64_t commands() const override {
    std::lock_guard lock(thread_.mutex);
    return thread_.queue.given();
  }

  uint64_t commands_done() const override {
    std::lock_guard lock(thread_.mutex);
    return thread_.done;
  }

  void cancel() override { thread_.given_up = thread_.loads.load(); }

  std::shared_ptr<const Snapshot> snapshot() const override {
    std::lock_guard lock(thread_.mutex);
    return thread_.snapshot;
  }

  State state() const override {
    std::lock_guard lock(thread_.mutex);
    return thread_.state;
  }

  void on_publish(std::function<void()> call) override {
    std::lock_guard lock(thread_.mutex);
    thread_.published = std::move(call);
  }

 private:
  /// Posts an edit that may have to make the surfaces again: with progress in snapshots if it takes long, and
  /// ended by cancel(). `otherwise`: what is so then.
  void edit_surfaces(const char* subject, const std::string& doing, const std::string& otherwise,
                     SceneId scene, const std::function<void(Renderer&, const Progress&)>& edit,
                     uint64_t replaces = 0) {
    const uint64_t number = ++thread_.loads;
    const auto run = [s = &thread_, doing, otherwise, edit, number](Renderer& r) {
      constexpr double k_silent_seconds = 0.3;
      const Timer timer;
      Timer since;
      const uint64_t before = r.restarts();
      try {
        edit(r, [&](float fraction, const std::string& what) {
          if (timer.seconds() > k_silent_seconds && since.seconds() > 0.05) {
            s->publish_activity(doing + ": " + what, fraction);
            since.restart();
          }
          return number > s->given_up;
        });
      } catch (const Error&) {
        if (number > s->given_up) throw;
        log::info("{} was cancelled: {}", doing, otherwise);
        throw Abandoned();
      }
      if (r.restarts() != before) s->restarted();
    };
    thread_.post({.run = run, .subject = subject, .scene = scene, .replaces = replaces});
  }

  SessionThread thread_;
};

}  // namespace

std::unique_ptr<Session> start_session(const Options& options) {
  return std::make_unique<RenderSession>(options);
}

}  // namespace lucerna::session
