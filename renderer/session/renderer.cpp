#include "session/renderer.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "base/log.h"
#include "base/timer.h"
#include "bvh/embree/build.h"
#include "film/overlay.h"
#include "plan/plan.h"
#include "scene/default_light.h"
#include "scene/io/load.h"
#include "session/accuracy.h"
#include "shaders/shared/film.h"
#include "solvers/irradiance_cache/placement_view.h"
#include "stats/forecast.h"
#include "transport/frame.h"

namespace lucerna::session {
namespace {

void require(bool go_on) {
  if (!go_on) throw Error("", "cancelled");
}

}  // namespace

Renderer::Renderer(const RendererOptions& options)
    : options_(options),
      device_(options.on
                  ? options.on
                  : std::make_shared<gpu::Device>(gpu::DeviceOptions{options.device, options.validation})),
      compiler_(std::make_unique<gpu::ShaderCompiler>(
          options.shaders.empty() ? gpu::ShaderCompiler::default_root() : options.shaders)),
      automaton_(paths::compile_components()) {}

Renderer::~Renderer() = default;

void Renderer::load(const std::filesystem::path& file, const Progress& progress) {
  rest();
  const Timer timer;
  auto scene = std::make_shared<scene::Scene>(scene::load(
      file, options_.scenes,
      [&](float fraction, const std::string& what) { return !progress || progress(0.6f * fraction, what); }));
  scene::add_default_light(*scene);
  for (std::string& line : plan::unreachable_light(plan::make_plan(settings_), *scene))
    scene->warnings.push_back(std::move(line));
  for (const std::string& warning : scene->warnings) log::warning("{}", warning);
  set_scene(scene, [&](float fraction, const std::string& what) {
    return !progress || progress(0.6f + 0.4f * fraction, what);
  });
  load_seconds_ = timer.seconds() - compile_seconds_;
}

void Renderer::set_scene(std::shared_ptr<const scene::Scene> scene, const Progress& progress) {
  // A scene starts with the defaults and its own settings; only how to compute is the machine's affair and
  // stays.
  plan::Settings settings;
  for (const char* key : {"tracer", "path.batch"}) settings.set(key, settings_.text(key));
  for (const auto& [key, value] : scene->settings) settings.set(key, value, "settings.json");
  scene::Camera camera = scene::starting_camera(*scene, settings.text("camera"));
  install(std::move(scene), std::move(settings), camera, progress);
}

void Renderer::install(std::shared_ptr<const scene::Scene> scene, plan::Settings settings,
                       scene::Camera camera, const Progress& progress, solvers::Spoils spoilt) {
  rest();
  const auto report = [&](float fraction, const char* what) {
    require(!progress || progress(fraction, what));
  };
  // Everything that can fail happens before the old scene is given up.
  report(0, "flattening the scene");
  upload::FlatScene flat = upload::flatten(*scene, wanted_sun_threshold(settings));
  report(0.2f, "building the BVH");
  const bvh::Triangles triangles{flat.positions, flat.non_opaque};
  const std::string& tracer = settings.text("tracer");
  const bool use_host = tracer == "host" || (tracer == "auto" && device_->info().is_cpu);
  std::unique_ptr<bvh::HostTracer> host;
  bvh::BvhData tree;
  if (use_host) {
    host = std::make_unique<bvh::HostTracer>(triangles);
  } else {
    bvh::BuildOptions options;
    options.progress = [&](float f) { return !progress || progress(0.2f + 0.6f * f, "building the BVH"); };
    tree = bvh::build(triangles, options);
  }
  report(0.8f, "uploading the scene");
  auto device_scene = std::make_unique<upload::DeviceScene>(*device_, flat, tree);
  report(0.9f, "compiling kernels");
  std::swap(host_, host);
  std::swap(settings_, settings);
  try {
    spoilt |= build_wavefront(*device_scene, !spoilt.places);
  } catch (...) {
    std::swap(host_, host);
    std::swap(settings_, settings);
    throw;
  }
  scene_ = std::move(scene);
  flat_ = std::move(flat);
  device_scene_ = std::move(device_scene);
  camera_ = std::move(camera);
  make_film(spoilt);
}

solvers::Spoils Renderer::build_wavefront(const upload::DeviceScene& device_scene, bool keep) {
  const Timer timer;
  transport::HostTrace trace;
  if (host_) {
    trace = [host = host_.get()](bvh::Query query, std::span<const shared::Ray> rays,
                                 std::span<shared::Hit> hits, const uint32_t* queue, uint32_t count,
                                 bool coherent) { host->trace(query, rays, hits, queue, count, coherent); };
  }
  uint32_t slots = uint32_t(settings_.integer("path.batch")) / 64 * 64;
  gpu::Defines defines = options_.defines;
  if (settings_.boolean("sampling.coherent"))
    defines["LUCERNA_COHERENT"] = settings_.text("sampling.tile") == "8" ? "3" : "4";
  paths::LookupRoutes routes = wanted_routes(device_scene.effects());
  paths::LookupRoutes record_routes;
  std::unique_ptr<irradiance_cache::Cache> cache;
  std::function<void(gpu::Resources&)> bind;
  if (routes.parts != 0) {
    slots = std::max(slots, irradiance_cache::Cache::k_least_slots);
    record_routes = wanted_record_routes(device_scene.effects());
    cache = std::make_unique<irradiance_cache::Cache>(
        *device_, *compiler_, slots,
        irradiance_cache::CacheRoutes{
            .picture = routes,
            .picture_gather = paths::gather_routes(automaton_, enabled_components(), record_routes),
            .records = record_routes,
            .records_gather = paths::gather_routes(automaton_, record_routes.parts, record_routes)},
        cache_options());
    for (const auto& [name, value] : irradiance_cache::Cache::defines(record_routes, cache_options().metric))
      defines[name] = value;
    bind = [c = cache.get()](gpu::Resources& r) { c->bind(r); };
  }
  auto developer = std::make_unique<film::Developer>(*device_, *compiler_);
  auto estimator = std::make_unique<film::ErrorEstimator>(*device_, *compiler_, cache != nullptr);
  wavefront_ = std::make_unique<transport::Wavefront>(*device_, *compiler_, device_scene, slots,
                                                      std::move(trace), defines, bind);
  developer_ = std::move(developer), estimator_ = std::move(estimator);
  solvers::Spoils spoilt = solvers::k_spoils_all;
  if (keep && cache && cache_) spoilt = cache->adopt(*wavefront_, *cache_);
  cache_ = std::move(cache);
  inspector_.reset();
  compiled_ = device_scene.defines();
  placement_view_.reset();
  heed_pauses();
  routes_ = std::move(routes);
  record_routes_ = std::move(record_routes);
  compile_seconds_ = timer.seconds();
  return spoilt;
}

void Renderer::reload_shaders() {
  if (!device_scene_) return;
  build_wavefront(*device_scene_, false);
  restart(spoiled(scene::Change::shaders));
}

uint32_t Renderer::enabled_components() const { return plan::make_plan(settings_).enabled(); }

shared::Frame Renderer::make_frame(uint32_t width, uint32_t height, const paths::LookupRoutes& routes,
                                   uint32_t fallback, const paths::LookupRoutes& gather) const {
  return transport::make_frame(flat_, camera_, automaton_,
                               {.width = width,
                                .height = height,
                                .seed = uint32_t(settings_.integer("seed")),
                                .max_depth = uint32_t(settings_.integer("path.max_depth")),
                                .roulette_depth = uint32_t(settings_.integer("path.roulette_depth")),
                                .enabled = routes.traced,
                                .routes = routes,
                                .fallback = fallback,
                                .gather = gather});
}

shared::Frame Renderer::make_frame(uint32_t width, uint32_t height) const {
  return make_frame(width, height, routes_, cache_ ? enabled_components() : 0,
                    paths::gather_routes(automaton_, enabled_components(), record_routes_));
}

irradiance_cache::CacheOptions Renderer::cache_options() const {
  return {.metric = irradiance_cache::Metric(settings_.choice("cache.metric")),
          .error = float(settings_.real("cache.error")),
          .nearest = float(settings_.real("cache.nearest")),
          .least_pixels = float(settings_.real("cache.min_radius")),
          .most_radius = float(settings_.real("cache.max_radius")),
          .rays = uint32_t(std::stoul(settings_.text("cache.rays"))),
          .most_rays = uint32_t(std::stoul(settings_.text("cache.max_rays"))),
          .noise = float(settings_.real("cache.noise")),
          .thinning = float(settings_.real("cache.thinning")),
          .gather = settings_.boolean("cache.gather"),
          .neighbours = settings_.boolean("cache.neighbours"),
          .most_records = uint32_t(settings_.integer("cache.max_records")),
          .most_passes = uint32_t(settings_.integer("cache.passes")),
          .stop_share = float(settings_.real("cache.stop")),
          .seed = uint32_t(settings_.integer("seed")),
          .screen = {.density = float(settings_.real("cache.candidates")),
                     .falloff = float(settings_.real("cache.candidates_falloff")),
                     .depth_weight = float(settings_.real("cache.depth_weight")),
                     .normal_weight = float(settings_.real("cache.normal_weight")),
                     .irradiance_weight = float(settings_.real("cache.irradiance_weight")),
                     .irradiance_noise = 2 * float(settings_.real("cache.noise"))}};
}

irradiance_cache::CacheView Renderer::cache_view() const {
  irradiance_cache::CacheView view;
  view.paths_frame = make_frame(width_, height_);
  view.paths_enabled = enabled_components();
  // The records' paths begin behind one diffuse event: components are then the numbers of the parts.
  view.records_frame = make_frame(width_, height_, record_routes_, record_routes_.parts,
                                  paths::gather_routes(automaton_, record_routes_.parts, record_routes_));
  view.records_enabled = record_routes_.parts;
  view.width = width_, view.height = height_;
  view.scene_radius = flat_.scene_radius;
  view.dark = !flat_.effects.lights;
  return view;
}

paths::LookupRoutes Renderer::wanted_routes(const upload::Effects& effects) const {
  const plan::Plan plan = plan::make_plan(settings_);
  return paths::lookup_routes(automaton_, plan.enabled(), plan.looked_up(), effects.sky_apart);
}

float Renderer::wanted_sun_threshold(const plan::Settings& settings) const {
  if (!settings.boolean("cache.environment")) return 0;
  const plan::Plan plan = plan::make_plan(settings);
  const uint32_t parts = paths::lookup_routes(automaton_, plan.enabled(), plan.looked_up(), true).parts;
  return (parts >> shared::k_part_direct & 1u) != 0 ? float(settings.real("cache.environment_threshold")) : 0;
}

paths::LookupRoutes Renderer::wanted_record_routes(const upload::Effects& effects) const {
  constexpr uint32_t k_tertiary = 1u << 2;
  return paths::record_routes(automaton_, wanted_routes(effects).parts,
                              (plan::make_plan(settings_).looked_up() & k_tertiary) != 0,
                              effects.specular || effects.solid_glass || effects.thin_glass);
}

void Renderer::make_film(solvers::Spoils spoilt) {
  film_ = std::make_unique<film::Film>(*device_, width_, height_);
  coarse_ = std::make_unique<film::Film>(*device_, std::max(1u, width_ / shared::k_coarse_step),
                                         std::max(1u, height_ / shared::k_coarse_step));
  restart(spoilt);
}

void Renderer::restart(solvers::Spoils spoilt) {
  if (!wavefront_ || !film_) return;
  if (cache_) cache_->look_from(cache_view());
  if (cache_ && spoilt.places) {
    cache_->clear();
  } else if (cache_) {
    if (spoilt.light) cache_->relight();
    if (spoilt.coverage) cache_->extend();
  }
  // What is switched off changes without new kernels.
  routes_.traced = wanted_routes(flat_.effects).traced;
  film_->clear(wavefront_->stream());
  coarse_->clear(wavefront_->stream());
  wavefront_->reset_stats();
  start_schedule();
  ++restarts_;
  ledger_.clear();
  clock_.reset();
  render_s_ = prepared_s_ = 0;
  prepared_ = {};
  wavefront_->set_frame(make_frame(width_, height_), enabled_components());
  applied_ = settings_.all();
}

void Renderer::start_schedule() {
  schedule_ = {film_->blocks(), uint32_t(settings_.integer("samples")), wavefront_->slots()};
  adaptive_.reset();
  if (settings_.text("sampling.mode") != "adaptive") return;
  adaptive_.emplace(film_->blocks_across(), film_->blocks_down(), adaptive_options());
}

void Renderer::change_schedule() {
  const std::vector<uint32_t> have = adaptive_ ? adaptive_->counts() : schedule_.counts();
  if (settings_.text("sampling.mode") == "adaptive") {
    std::vector<schedule::TileErrors> errors;
    image_error();
    for (const film::TileError& t : film::tile_errors(*film_, tile_side()))
      errors.push_back({float(t.relative), float(t.relative_records), float(t.relative_interpolation)});
    adaptive_.emplace(film_->blocks_across(), film_->blocks_down(), adaptive_options(), have, errors);
  } else {
    schedule_ = {have, uint32_t(settings_.integer("samples")), wavefront_->slots()};
    adaptive_.reset();
  }
}

schedule::AdaptiveOptions Renderer::adaptive_options() const {
  return {
      .tile = tile_side(),
      .target_error = float(settings_.real("sampling.target_error")),
      .min_samples = uint32_t(settings_.integer("sampling.min_samples")),
      .max_samples = uint32_t(settings_.integer("sampling.max_samples")),
      .slots = wavefront_->slots(),
  };
}

/// What the floor of the display (film/error.h) is before exposure.
float Renderer::luminance_floor() const {
  return film::k_luminance_floor * float(std::exp2(-settings_.real("film.ev")));
}

uint32_t Renderer::tile_side() const { return uint32_t(std::stoul(settings_.text("sampling.tile"))); }

film::ImageError Renderer::image_error() {
  estimator_->estimate(wavefront_->stream(), *film_, luminance_floor());
  wavefront_->account_stages();
  return film::image_error(film_->errors());
}

std::optional<double> Renderer::bias(size_t component) const {
  // Light that is looked up for a component besides its solver's, straight from the sky.
  for (const auto& by_part : routes_.component)
    if (by_part[shared::k_part_direct] == component) return std::nullopt;
  return plan::make_plan(settings_).bias(component);
}

std::vector<film::TileError> Renderer::tile_errors() const {
  const uint32_t side = tile_side();
  std::vector<film::TileError> tiles = film::tile_errors(*film_, side);
  film::mark_heavy_tails(tiles, (film_->width() + side - 1) / side, luminance_floor());
  return tiles;
}

std::string Renderer::view_text() const {
  std::string text = camera_.orthographic
                         ? fmt::format("orthographic {:.5g} {:.5g}", camera_.xmag, camera_.ymag)
                         : fmt::format("perspective {:.5g}", camera_.yfov);
  text += fmt::format(" aspect {:.5g} at", camera_.aspect);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) text += fmt::format(" {:.5g}", camera_.to_world[column][row] + 0.0f);
  return text;
}

void Renderer::set_reference(const std::filesystem::path& file) {
  if (!wavefront_) throw Error(file.string(), "a reference is of a scene; load the scene first");
  film::Reference reference = film::read_reference(file, width_, height_);
  if (!reference.scene.empty() && reference.scene != scene_->name)
    throw_error(file.string(), "the reference is of the scene '{}', not of '{}'", reference.scene,
                scene_->name);
  if (!reference.view.empty() && reference.view != view_text())
    throw_error(file.string(), "the reference was taken with another camera ({}; now {})", reference.view,
                view_text());
  if (!reference.noise)
    log::warning("{}: it does not tell its own noise, which is therefore taken for error", file.string());
  if (reference.seed == settings_.text("seed"))
    log::warning(
        "{}: rendered with seed {} like this picture, so that they share samples and the difference is too "
        "small; another seed tells the truth",
        file.string(), reference.seed);
  reference_ = std::move(reference);
}

bool Renderer::reference_applies() const {
  return reference_ && wavefront_ && reference_->width == width_ && reference_->height == height_ &&
         (reference_->scene.empty() || reference_->scene == scene_->name) &&
         (reference_->view.empty() || reference_->view == view_text());
}

void Renderer::apply_settings() {
  if (!wavefront_) return;
  std::set<std::string> changed;  // before anything is done, for a restart counts all as applied
  for (const auto& [key, value] : settings_.all())
    if (applied_[key] != value) changed.insert(key);
  bool again = false, retarget = false;
  for (const std::string& key : changed) {
    // What these say, the schedule in progress can take up.
    const bool goal = key == "sampling.target_error" || key == "sampling.min_samples" ||
                      key == "sampling.max_samples" ||
                      (key == "sampling.tile" && (!adaptive_ || changed.contains("sampling.mode")));
    if (goal)
      retarget = true;
    else if (key != "samples")
      again |= plan::find_option(key)->restarts;
  }
  const bool rebuild = changed.contains("tracer") || changed.contains("path.batch");
  bool cache_changed = false;
  solvers::Spoils spoilt;
  for (const std::string& key : changed) {
    cache_changed |= cache_ && key.starts_with("cache.") && plan::find_option(key)->restarts;
    spoilt |= solvers::spoiled_by_setting(irradiance_cache::info(), key);
  }
  heed_pauses();
  if (changed.contains("camera")) choose_camera(settings_.text("camera"));
  if (rebuild) {
    install(scene_, settings_, camera_, {}, spoilt);
    return;
  }
  if (const float threshold = wanted_sun_threshold(settings_); threshold != flat_.sun_threshold) {
    flat_.sun_threshold = threshold;
    upload::flatten_lights(*scene_, flat_);
    device_scene_->update_lights(*device_, flat_);
    wavefront_->rebind(*device_scene_);
  }
  const bool kernels = wanted_routes(flat_.effects).component != routes_.component ||
                       wanted_record_routes(flat_.effects).component != record_routes_.component ||
                       cache_changed || changed.contains("sampling.coherent") ||
                       (changed.contains("sampling.tile") && settings_.boolean("sampling.coherent"));
  if (kernels) spoilt |= build_wavefront(*device_scene_, !spoilt.places);
  again |= kernels;
  if (changed.contains("samples") && !again) schedule_.set_samples(uint32_t(settings_.integer("samples")));
  if (changed.contains("sampling.mode") && !again)
    change_schedule();
  else if (retarget && !again && adaptive_)
    adaptive_->retarget(adaptive_options());
  if (again) restart(spoilt);
  applied_ = settings_.all();
}

void Renderer::set_size(uint32_t width, uint32_t height) {
  if (width == width_ && height == height_ && film_) return;
  film::check_size(device_->info(), width, height);
  const uint32_t old_width = width_, old_height = height_;
  width_ = width;
  height_ = height;
  if (!wavefront_) return;
  const solvers::Spoils spoilt = spoiled(scene::Change::size);
  try {
    make_film(spoilt);
  } catch (...) {
    width_ = old_width, height_ = old_height;
    make_film(spoilt);
    throw;
  }
}

void Renderer::set_camera(const scene::Camera& camera) {
  camera_ = camera;
  restart(spoiled(scene::Change::camera));
}

void Renderer::choose_camera(const std::string& name) {
  camera_ = scene::find_camera(*scene_, name);
  restart(spoiled(scene::Change::camera));
}

bool Renderer::step(const std::function<bool()>& cancel) {
  if (!wavefront_ || done()) return false;
  clock_.go();
  const Timer timer;
  const bool prepares = cache_ && !cache_->ready();
  const bool progress = render_item(cancel);
  render_s_ += timer.seconds();
  if (prepares && cache_->ready()) warn_of_full_cache();
  if (prepares)
    prepared_s_ = clock_.seconds(), prepared_ = stats();
  else if (progress)
    note_progress(false);
  if (done()) rest();
  return progress;
}

std::array<double, shared::k_component_count> Renderer::component_ms_a_sample() const {
  std::array<double, shared::k_component_count> each{};
  const double samples = double(stats().paths) / (double(film_->width()) * film_->height());
  for (size_t c = 0; samples > 0 && c < each.size(); ++c)
    each[c] = (stats().component_ms[c] - prepared_.component_ms[c]) / samples;
  return each;
}

void Renderer::note_progress(bool at_once) {
  const transport::TransportStats& s = wavefront_->stats();
  if (s.paths == 0 || !(at_once || ledger_.due(s.paths, uint64_t{width_} * height_))) return;
  stats::Entry entry;
  entry.wall_s = clock_.seconds();
  entry.render_s = render_s_;
  entry.prepared_s = prepared_s_;
  entry.prepared_rays = prepared_.rays;
  for (const auto& stage : s.stages) entry.device_s += 1e-3 * stage.ms;
  entry.paths = s.paths;
  entry.rays = s.rays;
  entry.samples = double(s.paths) / (double(film_->width()) * film_->height());
  entry.component_s[0] = entry.device_s;
  for (int c = 0; c < paths::k_component_count; ++c) entry.component_s[c + 1] = 1e-3 * s.component_ms[c];
  entry.told = samples() >= 2;
  if (entry.told) {
    const film::ImageError error = image_error();
    for (int k = 0; k < stats::k_layers; ++k) entry.error[k] = error.relative(k);
    entry.records = error.relative_records(), entry.interpolation = error.relative_interpolation();
    entry.degrees = error.degrees;
    const film::TileSpread tiles = film::tile_spread(film::tile_errors(*film_, tile_side()));
    entry.tile_median = tiles.median, entry.tile_worst_tenth = tiles.worst_tenth;
  }
  if (reference_applies()) {
    const film::Image image = film_->read();
    entry.truth = film::true_errors(*reference_, image.components, image.samples);
  }
  if (adaptive_) {
    std::vector<stats::TileProgress> tiles;
    for (uint32_t t = 0; t < adaptive_->tiles().size(); ++t) {
      const schedule::Tile& tile = adaptive_->tiles()[t];
      tiles.push_back(
          {.error = tile.error,
           .goal = tile.goal(adaptive_->options().target_error),
           .samples = double(tile.samples),
           .pixels = 64.0 * double(adaptive_->blocks_of(t).size()),
           .open = tile.state == schedule::TileState::waiting || tile.state == schedule::TileState::active,
           .earlier_error = tile.earlier.error,
           .earlier_samples = double(tile.earlier.samples)});
    }
    const schedule::AdaptiveOptions& o = adaptive_->options();
    const std::optional<stats::Band> paths =
        stats::total_paths(tiles, adaptive_->tiles_across(), o.target_error, o.min_samples, o.max_samples);
    const double before = double(prepared_.rays), each = (double(s.rays) - before) / double(s.paths);
    if (paths)
      entry.total_rays =
          stats::Band{before + each * paths->low, before + each * paths->middle, before + each * paths->high};
  }
  ledger_.add(entry);
}

bool Renderer::render_item(const std::function<bool()>& cancel) {
  if (cache_ && !cache_->ready()) return cache_->step(*wavefront_, automaton_, cache_view(), cancel);
  // As soon as every pixel has a sample, so that the picture does not wait, and before errors are told.
  if (cache_ && samples() > 0 && !film_->records_told()) {
    const bool anew = std::exchange(told_restart_, restarts_) != restarts_;
    return cache_->tell_picture(*wavefront_, *film_, cache_view(), anew, cancel);
  }
  if (adaptive_) {
    const schedule::WorkItem item = adaptive_->next();
    if (!wavefront_->run(item, *film_, cancel)) {
      adaptive_->give_back();
      return false;
    }
    const std::vector<uint32_t>& tiles = adaptive_->to_report();
    std::vector<schedule::TileErrors> errors(tiles.size());
    // One sample a pixel tells nothing of the error, and decides nothing.
    if (!tiles.empty() && adaptive_->tiles()[tiles[0]].samples + item.sample_count > 1) {
      estimator_->estimate_stopping(wavefront_->stream(), item.blocks, *film_, luminance_floor());
      wavefront_->account_stages();
      for (size_t i = 0; i < tiles.size(); ++i) {
        const film::RelativeError e = film::relative_error(*film_, adaptive_->blocks_of(tiles[i]));
        errors[i] = {float(e.paths), float(e.records), float(e.interpolation)};
      }
    }
    adaptive_->report(errors);
    return true;
  }
  const schedule::UniformSchedule before = schedule_;
  const schedule::WorkItem item = schedule_.next();
  if (wavefront_->run(item, *film_, cancel)) return true;
  schedule_ = before;
  return false;
}

void Renderer::render_coarse(const std::function<bool()>& cancel) {
  if (!wavefront_) return;
  clock_.go();
  coarse_->clear(wavefront_->stream());
  wavefront_->set_frame(make_frame(coarse_->width(), coarse_->height()), enabled_components());
  schedule::UniformSchedule schedule(coarse_->blocks(), 1, wavefront_->slots());
  wavefront_->uncounted([&] {
    while (!schedule.done() && wavefront_->run(schedule.next(), *coarse_, cancel)) {
    }
  });
  wavefront_->set_frame(make_frame(width_, height_), enabled_components());
}

film::View Renderer::view() const {
  film::View v;
  v.layer = uint32_t(settings_.choice("film.layer"));
  v.show = 0;
  for (int c = 0; c < paths::k_component_count; ++c)
    if (settings_.boolean(std::string("show.") + paths::k_component_names[c])) v.show |= 1u << c;
  v.curve = uint32_t(settings_.choice("film.tone_curve"));
  v.exposure = float(std::exp2(settings_.real("film.ev")));
  v.scale = 2 * flat_.scene_radius;
  v.heat = heat_scale(v.layer);
  if (settings_.boolean("overlay.tiles")) v.tiles = tile_side();
  return v;
}

film::HeatScale Renderer::heat_scale(uint32_t layer) const {
  if (layer == shared::k_layer_samples)
    return film::sample_scale(adaptive_ ? adaptive_->options().min_samples : 0, max_samples());
  if (layer == shared::k_layer_error) return film::error_scale(settings_.real("sampling.target_error"));
  double ms = 0;
  for (const auto& stage : stats().stages) ms += stage.ms;
  for (const auto& stage : prepared_.stages) ms -= stage.ms;
  const auto seen = [](const transport::TransportStats& s) { return double(s.rays - s.shadow_rays); };
  return film::cost_scale(ms, seen(stats()) - seen(prepared_), double(film_->width()) * film_->height(),
                          adaptive_.has_value());
}

std::vector<uint8_t> Renderer::picture(bool with_coarse) {
  const film::View v = view();
  if (v.tiles > 0) {
    std::vector<shared::TileMark> marks;
    for (const TileStatus& t : tile_status(*this, true))
      marks.push_back({film::tile_position(double{t.sum()}, settings_.real("sampling.target_error")),
                       t.state | (t.heavy_tailed ? shared::k_tile_heavy : 0)});
    film_->mark_tiles(marks);
  }
  developer_->tone_map(wavefront_->stream(), *film_, v, with_coarse ? coarse_.get() : nullptr);
  if (cache_) draw_cache();
  return film_->read_picture();
}

film::FilmImage Renderer::film_image() {
  const film::Image image = film_->read();
  film::FilmImage out;
  out.width = image.width;
  out.height = image.height;
  const size_t n = image.samples.size();
  const auto add = [&](const std::string& prefix, const char* names, const std::vector<vec3>& plane) {
    for (int k = 0; k < 3; ++k) {
      std::vector<float> channel(n);
      for (size_t i = 0; i < n; ++i) channel[i] = plane[i][k];
      out.channels.emplace_back(prefix + names[k], std::move(channel));
    }
  };
  std::vector<vec3> sum(n, vec3(0));
  for (const auto& component : image.components)
    for (size_t i = 0; i < n; ++i) sum[i] += component[i];
  add("", "RGB", sum);
  for (int c = 0; c < film::k_components; ++c)
    add(std::string(paths::k_component_names[c]) + ".", "RGB", image.components[c]);
  add("albedo.", "RGB", image.albedo);
  add("N.", "XYZ", image.normal);
  out.channels.emplace_back("Z", image.depth);
  out.channels.emplace_back("samples", std::vector<float>(image.samples.begin(), image.samples.end()));
  out.metadata["version"] = LUCERNA_VERSION;
  out.metadata["settings"] = settings_.changed_json();
  out.metadata["seed"] = settings_.text("seed");
  out.metadata["device"] = device_->info().name;
  out.metadata["tracer"] = tracer_name();
  out.metadata["scene"] = scene_->name;
  out.metadata["view"] = view_text();
  out.metadata["noise"] = film::noise_text(image_error().rms);
  return out;
}

void Renderer::save(const std::filesystem::path& file) {
  if (!wavefront_) throw Error(file.string(), "nothing to save yet; load a scene first");
  const std::string extension = file.extension().string();
  if (extension == ".exr")
    film::write_exr(file, film_image());
  else if (extension == ".png") {
    // Where somebody looks is no part of what is kept.
    const std::optional<vec2> at = std::exchange(looked_at_, std::nullopt);
    const std::vector<uint8_t> shown = picture(false);
    looked_at_ = at;
    film::write_png(file, film_->width(), film_->height(), shown);
  } else
    throw_error(file.string(), "cannot write '{}' files; use .exr or .png", extension);
}

double peak_host_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

}  // namespace lucerna::session
