#pragma once
// A session without a renderer: the same class, defined here with a moving gradient as picture, so that the
// window can be run and tested alone. In a program that includes this file it replaces the real one of the
// library. Files with "missing" in their names fail to load and to save; those with "slow" load in three
// seconds and save in half a second; "empty" is a scene without cameras and lights, "sheen" one that needs an
// unsupported extension.
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <mutex>
#include <thread>

#include "base/log.h"
#include "base/timer.h"
#include "scene/view_text.h"
#include "session/effect_costs.h"
#include "session/session.h"
#include "solvers/irradiance_cache/report.h"

namespace lucerna::session {

namespace fake {

/// The report of an additional solver of a test, from the settings and the inspected point.
inline std::function<std::optional<solvers::Report>(const plan::Settings&, std::optional<vec2>)> more;

/// Every pixel is 0.5 with a noise that falls with the samples; the first lamp's switch is not looked at.
inline film::FilmImage layers(uint32_t samples, uint32_t width, uint32_t height) {
  film::FilmImage image{.width = width, .height = height};
  const size_t n = size_t{width} * height;
  for (const char* name : {"R", "G", "B", "odd.R", "odd.G", "odd.B"}) {
    std::vector<float> plane(n);
    for (size_t i = 0; i < n; ++i)
      plane[i] = 0.5f + 0.1f * std::sin(float(i * 7919) + (name[0] == 'o' ? 1.0f : 0.0f));
    image.channels.emplace_back(name, plane);
  }
  image.channels.emplace_back("samples", std::vector<float>(n, float(samples)));
  return image;
}

/// Duration of each command.
inline std::atomic<int> busy_ms{0};

/// Duration of the first picture after each command.
inline std::atomic<int> drawing_ms{0};

/// Paths of one pixel: the camera, a wall, and a lamp whose light every third path does not reach.
inline recording::Recording paths(uint32_t count, uint32_t width, uint32_t height, const vec2& at) {
  recording::Recording all;
  all.width = width, all.height = height, all.scene = "fake";
  all.materials = {"wall"}, all.lights = {"Lamp"};
  const auto event = [](uint32_t kind, uint32_t parent, uint32_t lobe, uint32_t component, float light) {
    recording::Event e{};
    e.parent = parent;
    e.bits = kind | lobe << shared::k_path_by_shift | component << shared::k_path_component_shift |
             255u << shared::k_path_group_shift;
    e.contribution = vec3(light);
    e.material = kind == shared::k_path_surface ? 0 : shared::k_path_no_event;
    e.light = 0, e.record = shared::k_path_no_event;
    return e;
  };
  const uint32_t x = std::min(uint32_t(at.x * float(width)), width - 1),
                 y = std::min(uint32_t(at.y * float(height)), height - 1);
  for (uint32_t i = 0; i < count; ++i) {
    all.paths.push_back({y * width + x, i, uint32_t(all.events.size()), 4, 0});
    const bool arrives = i % 3 != 2;
    all.events.push_back(event(shared::k_path_camera, shared::k_path_no_event, 15, 15, 0));
    all.events.push_back(event(shared::k_path_surface, 0, 15, 15, 0));
    all.events.push_back(
        event(arrives ? shared::k_path_light : shared::k_path_blocked, 1, 0, 0, 0.1f * float(i + 1)));
    all.events.push_back(event(shared::k_path_end, 1, 15, 15, 0));
  }
  return all;
}

inline recording::NoiseReport noise() {
  recording::NoiseReport report{.pixels = 64, .paths = 1024, .of_sample = 0.5};
  report.components = {{"caustic", 0.9, 0.2}, {"primary", 0.1, 0.8}};
  report.words = {{"EDSL", 0.9, 0.2}, {"EDL", 0.1, 0.8}};
  report.lights = {{"Lamp", 1, 1}};
  report.materials = {{"glass", 0.9, 0.2}, {"wall", 0.1, 0.8}};
  report.sentence = recording::noise_sentence(report, false);
  report.cure = {{{"components.caustic", "photons"}}, "Caustic light by photons", "photons find it"};
  return report;
}

inline scene::Scene make_scene(const std::filesystem::path& file) {
  scene::Scene scene;
  scene.name = file.stem().string();
  scene.file = file.string();
  scene::Mesh box;
  box.name = "room";
  scene::Primitive p;
  p.positions = {{-3, 0, -4}, {3, 0, -4}, {3, 3, 4}};
  p.triangles = {{0, 1, 2}};
  box.primitives.push_back(p);
  scene.meshes.push_back(box);
  if (scene.name == "empty") {
    scene.materials.emplace_back();
    scene.instances.push_back({.name = "", .mesh = 0});
    return scene;
  }
  const auto camera = [&](const char* name, vec3 eye, vec3 target) {
    scene::Camera c;
    c.name = name;
    c.to_world = glm::inverse(glm::lookAt(eye, target, vec3(0, 1, 0)));
    scene.cameras.push_back(c);
  };
  camera("Entrance", {0, 1.65f, 3.5f}, {0, 1.4f, 0});
  camera("Under the gallery, looking towards the skylight and the hanging cloth", {2, 1.65f, -3},
         {0, 1.5f, 0});
  camera("Detail", {0.5f, 1, 1}, {0, 0.5f, 0});
  const auto light = [&](const char* name, scene::LightKind kind, vec3 intensity) {
    scene::Light l;
    l.name = name, l.kind = kind, l.intensity = intensity, l.position = {0, 2, 0};
    l.id = static_cast<scene::Id>(scene.lights.size());
    scene.lights.push_back(l);
  };
  light("Sun", scene::LightKind::directional, {3.1f, 2.9f, 2.6f});
  light("Brass lamp", scene::LightKind::point, {12, 9, 5.5f});
  light("Reading lamp on the north wall, second from the left", scene::LightKind::spot, {40, 38, 36});
  const auto material = [&](const char* name, vec3 colour, float roughness,
                            float metallic) -> scene::Material& {
    scene::Material m;
    m.name = name, m.base_color = vec4(colour, 1), m.roughness = roughness, m.metallic = metallic;
    scene.materials.push_back(m);
    return scene.materials.back();
  };
  material("Worn limestone", {0.62f, 0.58f, 0.5f}, 0.9f, 0);
  material("Brass", {0.91f, 0.72f, 0.35f}, 0.25f, 1);
  auto& glass = material("Lamp glass", {1, 1, 1}, 0.02f, 0);
  glass.transmission = 1, glass.thickness = 0.01f, glass.attenuation_distance = 0.2f,
  glass.attenuation_color = {0.8f, 0.9f, 0.85f};
  material("Linen cloth", {0.7f, 0.66f, 0.6f}, 1, 0).diffuse_transmission = 0.4f;
  material("Filament", {0, 0, 0}, 1, 0).emission = {40, 28, 12};
  for (int i = 0; i < 9; ++i)
    material(("Tile " + std::to_string(i)).c_str(), vec3(0.1f * static_cast<float>(i)), 0.5f, 0);
  for (int i = 0; i < 40; ++i) scene.instances.push_back({.name = "column " + std::to_string(i), .mesh = 0});
  scene.environment.file = "sky/late_morning_2k.exr";
  scene.environment.image = 0;
  scene.images.emplace_back();
  if (scene.name == "sheen") scene.unknown_extensions = {"KHR_materials_sheen"};
  return scene;
}

}  // namespace fake

struct Session::Impl {
  std::mutex mutex;
  std::condition_variable wake;
  CommandQueue commands;
  std::map<uint64_t, std::function<void()>> runs;  ///< by number
  std::vector<uint64_t> refused;
  std::shared_ptr<const Snapshot> snapshot;
  std::shared_ptr<const scene::Scene> scene, loaded;
  plan::Settings settings;
  std::function<void()> call;
  std::atomic<bool> stop{false};
  std::atomic<uint64_t> loads{0}, given_up{0};
  uint32_t width = 0, height = 0;
  scene::Camera camera;
  uint64_t id = 0, scene_id = 0;
  uint32_t samples = 0;
  uint64_t run_number = 0;
  bool paused = false;
  std::string tev;
  std::string reference;
  std::optional<vec2> looked_at;
  std::shared_ptr<const EffectCosts> effect_costs;
  // The build of the cache since the last pause: six stages, then it is complete.
  uint32_t stages = 0;
  bool cache_runs = false;
  uint64_t done = 0;

  std::string activity;
  float progress = -1;
  std::thread thread;

  Impl() : thread([this] { run(); }) {}
  ~Impl() {
    stop = true, given_up = loads.load();
    wake.notify_all();
    thread.join();
  }

  void post(const std::function<void()>& command, SceneId scene = k_any_scene, bool camera = false) {
    std::lock_guard lock(mutex);
    commands.push({.run = {}, .subject = {}, .scene = scene, .camera = camera});
    runs[commands.given()] = command;
    wake.notify_all();
  }

  /// Posts an edit of the scene, which restarts the picture or keeps it.
  void post_edit(const std::function<void(scene::Scene&)>& edit, SceneId of, bool restarts = true) {
    const auto act = [this, edit, restarts] {
      auto edited = std::make_shared<scene::Scene>(*scene);
      edit(*edited);
      {
        std::lock_guard lock(mutex);
        scene = edited;
      }
      if (restarts) restart(), publish();
    };
    post(act, of);
  }

  void publish() {
    auto s = std::make_shared<Snapshot>();
    s->id = ++id, s->scene_id = scene_id, s->camera = camera, s->activity = activity, s->progress = progress;
    s->device = "llvmpipe (LLVM 15.0.6, 256 bits)", s->tracer = "host";
    s->max_samples = static_cast<uint32_t>(settings.integer("samples"));
    s->commands = done;
    if (!refused.empty()) s->refused = std::make_shared<const std::vector<uint64_t>>(refused);
    s->tev = tev;
    s->samples = samples, s->paused = paused, s->finished = scene && samples >= s->max_samples;
    s->resting = s->paused || s->finished;
    s->coarse = samples == 0;
    if (scene && width > 0) {
      s->width = width, s->height = height;
      s->rgba.resize(size_t{width} * height * 4);
      const float gain = std::exp2(static_cast<float>(settings.real("film.ev")));
      for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
          uint8_t* p = &s->rgba[(size_t{y} * width + x) * 4];
          const vec3 d = glm::normalize(
              vec3(camera.to_world * vec4((static_cast<float>(x) - 0.5f * static_cast<float>(width)) /
                                              static_cast<float>(height),
                                          0.5f - static_cast<float>(y) / static_cast<float>(height), -1, 0)));
          const float grid = std::abs(std::sin(12 * d.x)) * std::abs(std::sin(12 * d.y));
          for (int c = 0; c < 3; ++c)
            p[c] = static_cast<uint8_t>(
                std::clamp(gain * (40 + 90 * (d[c] * 0.5f + 0.5f) + 60 * grid), 0.0f, 255.0f));
          p[3] = 255;
        }
    }
    s->seconds = 0.2 * samples;
    s->mean_samples = samples;
    if (scene && width > 0) {
      s->accuracy = accuracy();
      if (settings.text("film.layer") == "error")
        s->legend = {shared::k_layer_error, shared::k_ramp_magma, true, 0.005f, 0.5f};
      s->tiles = settings.boolean("overlay.tiles");
    }
    if (scene && width > 0 && cached())
      s->reports.push_back(
          std::make_shared<solvers::Report>(irradiance_cache::make_report(cache(), settings)));
    if (scene && width > 0 && fake::more)
      if (const auto reported = fake::more(settings, looked_at))
        s->reports.push_back(std::make_shared<solvers::Report>(*reported));
    s->effect_costs = effect_costs;
    s->mrays_per_second = 3.42, s->rays = 1234567ull * samples;
    s->device_mb = 212, s->host_mb = 1480;
    const double shares[] = {0.618, 0.241, 0.126, 0.015}, ms[] = {412, 380, 1210, 96};
    for (size_t c = 0; c < k_components; ++c) {
      s->components[c].solver = settings.text(std::string("components.") + k_component_names[c]);
      s->components[c].share = shares[c], s->components[c].ms_per_sample = ms[c],
      s->components[c].mean_luminance = 0.4 * shares[c];
    }
    const char* names[] = {"camera",    "trace closest", "surface", "direct light",
                           "trace any", "scatter",       "film",    "tone map"};
    const double cost[] = {12, 840, 310, 260, 520, 190, 44, 6};
    for (size_t i = 0; i < 8; ++i) s->stages.push_back({names[i], cost[i] * samples, i == 1 || i == 4});
    std::function<void()> report;
    {
      std::lock_guard lock(mutex);
      snapshot = s;
      report = call;
    }
    if (report) report();
  }

  /// A render whose noise falls as expected; every other one starts at twice the noise. Seconds grow with
  /// samples, independent of the machine.
  std::shared_ptr<const Accuracy> accuracy() const {
    auto a = std::make_shared<Accuracy>();
    a->run = run_number, a->scene_id = scene_id, a->settings = settings.all();
    a->adaptive = settings.text("sampling.mode") == "adaptive";
    a->target = settings.real("sampling.target_error");
    a->min_samples = 16, a->max_samples = 1024, a->tile = 16, a->across = (width + 15) / 16;
    a->pixels = double(width) * height;
    a->reference = reference, a->reference_applies = !reference.empty();
    const double shares[] = {1, 0.62, 0.24, 0.13, 0.4};
    for (double n = 2; n <= samples; n = std::max(n + 1, 1.25 * n)) {
      stats::Entry e;
      e.samples = n, e.paths = static_cast<uint64_t>(n * a->pixels), e.rays = 7 * e.paths;
      e.has_error = true, e.wall_s = e.render_s = e.device_s = 0.2 * n;
      for (size_t k = 0; k < 5; ++k) e.error[k] = (run_number % 2 ? 0.8 : 1.6) * shares[k] / std::sqrt(n);
      e.of_mean.error = e.error;
      if (!reference.empty()) {
        e.truth = e.of_mean.error;
        for (double& x : *e.truth) x *= 1.1;
      }
      a->ledger.add(e);
      a->hardest.push_back(2 * e.error[0]);
    }
    a->paths = samples * a->pixels, a->rays = 7 * a->paths;
    const uint32_t rows = (height + 15) / 16;
    for (uint32_t i = 0; i < rows * a->across; ++i) {
      TileStatus t;
      t.samples = samples, t.pixels = 256;
      t.error =
          static_cast<float>(1.6 / std::sqrt(std::max(1u, samples))) * (0.3f + 0.7f * float(i % 13) / 12);
      t.state = double{t.error} <= a->target ? shared::k_tile_done : shared::k_tile_active;
      t.heavy_tailed = i % 17 == 0;
      a->tiles.push_back(t);
    }
    a->stages = {"camera", "trace closest", "surface"};
    for (uint32_t i = 0; i < std::min(samples, 40u); ++i)
      a->passes.push_back({{2.0f, 60.0f + float(i % 5), 30.0f}, 1000, i + 1});
    if (a->adaptive) a->forecast = seconds_to(*a, a->target);
    return a;
  }

  bool cached() const {
    return settings.text("components.secondary") == "cache" ||
           settings.text("components.tertiary") == "cache";
  }
  bool waits() const {
    return cached() && !cache_runs && settings.text("cache.pause") != "off" && stages < 6;
  }

  /// A cache of four passes; an inspection finds a record in the middle of the picture.
  irradiance_cache::CacheReport cache() const {
    irradiance_cache::CacheReport c;
    irradiance_cache::CacheStatus& status = c.status;
    c.room = 100000;
    status.pass = 4, status.bytes = 100u << 20, status.references = 7.3;
    for (uint32_t i = 0; i < 5; ++i) {
      irradiance_cache::CachePass p;
      p.number = i, p.complete = true, p.paths = 525000, p.uncovered = p.paths >> (3 * i);
      p.uncovered_world = p.uncovered / 3, p.records = i < 4 ? 2800 >> i : 0, p.rays = 340ull * p.records;
      p.ms = {210, 12, 90, i < 4 ? 1900.0 / (i + 1) : 0, 2, 11};
      status.passes.push_back(p);
      status.records += p.records, status.rays += p.rays, status.probed.uncovered = p.uncovered,
                                                          status.probed.paths = p.paths;
    }
    status.stop = irradiance_cache::StopReason::covered;
    c.placement = irradiance_cache::PlacementShow(settings.choice("overlay.placement"));
    status.last =
        irradiance_cache::StageDone{.stage = irradiance_cache::BuildStage::probe, .pass = 4, .ms = 210};
    if (waits()) {
      status.waits = true, status.stop = irradiance_cache::StopReason::building;
      status.passes.resize(1), status.pass = status.records = 0;
      irradiance_cache::CachePass& pass = status.passes[0];
      pass.complete = false;
      pass.clusters = stages > 0 ? 412 : 0, pass.tried = stages > 0 ? 5210 : 0;
      pass.records = stages > 2 ? pass.records : 0;
      status.last = {.stage = irradiance_cache::BuildStage(stages), .level = 1, .ms = 12.5, .rays = 1000};
      if (c.placement != irradiance_cache::PlacementShow::off)
        c.placement = stages == 0   ? irradiance_cache::PlacementShow::candidates
                      : stages == 1 ? irradiance_cache::PlacementShow::clusters
                                    : irradiance_cache::PlacementShow::chosen;
    }
    c.color = uint32_t(settings.choice("overlay.records_by"));
    c.scale = {0.02f, 4};
    if (samples > 0) {
      irradiance_cache::Overlap o;
      o.pixels = 500000, o.served = 480000, o.mean = 4.2, o.most = 17;
      for (uint32_t i = 0; i < 33; ++i) o.histogram.push_back(i > 17 ? 0 : i == 0 ? 20000 : 90000 / i);
      c.overlap = o;
    }
    c.looked_at = looked_at;
    if (!looked_at) return c;
    irradiance_cache::Inspection& found = c.inspection;
    found.x = uint32_t(looked_at->x * float(width)), found.y = uint32_t(looked_at->y * float(height));
    found.solid = true, found.lookup = shared::k_lookup_possible, found.surface.position = {1, 0, 2},
    found.surface.normal = {0, 1, 0}, found.surface.size = 0.003f;
    // A mirror at the left border, a strongly tilted normal map at the right.
    if (looked_at->x < 0.05f) found.lookup = shared::k_lookup_none;
    if (looked_at->x > 0.95f) found.lookup = shared::k_lookup_too_steep;
    if (found.lookup != shared::k_lookup_possible) return c;
    found.count = 9;
    for (uint32_t i = 0; i < 9; ++i)
      found.serving.push_back({100 + 37 * i, float(9 - i) / 45, {100 + 20 * float(i), 100}, 3});
    irradiance_cache::Record record;
    record.place.position = {1.02f, 0, 1.98f}, record.radius = 0.31f, record.mean_distance = 1.03f;
    record.least_distance = 0.42f, record.error = 0.021f, record.rays = 1280, record.pass = 1;
    record.parts[1].value = {0.62f, 0.41f, 0.22f}, record.parts[2].value = {0.012f, 0.0031f, 0.00004f};
    record.parts[1].translation[1] = {0.3f, 0, -0.8f};
    found.under = {100, record, {}};
    return c;
  }

  void restart() { samples = stages = 0, cache_runs = false, ++run_number; }

  void load(const std::filesystem::path& file, uint64_t number) {
    const std::string name = file.filename().string();
    const int steps = name.find("slow") != std::string::npos ? 60 : 6;
    for (int i = 0; i < steps && number > given_up; ++i) {
      activity = "loading " + name + ": textures " + std::to_string(100 * i / steps) + " %";
      progress = static_cast<float>(i) / static_cast<float>(steps);
      publish();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    activity.clear(), progress = -1;
    if (number <= given_up) {
      log::info("{}: loading was cancelled", file.string());
      throw 0;
    }
    if (name.find("missing") != std::string::npos)
      throw Error(file.string(), "no such file; expected a .gltf or .glb scene");
    {
      auto fresh = std::make_shared<scene::Scene>(fake::make_scene(file));
      camera = scene::starting_camera(*fresh, "");
      std::lock_guard lock(mutex);
      scene = loaded = fresh;
      ++scene_id;
      log::info("{}: 14 materials, 253 112 triangles", file.string());
      log::warning("{}: the extension KHR_materials_sheen is not known and was passed over", file.string());
    }
    restart();
    publish();
  }

  void carry_out(const Command& command, const std::function<void()>& act) {
    try {
      if (command.scene != k_any_scene && command.scene != scene_id) throw 0;
      act();
    } catch (const Error& error) {
      log::error("{}", error.what());
      refused.push_back(command.number);
    } catch (int) {
      refused.push_back(command.number);
    }
  }

  void run() {
    while (!stop) {
      std::optional<Command> command;
      std::function<void()> act;
      {
        std::unique_lock lock(mutex);
        wake.wait_for(lock, std::chrono::milliseconds(30), [&] { return stop || !commands.empty(); });
        if (!commands.empty()) command = commands.pop(), act = runs[command->number];
      }
      if (command) {
        if (const int ms = fake::busy_ms) std::this_thread::sleep_for(std::chrono::milliseconds(ms));
        carry_out(*command, act);
        {
          std::lock_guard lock(mutex);
          done = command->number;
        }
        if (const int ms = fake::drawing_ms) std::this_thread::sleep_for(std::chrono::milliseconds(ms));
        publish();
        continue;
      }
      if (!scene || paused || waits() || width == 0 ||
          samples >= static_cast<uint32_t>(settings.integer("samples")))
        continue;
      ++samples;
      publish();
    }
  }
};

[[gnu::weak]] Session::Session(const Options&) : impl_(std::make_unique<Impl>()) {}
[[gnu::weak]] Session::~Session() = default;
[[gnu::weak]] void Session::load(const std::filesystem::path& file) {
  impl_->post([this, file, number = ++impl_->loads] { impl_->load(file, number); });
}
/// A light mix named "nonsense" is refused.
[[gnu::weak]] void Session::set(const std::string& key, const std::string& value, SceneId scene) {
  impl_->post(
      [this, key, value] {
        if (key == "relight.mix" && value == "nonsense") throw Error(key, "no mix of lights");
        std::lock_guard lock(impl_->mutex);
        impl_->settings.set(key, value);
      },
      scene);
}
[[gnu::weak]] void Session::set_camera(const scene::Camera& camera, SceneId scene) {
  impl_->post([this, camera] { impl_->camera = camera, impl_->restart(), impl_->publish(); }, scene, true);
}
/// Pictures wider than 4096 pixels are refused.
[[gnu::weak]] void Session::set_size(uint32_t width, uint32_t height) {
  impl_->post([this, width, height] {
    if (width > 4096) throw Error("size", "too large");
    impl_->width = width, impl_->height = height, impl_->restart(), impl_->publish();
  });
}
[[gnu::weak]] void Session::set_window_scale(uint32_t scale) {
  (void)scale;
  impl_->post([] {});
}
[[gnu::weak]] void Session::set_light(uint32_t index, const scene::Light& light, SceneId scene) {
  impl_->post_edit([index, light](scene::Scene& s) { s.lights[index] = light; }, scene);
}
[[gnu::weak]] void Session::set_light_list(const std::vector<scene::Light>& lights, SceneId scene) {
  impl_->post_edit([lights](scene::Scene& s) { s.lights = lights; }, scene);
}
[[gnu::weak]] void Session::set_environment_sky(const scene::SkyModel& sky, float scale, SceneId scene) {
  impl_->post_edit(
      [sky, scale](scene::Scene& s) {
        s.environment.sky = sky, s.environment.scale = scale, s.environment.rotation = 0;
        s.environment.file.clear();
      },
      scene);
}
[[gnu::weak]] void Session::set_environment(float scale, float rotation, SceneId scene) {
  impl_->post_edit(
      [scale, rotation](scene::Scene& s) { s.environment.scale = scale, s.environment.rotation = rotation; },
      scene);
}
/// Files named "broken" cannot be read.
[[gnu::weak]] void Session::set_environment_file(const std::filesystem::path& file,
                                                 std::optional<float> scale, std::optional<float> rotation,
                                                 SceneId scene) {
  impl_->post_edit(
      [file, scale, rotation](scene::Scene& s) {
        if (file.string().find("broken") != std::string::npos)
          throw Error(file.string(), "the image cannot be decoded");
        s.environment.sky.reset();
        if (scale) s.environment.scale = *scale;
        if (rotation) s.environment.rotation = *rotation;
        s.environment.file = file.empty() ? fake::make_scene("hall.gltf").environment.file : file.string();
      },
      scene);
}
/// A grey of half of middle brightness, black at the left border; the whole picture needs 2.5 stops more.
[[gnu::weak]] std::shared_future<film::Brightness> Session::measure(std::optional<vec2> at, SceneId scene) {
  auto promise = std::make_shared<std::promise<film::Brightness>>();
  impl_->post(
      [at, promise] {
        film::Brightness found{vec3(0.09f), at ? 1.0f : 2.5f};
        if (at && at->x < 0.05f) found = {};
        promise->set_value(found);
      },
      scene);
  return promise->get_future().share();
}
[[gnu::weak]] std::shared_future<film::FilmImage> Session::layers(SceneId scene) {
  auto promise = std::make_shared<std::promise<film::FilmImage>>();
  impl_->post(
      [this, promise] { promise->set_value(fake::layers(impl_->samples, impl_->width, impl_->height)); },
      scene);
  return promise->get_future().share();
}
[[gnu::weak]] std::shared_future<std::shared_ptr<const recording::Recording>> Session::trace_paths(
    const vec2& at, uint32_t samples, SceneId scene) {
  auto promise = std::make_shared<std::promise<std::shared_ptr<const recording::Recording>>>();
  impl_->post(
      [this, promise, at, samples] {
        promise->set_value(std::make_shared<const recording::Recording>(
            fake::paths(samples, impl_->width, impl_->height, at)));
      },
      scene);
  return promise->get_future().share();
}
[[gnu::weak]] void Session::send_to_tev(const std::optional<std::string>& address) {
  impl_->post([this, address] { impl_->tev = address ? "127.0.0.1:" + *address : "", impl_->publish(); });
}
[[gnu::weak]] void Session::show_paths(const ShownPaths&, SceneId scene) {
  impl_->post([] {}, scene);
}
[[gnu::weak]] std::shared_future<recording::NoiseReport> Session::explain_noise(const vec2&, const vec2&,
                                                                                SceneId scene) {
  auto promise = std::make_shared<std::promise<recording::NoiseReport>>();
  impl_->post([promise] { promise->set_value(fake::noise()); }, scene);
  return promise->get_future().share();
}
/// Every pixel is 0.5; by path tracing, or as the settings name other methods. Half of the light is missing
/// if the cache computes secondary light.
[[gnu::weak]] std::shared_future<std::shared_ptr<const HeldPicture>> Session::held_picture(SceneId scene) {
  auto promise = std::make_shared<std::promise<std::shared_ptr<const HeldPicture>>>();
  impl_->post(
      [this, promise] {
        if (impl_->settings.text("film.layer") == "albedo") {
          promise->set_exception(std::make_exception_ptr(Error("", "the layer 'albedo' shows no light")));
          return;
        }
        HeldPicture held{.width = impl_->width,
                         .height = impl_->height,
                         .light = {},
                         .samples = double(impl_->samples),
                         .seconds = 0.2 * impl_->samples,
                         .error = 0.1,
                         .ledger = impl_->accuracy()->ledger,
                         .scene = impl_->scene->name,
                         .view = scene::view_text(impl_->camera)};
        for (size_t c = 0; c < k_components; ++c)
          held.methods[c] = impl_->settings.text(std::string("components.") + k_component_names[c]);
        held.light.assign(size_t{held.width} * held.height, vec3(impl_->cached() ? 0.25f : 0.5f));
        promise->set_value(std::make_shared<const HeldPicture>(std::move(held)));
      },
      scene);
  return promise->get_future().share();
}
[[gnu::weak]] void Session::set_material(uint32_t index, const scene::Material& material, SceneId scene) {
  impl_->post_edit([index, material](scene::Scene& s) { s.materials[index] = material; }, scene);
}
[[gnu::weak]] void Session::set_lights(const LightsEdit& edit, SceneId scene) {
  impl_->post_edit(
      [this, edit](scene::Scene& s) {
        for (const auto& [i, light] : edit.lights) s.lights[i] = light;
        for (const auto& [i, material] : edit.materials) s.materials[i] = material;
        if (edit.environment_scale) s.environment.scale = *edit.environment_scale;
        std::lock_guard lock(impl_->mutex);
        impl_->settings.set("relight.mix", edit.mix);
      },
      scene, false);
}
[[gnu::weak]] void Session::set_instances(const std::vector<ObjectEdit>& edits, SceneId scene) {
  impl_->post_edit(
      [edits](scene::Scene& s) {
        for (const ObjectEdit& e : edits) {
          scene::Instance& instance = s.instances[e.index];
          instance.to_world = e.to_world, instance.hidden = e.hidden;
        }
      },
      scene);
}
[[gnu::weak]] void Session::set_paused(bool paused) {
  impl_->post([this, paused] { impl_->paused = paused, impl_->publish(); });
}
[[gnu::weak]] void Session::restart() {
  impl_->post([this] { impl_->restart(), impl_->publish(); });
}
[[gnu::weak]] void Session::reload_shaders() {
  impl_->post(
      [] { log::error("surface.comp:42: 'throughputt' : undeclared identifier; the kernels in use stay"); });
}
[[gnu::weak]] void Session::set_reference(const std::filesystem::path& file, SceneId scene) {
  impl_->post(
      [this, file] {
        if (file.string().find("missing") != std::string::npos)
          throw Error(file.string(), "cannot be opened");
        else
          impl_->reference = file.filename().string(), impl_->publish();
      },
      scene);
}
[[gnu::weak]] void Session::clear_reference() {
  impl_->post([this] { impl_->reference.clear(), impl_->publish(); });
}
[[gnu::weak]] void Session::inspect(std::optional<vec2> at, SceneId scene) {
  impl_->post([this, at] { impl_->looked_at = at, impl_->publish(); }, scene);
}
[[gnu::weak]] void Session::measure_effects(SceneId scene) {
  impl_->post(
      [this] {
        EffectCosts costs{.width = impl_->width, .height = impl_->height, .sample_ms = 400};
        costs.effects = {{.key = "tertiary", .label = "Deeper interreflection", .ms = 120, .ms_error = 4},
                         {.key = "primary", .label = "Emitters and direct light", .ms = 80, .ms_error = 4}};
        impl_->effect_costs = std::make_shared<const EffectCosts>(costs);
        impl_->publish();
      },
      scene);
}
[[gnu::weak]] void Session::stop_measuring_effects() {}
[[gnu::weak]] Saved Session::save(const std::filesystem::path& file, bool) {
  auto promise = std::make_shared<std::promise<void>>();
  impl_->post([file, promise] {
    const std::string name = file.filename().string();
    if (name.find("slow") != std::string::npos) std::this_thread::sleep_for(std::chrono::milliseconds(500));
    if (file.string().find("missing") != std::string::npos) {
      const Error error(file.string(), "the folder does not exist");
      log::error("{}", error.what());
      promise->set_exception(std::make_exception_ptr(error));
    } else {
      log::info("saved {}", file.string());
      promise->set_value();
    }
  });
  return promise->get_future().share();
}
[[gnu::weak]] Saved Session::save_reference(const std::filesystem::path& file) { return save(file); }
[[gnu::weak]] Saved Session::solver_save(const std::string&, const std::filesystem::path& file, SceneId) {
  return save(file);
}
[[gnu::weak]] void Session::solver_load(const std::string&, const std::filesystem::path& file,
                                        SceneId scene) {
  impl_->post(
      [this, file] {
        if (file.string().find("missing") != std::string::npos)
          throw Error(file.string(), "cannot be read");
        else
          impl_->restart(), impl_->publish();
      },
      scene);
}
[[gnu::weak]] void Session::solver_command(const std::string& solver, const std::string& command,
                                           SceneId scene) {
  impl_->post(
      [this, solver, command] {
        if (solver != "cache") log::info("{}: command {}", solver, command);
        if (solver + "." + command == "cache.step") ++impl_->stages;
        if (solver + "." + command == "cache.run") impl_->cache_runs = true;
        impl_->paused = false;
      },
      scene);
}
[[gnu::weak]] uint64_t Session::commands() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->commands.given();
}
[[gnu::weak]] uint64_t Session::commands_done() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->done;
}
[[gnu::weak]] void Session::cancel() { impl_->given_up = impl_->loads.load(); }
[[gnu::weak]] std::shared_ptr<const Snapshot> Session::snapshot() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->snapshot;
}
[[gnu::weak]] State Session::state() const {
  std::lock_guard lock(impl_->mutex);
  return {impl_->scene_id, impl_->scene, impl_->loaded, impl_->settings};
}
[[gnu::weak]] void Session::on_publish(std::function<void()> call) {
  std::lock_guard lock(impl_->mutex);
  impl_->call = std::move(call);
}

}  // namespace lucerna::session
