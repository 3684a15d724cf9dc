#pragma once
// A session without a renderer, so that window and commands can be tested alone: it edits scenes as the
// renderer does and shows a moving gradient. Files with "missing" in their names fail to load and to save;
// those with "slow" load in three seconds and save in half a second; "empty" is a scene without cameras and
// lights, "sheen" one that needs an unsupported extension.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <thread>

#include "base/log.h"
#include "fake_picture.h"
#include "session/scene_edit.h"

namespace lucerna::session {

class FakeSession final : public Session {
 public:
  FakeSession() : thread_([this] { run(); }) {}
  ~FakeSession() override {
    stop_ = true, given_up_ = loads_.load();
    wake_.notify_all();
    thread_.join();
  }

  std::atomic<int> busy_ms{0};     ///< duration of each command
  std::atomic<int> drawing_ms{0};  ///< duration of the first picture after each command

  void load(const std::filesystem::path& file, bool, bool) override {
    post([this, file, number = ++loads_] { open(file, number); });
  }
  /// A light mix named "nonsense" is refused.
  void set(const std::string& key, const std::string& value, SceneId scene) override {
    post(
        [this, key, value] {
          if (key == "relight.mix" && value == "nonsense") throw Error(key, "no mix of lights");
          std::lock_guard lock(mutex_);
          now_.state.settings.set(key, value);
        },
        scene);
  }
  void set_camera(const scene::Camera& camera, SceneId scene) override {
    post([this, camera] { now_.camera = camera, restart_now(); }, scene, true);
  }
  /// Pictures wider than 4096 pixels are refused.
  void set_size(uint32_t width, uint32_t height) override {
    post([this, width, height] {
      if (width > 4096) throw Error("size", "too large");
      now_.width = width, now_.height = height, restart_now();
    });
  }
  void set_window_scale(uint32_t) override {
    post([] {});
  }
  void set_light(uint32_t index, const scene::Light& light, SceneId scene) override {
    edit(scene, [=](const ScenePtr& s) { return with_light(s, index, light); });
  }
  void set_light_list(const std::vector<scene::Light>& lights, SceneId scene) override {
    edit(scene, [=](const ScenePtr& s) { return with_light_list(s, lights); });
  }
  void set_environment(float scale, float rotation, SceneId scene) override {
    edit(scene, [=](const ScenePtr& s) { return with_environment(s, scale, rotation); });
  }
  /// No image is read; files named "broken" cannot be read.
  void set_environment_file(const std::filesystem::path& file, std::optional<float> scale,
                            std::optional<float> rotation, SceneId scene) override {
    edit(scene, [=, this](const ScenePtr& s) {
      if (file.string().find("broken") != std::string::npos)
        throw Error(file.string(), "the image cannot be decoded");
      auto edited = std::make_shared<scene::Scene>(*s);
      edited->environment = now_.state.loaded->environment;
      if (!file.empty()) edited->environment.file = file.string();
      edited->environment.scale = scale.value_or(s->environment.scale);
      edited->environment.rotation = rotation.value_or(s->environment.rotation);
      return edited;
    });
  }
  void set_environment_sky(const scene::SkyModel& sky, float scale, SceneId scene) override {
    edit(scene, [=](const ScenePtr& s) {
      auto edited = std::make_shared<scene::Scene>(*s);
      edited->environment = {};
      edited->environment.image = 0, edited->environment.given = true;
      edited->environment.scale = scale, edited->environment.sky = sky;
      return edited;
    });
  }
  void set_material(uint32_t index, const scene::Material& material,
                    const std::optional<scene::TextureSources>& textures, SceneId scene) override {
    edit(scene, [=, this](const ScenePtr& s) {
      return textures ? with_material(s, *now_.state.loaded, index, material, *textures, uint64_t(1) << 30)
                      : with_material(s, index, material);
    });
  }
  void set_lights(const LightsEdit& lights, SceneId scene) override {
    edit(
        scene,
        [=, this](const ScenePtr& s) {
          const EditedScene edited = with_strengths(s, lights);
          std::lock_guard lock(mutex_);
          now_.state.settings.set("relight.mix", lights.mix);
          return edited;
        },
        false);
  }
  void set_instances(const std::vector<ObjectEdit>& edits, SceneId scene) override {
    edit(scene, [=](const ScenePtr& s) { return with_objects(s, edits); });
  }
  void set_paused(bool paused) override {
    post([this, paused] { now_.paused = paused; });
  }
  void restart() override {
    post([this] { restart_now(); });
  }
  void reload_shaders() override {
    post([] {
      log::error("surface.comp:42: 'throughputt' : undeclared identifier; the kernels in use stay");
    });
  }
  void set_reference(const std::filesystem::path& file, SceneId scene) override {
    post(
        [this, file] {
          check_present(file, "cannot be opened");
          now_.reference = file.filename().string();
        },
        scene);
  }
  void clear_reference() override {
    post([this] { now_.reference.clear(); });
  }
  void inspect(std::optional<vec2> at, SceneId scene) override {
    post([this, at] { now_.looked_at = at; }, scene);
  }
  /// A grey of half of middle brightness, black at the left border; the whole picture needs 2.5 stops more.
  Answer<film::Brightness> measure(std::optional<vec2> at, SceneId scene) override {
    return answer<film::Brightness>(scene, [at] {
      return at && at->x < 0.05f ? film::Brightness{} : film::Brightness{vec3(0.09f), at ? 1.0f : 2.5f};
    });
  }
  void measure_effects(SceneId scene) override {
    post(
        [this] {
          EffectCosts costs{.width = now_.width, .height = now_.height, .sample_ms = 400};
          costs.effects = {{.key = "tertiary", .label = "Deeper interreflection", .ms = 120, .ms_error = 4},
                           {.key = "primary", .label = "Emitters and direct light", .ms = 80, .ms_error = 4}};
          now_.effect_costs = std::make_shared<const EffectCosts>(costs);
        },
        scene);
  }
  void stop_measuring_effects() override {}
  Answer<film::FilmImage> layers(SceneId scene) override {
    return answer<film::FilmImage>(scene,
                                   [this] { return fake::layers(now_.samples, now_.width, now_.height); });
  }
  Answer<std::shared_ptr<const recording::Recording>> trace_paths(const vec2& at, uint32_t samples,
                                                                  SceneId scene) override {
    return answer<std::shared_ptr<const recording::Recording>>(scene, [=, this] {
      return std::make_shared<const recording::Recording>(fake::paths(samples, now_.width, now_.height, at));
    });
  }
  void show_paths(const ShownPaths&, SceneId scene) override {
    post([] {}, scene);
  }
  Answer<recording::NoiseReport> explain_noise(const vec2&, const vec2&, SceneId scene) override {
    return answer<recording::NoiseReport>(scene, fake::noise);
  }
  Answer<std::shared_ptr<const HeldPicture>> held_picture(SceneId scene) override {
    return answer<std::shared_ptr<const HeldPicture>>(
        scene, [this] { return std::make_shared<const HeldPicture>(fake::held(now_)); });
  }
  void send_to_tev(const std::optional<std::string>& address) override {
    post([this, address] { now_.tev = address ? "127.0.0.1:" + *address : ""; });
  }
  Saved save(const std::filesystem::path& file, bool) override {
    return answer<void>(k_any_scene, [file] {
      if (has(file, "slow")) std::this_thread::sleep_for(std::chrono::milliseconds(500));
      try {
        check_present(file, "the folder does not exist");
        log::info("saved {}", file.string());
      } catch (const Error& error) {
        log::error("{}", error.what());
        throw;
      }
    });
  }
  Saved save_reference(const std::filesystem::path& file) override { return save(file, false); }
  Saved solver_save(const std::string&, const std::filesystem::path& file, SceneId) override {
    return save(file, false);
  }
  void solver_load(const std::string&, const std::filesystem::path& file, SceneId scene) override {
    post(
        [this, file] {
          check_present(file, "cannot be read");
          restart_now();
        },
        scene);
  }
  void solver_command(const std::string& solver, const std::string& command, SceneId scene) override {
    post(
        [this, solver, command] {
          if (solver != "cache") log::info("{}: command {}", solver, command);
          if (solver + "." + command == "cache.step") ++now_.stages;
          if (solver + "." + command == "cache.run") now_.cache_runs = true;
          now_.paused = false;
        },
        scene);
  }
  void cancel() override { given_up_ = loads_.load(); }
  uint64_t commands() const override {
    std::lock_guard lock(mutex_);
    return queue_.given();
  }
  uint64_t commands_done() const override {
    std::lock_guard lock(mutex_);
    return done_;
  }
  std::shared_ptr<const Snapshot> snapshot() const override {
    std::lock_guard lock(mutex_);
    return snapshot_;
  }
  State state() const override {
    std::lock_guard lock(mutex_);
    return now_.state;
  }
  void on_publish(std::function<void()> call) override {
    std::lock_guard lock(mutex_);
    published_ = std::move(call);
  }

 private:
  struct Refused {};

  static bool has(const std::filesystem::path& file, const char* word) {
    return file.string().find(word) != std::string::npos;
  }
  static void check_present(const std::filesystem::path& file, const char* otherwise) {
    if (has(file, "missing")) throw Error(file.string(), otherwise);
  }

  void post(const std::function<void()>& run, SceneId scene = k_any_scene, bool camera = false) {
    std::lock_guard lock(mutex_);
    queue_.push(
        {.run = [run](FakeSession&) { run(); }, .subject = {}, .scene = scene, .replaces = camera ? 1u : 0u});
    wake_.notify_all();
  }

  template <class T>
  Answer<T> answer(SceneId scene, std::function<T()> question) {
    auto task = std::make_shared<std::packaged_task<T()>>(std::move(question));
    Answer<T> result = task->get_future().share();
    post([task] { (*task)(); }, scene);
    return result;
  }

  /// Edits the scene, and restarts the picture or keeps it.
  void edit(SceneId of, const std::function<EditedScene(const ScenePtr&)>& change, bool restarts = true) {
    post(
        [this, change, restarts] {
          const EditedScene edited = change(now_.state.scene);
          {
            std::lock_guard lock(mutex_);
            now_.state.scene = edited;
          }
          if (restarts) restart_now();
        },
        of);
  }

  void restart_now() { now_.restart(), publish(); }

  void open(const std::filesystem::path& file, uint64_t number) {
    const std::string name = file.filename().string();
    const int steps = has(name, "slow") ? 60 : 6;
    for (int i = 0; i < steps && number > given_up_; ++i) {
      now_.activity = "loading " + name + ": textures " + std::to_string(100 * i / steps) + " %";
      now_.progress = static_cast<float>(i) / static_cast<float>(steps);
      publish();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    now_.activity.clear(), now_.progress = -1;
    if (number <= given_up_) {
      log::info("{}: loading was cancelled", file.string());
      throw Refused();
    }
    if (has(name, "missing")) throw Error(file.string(), "no such file; expected a .gltf or .glb scene");
    {
      auto fresh = std::make_shared<scene::Scene>(fake::make_scene(file));
      now_.camera = scene::starting_camera(*fresh, "");
      std::lock_guard lock(mutex_);
      now_.state.scene = now_.state.loaded = fresh;
      ++now_.state.scene_id;
      log::info("{}: 14 materials, 253 112 triangles", file.string());
      log::warning("{}: the extension KHR_materials_sheen is not known and was passed over", file.string());
    }
    restart_now();
  }

  void publish() {
    auto s = std::make_shared<Snapshot>(fake::snapshot(now_));
    s->id = ++id_;
    s->commands = done_;
    if (!refused_.empty()) s->refused = std::make_shared<const std::vector<uint64_t>>(refused_);
    std::function<void()> call;
    {
      std::lock_guard lock(mutex_);
      snapshot_ = std::move(s);
      call = published_;
    }
    if (call) call();
  }

  void carry_out(const Command<FakeSession>& command) {
    try {
      if (command.scene != k_any_scene && command.scene != now_.state.scene_id) throw Refused();
      command.run(*this);
    } catch (const Error& error) {
      log::error("{}", error.what());
      refused_.push_back(command.number);
    } catch (const Refused&) {
      refused_.push_back(command.number);
    }
  }

  void run() {
    while (!stop_) {
      std::optional<Command<FakeSession>> command;
      {
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, std::chrono::milliseconds(30), [&] { return stop_ || !queue_.empty(); });
        if (!queue_.empty()) command = queue_.pop();
      }
      if (command) {
        if (const int ms = busy_ms) std::this_thread::sleep_for(std::chrono::milliseconds(ms));
        carry_out(*command);
        {
          std::lock_guard lock(mutex_);
          done_ = command->number;
        }
        if (const int ms = drawing_ms) std::this_thread::sleep_for(std::chrono::milliseconds(ms));
        publish();
      } else if (now_.works()) {
        ++now_.samples;
        publish();
      }
    }
  }

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  CommandQueue<FakeSession> queue_;
  uint64_t done_ = 0, id_ = 0;
  std::vector<uint64_t> refused_;
  std::shared_ptr<const Snapshot> snapshot_;
  std::function<void()> published_;
  std::atomic<bool> stop_{false};
  std::atomic<uint64_t> loads_{0}, given_up_{0};
  fake::Fake now_;  ///< used by the thread; its state is guarded
  std::thread thread_;
};

}  // namespace lucerna::session
