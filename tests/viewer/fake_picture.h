#pragma once
// What a session without a renderer shows (fake_session.h): its scenes, pictures and reports.
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>

#include "scene/view_text.h"
#include "session/effect_costs.h"
#include "session/session.h"
#include "solvers/irradiance_cache/report.h"

namespace lucerna::session::fake {

/// The report of an additional solver of a test, from the settings and the inspected point.
inline std::function<std::optional<solvers::Report>(const plan::Settings&, std::optional<vec2>)> more;

/// What the picture is made from.
struct Fake {
  State state;
  scene::Camera camera;
  uint32_t width = 0, height = 0, samples = 0;
  uint64_t run = 0;     ///< number of the picture
  uint32_t stages = 0;  ///< of the build of the cache since the last pause; after six it is complete
  bool cache_runs = false, paused = false;
  std::string reference, tev;
  std::optional<vec2> looked_at;
  std::shared_ptr<const EffectCosts> effect_costs;
  std::string activity;
  float progress = -1;

  void restart() { samples = stages = 0, cache_runs = false, ++run; }
  bool has_picture() const { return state.scene && width > 0; }
  uint32_t most_samples() const { return static_cast<uint32_t>(state.settings.integer("samples")); }
  bool cached() const {
    return state.settings.text("components.secondary") == "cache" ||
           state.settings.text("components.tertiary") == "cache";
  }
  bool waits() const {
    return cached() && !cache_runs && state.settings.text("cache.pause") != "off" && stages < 6;
  }
  bool works() const { return has_picture() && !paused && !waits() && samples < most_samples(); }
};

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
  p.uv0 = {{0, 0}, {1, 0}, {1, 1}};
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

/// A gradient with a grid, by the direction of view.
inline std::vector<uint8_t> picture(const Fake& now) {
  std::vector<uint8_t> rgba(size_t{now.width} * now.height * 4);
  const float gain = std::exp2(static_cast<float>(now.state.settings.real("film.ev")));
  const auto width = static_cast<float>(now.width), height = static_cast<float>(now.height);
  for (uint32_t y = 0; y < now.height; ++y)
    for (uint32_t x = 0; x < now.width; ++x) {
      uint8_t* p = &rgba[(size_t{y} * now.width + x) * 4];
      const vec4 towards((static_cast<float>(x) - 0.5f * width) / height,
                         0.5f - static_cast<float>(y) / height, -1, 0);
      const vec3 d = glm::normalize(vec3(now.camera.to_world * towards));
      const float grid = std::abs(std::sin(12 * d.x)) * std::abs(std::sin(12 * d.y));
      for (int c = 0; c < 3; ++c)
        p[c] = static_cast<uint8_t>(
            std::clamp(gain * (40 + 90 * (d[c] * 0.5f + 0.5f) + 60 * grid), 0.0f, 255.0f));
      p[3] = 255;
    }
  return rgba;
}

/// A render whose noise falls as expected; every other one starts at twice the noise. Seconds grow with
/// samples, independent of the machine.
inline std::shared_ptr<const Accuracy> accuracy(const Fake& now) {
  auto a = std::make_shared<Accuracy>();
  a->run = now.run, a->scene_id = now.state.scene_id, a->settings = now.state.settings.all();
  a->adaptive = now.state.settings.text("sampling.mode") == "adaptive";
  a->target = now.state.settings.real("sampling.target_error");
  a->min_samples = 16, a->max_samples = 1024, a->tile = 16, a->across = (now.width + 15) / 16;
  a->pixels = double(now.width) * now.height;
  a->reference = now.reference, a->reference_applies = !now.reference.empty();
  const double shares[] = {1, 0.62, 0.24, 0.13, 0.4};
  for (double n = 2; n <= now.samples; n = std::max(n + 1, 1.25 * n)) {
    stats::Entry e;
    e.samples = n, e.paths = static_cast<uint64_t>(n * a->pixels), e.rays = 7 * e.paths;
    e.has_error = true, e.wall_s = e.render_s = e.device_s = 0.2 * n;
    for (size_t k = 0; k < 5; ++k) e.error[k] = (now.run % 2 ? 0.8 : 1.6) * shares[k] / std::sqrt(n);
    e.of_mean.error = e.error;
    if (!now.reference.empty()) {
      e.truth = e.of_mean.error;
      for (double& x : *e.truth) x *= 1.1;
    }
    a->ledger.add(e);
    a->hardest.push_back(2 * e.error[0]);
  }
  a->paths = now.samples * a->pixels, a->rays = 7 * a->paths;
  const uint32_t rows = (now.height + 15) / 16;
  for (uint32_t i = 0; i < rows * a->across; ++i) {
    TileStatus t;
    t.samples = now.samples, t.pixels = 256;
    t.error =
        static_cast<float>(1.6 / std::sqrt(std::max(1u, now.samples))) * (0.3f + 0.7f * float(i % 13) / 12);
    t.state = double{t.error} <= a->target ? shared::k_tile_done : shared::k_tile_active;
    t.heavy_tailed = i % 17 == 0;
    a->tiles.push_back(t);
  }
  a->stages = {"camera", "trace closest", "surface"};
  for (uint32_t i = 0; i < std::min(now.samples, 40u); ++i)
    a->passes.push_back({{2.0f, 60.0f + float(i % 5), 30.0f}, 1000, i + 1});
  if (a->adaptive) a->forecast = seconds_to(*a, a->target);
  return a;
}

/// A cache of four passes; an inspection finds a record in the middle of the picture.
inline irradiance_cache::CacheReport cache(const Fake& now) {
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
  c.placement = irradiance_cache::PlacementShow(now.state.settings.choice("overlay.placement"));
  status.last =
      irradiance_cache::StageDone{.stage = irradiance_cache::BuildStage::probe, .pass = 4, .ms = 210};
  if (now.waits()) {
    status.waits = true, status.stop = irradiance_cache::StopReason::building;
    status.passes.resize(1), status.pass = status.records = 0;
    irradiance_cache::CachePass& pass = status.passes[0];
    pass.complete = false;
    pass.clusters = now.stages > 0 ? 412 : 0, pass.tried = now.stages > 0 ? 5210 : 0;
    pass.records = now.stages > 2 ? pass.records : 0;
    status.last = {.stage = irradiance_cache::BuildStage(now.stages), .level = 1, .ms = 12.5, .rays = 1000};
    if (c.placement != irradiance_cache::PlacementShow::off)
      c.placement = now.stages == 0   ? irradiance_cache::PlacementShow::candidates
                    : now.stages == 1 ? irradiance_cache::PlacementShow::clusters
                                      : irradiance_cache::PlacementShow::chosen;
  }
  c.color = uint32_t(now.state.settings.choice("overlay.records_by"));
  c.scale = {0.02f, 4};
  if (now.samples > 0) {
    irradiance_cache::Overlap o;
    o.pixels = 500000, o.served = 480000, o.mean = 4.2, o.most = 17;
    for (uint32_t i = 0; i < 33; ++i) o.histogram.push_back(i > 17 ? 0 : i == 0 ? 20000 : 90000 / i);
    c.overlap = o;
  }
  c.looked_at = now.looked_at;
  if (!now.looked_at) return c;
  irradiance_cache::Inspection& found = c.inspection;
  found.x = uint32_t(now.looked_at->x * float(now.width)),
  found.y = uint32_t(now.looked_at->y * float(now.height));
  found.solid = true, found.lookup = shared::k_lookup_possible, found.surface.position = {1, 0, 2},
  found.surface.normal = {0, 1, 0}, found.surface.size = 0.003f;
  // A mirror at the left border, a strongly tilted normal map at the right.
  if (now.looked_at->x < 0.05f) found.lookup = shared::k_lookup_none;
  if (now.looked_at->x > 0.95f) found.lookup = shared::k_lookup_too_steep;
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

/// Every pixel is 0.5; by path tracing, or as the settings name other methods. Half of the light is missing
/// if the cache computes light. Throws Error for a layer without light.
inline HeldPicture held(const Fake& now) {
  if (now.state.settings.text("film.layer") == "albedo") throw Error("", "the layer 'albedo' shows no light");
  HeldPicture held{.width = now.width,
                   .height = now.height,
                   .light = {},
                   .samples = double(now.samples),
                   .seconds = 0.2 * now.samples,
                   .error = 0.1,
                   .ledger = accuracy(now)->ledger,
                   .scene = now.state.scene->name,
                   .view = scene::view_text(now.camera)};
  for (const size_t c : k_components)
    held.methods[c] = now.state.settings.text(std::string("components.") + k_component_names[c]);
  held.light.assign(size_t{held.width} * held.height, vec3(now.cached() ? 0.25f : 0.5f));
  return held;
}

/// Without its number and the numbers of commands.
inline Snapshot snapshot(const Fake& now) {
  Snapshot s;
  s.scene_id = now.state.scene_id, s.camera = now.camera, s.activity = now.activity,
  s.progress = now.progress;
  s.device = "llvmpipe (LLVM 15.0.6, 256 bits)", s.tracer = "host";
  s.max_samples = now.most_samples();
  s.tev = now.tev;
  s.samples = now.samples, s.paused = now.paused, s.finished = now.state.scene && s.samples >= s.max_samples;
  s.resting = s.paused || s.finished;
  s.coarse = s.samples == 0;
  s.seconds = 0.2 * s.samples;
  s.mean_samples = s.samples;
  if (now.has_picture()) {
    const plan::Settings& settings = now.state.settings;
    s.width = now.width, s.height = now.height;
    s.rgba = picture(now);
    s.accuracy = accuracy(now);
    if (settings.text("film.layer") == "error")
      s.legend = {shared::k_layer_error, shared::k_ramp_magma, true, 0.005f, 0.5f};
    s.tiles = settings.boolean("overlay.tiles");
    if (now.cached())
      s.reports.push_back(
          std::make_shared<solvers::Report>(irradiance_cache::make_report(cache(now), settings)));
    if (more)
      if (const auto reported = more(settings, now.looked_at))
        s.reports.push_back(std::make_shared<solvers::Report>(*reported));
  }
  s.effect_costs = now.effect_costs;
  s.mrays_per_second = 3.42, s.rays = 1234567ull * s.samples;
  s.device_mb = 212, s.host_mb = 1480;
  const double shares[] = {0.618, 0.241, 0.126, 0.015}, ms[] = {412, 380, 1210, 96};
  for (const size_t c : k_components)
    s.components[c] = {.solver = now.state.settings.text(std::string("components.") + k_component_names[c]),
                       .reason = "",
                       .mean_luminance = 0.4 * shares[c],
                       .share = shares[c],
                       .ms_per_sample = ms[c]};
  const char* names[] = {"camera",    "trace closest", "surface", "direct light",
                         "trace any", "scatter",       "film",    "tone map"};
  const double cost[] = {12, 840, 310, 260, 520, 190, 44, 6};
  for (size_t i = 0; i < 8; ++i) s.stages.push_back({names[i], cost[i] * s.samples, i == 1 || i == 4});
  return s;
}

}  // namespace lucerna::session::fake
