#include "solvers/irradiance_cache/solver.h"

#include <utility>

#include "base/hash.h"
#include "base/log.h"
#include "paths/light_paths.h"
#include "solvers/irradiance_cache/info.h"

namespace lucerna::irradiance_cache {
namespace {

using solvers::Picture, solvers::Task, solvers::Cancel;

CacheOptions read_options(const Task& task) {
  const OptionValues& s = task.settings;
  return {.radius = {.metric = Metric(s.choice("cache.metric")),
                     .error = float(s.real("cache.error")),
                     .nearest = float(s.real("cache.nearest")),
                     .least_pixels = float(s.real("cache.min_radius")),
                     .most_radius = float(s.real("cache.max_radius"))},
          .rays = uint32_t(std::stoul(s.text("cache.rays"))),
          .most_rays = uint32_t(std::stoul(s.text("cache.max_rays"))),
          .noise = float(s.real("cache.noise")),
          .thinning = float(s.real("cache.thinning")),
          .gather = s.boolean("cache.gather"),
          .smooth = s.boolean("cache.smooth"),
          .branches = uint32_t(s.integer("cache.branches")),
          .most_records = uint32_t(s.integer("cache.max_records")),
          .most_passes = uint32_t(s.integer("cache.passes")),
          .groups = task.effects.has_compact_groups() ? task.effects.light_groups : 1,
          .stop_share = float(s.real("cache.stop")),
          .seed = uint32_t(s.integer("seed")),
          .screen = {.irradiance_weight = float(s.real("cache.irradiance_weight")),
                     .irradiance_noise = 2 * float(s.real("cache.noise"))}};
}

paths::LookupRoutes picture_routes(const Task& task) {
  return paths::lookup_routes(task.automaton, task.enabled, task.own, task.effects.separate_sky);
}

paths::LookupRoutes routes_of_records(const Task& task) {
  return paths::record_routes(task.automaton, picture_routes(task).parts,
                              (task.own & paths::k_tertiary_bit) != 0,
                              task.effects.specular || task.effects.solid_glass || task.effects.thin_glass);
}

/// True if another solver computes the tertiary light behind a cached secondary component by lookups: it then
/// serves records' rays too.
bool elsewhere(const Task& task) {
  return (task.provided & task.enabled & ~task.own & picture_routes(task).parts & paths::k_tertiary_bit) != 0;
}

/// Parts that paths compute for records' rays; with `elsewhere` another solver provides lookups.
paths::LookupRoutes routes_of_rays(const Task& task) {
  paths::LookupRoutes records = routes_of_records(task);
  if (!elsewhere(task)) return records;
  // Behind ED the components are the parts, so records' rays are paths of a picture of these components.
  paths::LookupRoutes rays = paths::photon_routes(task.automaton, records.parts, paths::k_tertiary_bit);
  rays.parts = records.parts;
  return rays;
}

CacheRoutes all_routes(const Task& task) {
  const paths::LookupRoutes records = routes_of_records(task);
  return {.picture = picture_routes(task),
          .picture_gather = paths::gather_routes(task.automaton, task.enabled, records),
          .records = records,
          .records_gather = paths::gather_routes(task.automaton, records.parts, records),
          .elsewhere = elsewhere(task)};
}

solvers::Routing routing(const Task& task) {
  CacheRoutes routes = all_routes(task);
  return {.lookups = std::move(routes.picture),
          .fallback = task.enabled,
          .gather = std::move(routes.picture_gather),
          .through = routes.elsewhere ? paths::k_tertiary_bit : 0};
}

/// Texels brighter than this times the sky's mean are the sun, if records store sky light.
float sun_threshold(const Task& task) {
  if ((task.own & paths::k_primary_bit) == 0) return 0;
  const uint32_t parts = paths::lookup_routes(task.automaton, task.enabled, task.own, true).parts;
  return (parts >> shared::k_part_direct & 1u) != 0 ? float(task.settings.real("cache.environment_threshold"))
                                                    : 0;
}

std::unique_ptr<solvers::Solver> make(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots,
                                      const Task& task) {
  return std::make_unique<CacheSolver>(device, compiler, slots, task);
}

}  // namespace

const solvers::SolverType& type() {
  static const solvers::SolverType all{.info = irradiance_cache::info(),
                                       .routing = routing,
                                       .make = make,
                                       .least_slots = Cache::k_least_slots,
                                       .sun_threshold = sun_threshold};
  return all;
}

uint64_t light_grouping(const upload::FlatScene& flat) {
  if (!flat.effects.has_compact_groups()) return 0;
  const scene::LightGroups& g = *flat.groups;
  std::vector<uint8_t> of{uint8_t(g.groups.size()), g.sky, g.sun};
  of.insert(of.end(), g.lamps.begin(), g.lamps.end());
  for (const std::vector<uint8_t>& instance : g.surfaces) {
    of.push_back(uint8_t(instance.size()));
    of.insert(of.end(), instance.begin(), instance.end());
  }
  Hash hash;
  hash.add_bytes(of.data(), of.size());
  return std::max<uint64_t>(hash.low(), 1);
}

CacheSolver::CacheSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const Task& task)
    : device_(device),
      compiler_(compiler),
      picture_routes_(picture_routes(task)),
      record_routes_(routes_of_records(task)),
      ray_routes_(routes_of_rays(task)),
      metric_(Metric(task.settings.choice("cache.metric"))),
      gathers_(task.settings.boolean("cache.gather")),
      cache_(device, compiler, slots, all_routes(task), read_options(task)) {}

const solvers::SolverInfo& CacheSolver::info() const { return irradiance_cache::info(); }

gpu::Defines CacheSolver::defines() const { return Cache::defines(record_routes_, metric_, gathers_); }

bool CacheSolver::serves(const Task& task) const {
  return picture_routes(task).component == picture_routes_.component &&
         routes_of_records(task).component == record_routes_.component &&
         routes_of_rays(task).component == ray_routes_.component;
}

CacheView CacheSolver::view(const Picture& picture) const {
  CacheView view;
  view.paths_frame = picture.frame;
  view.paths_enabled = picture.task.enabled;
  // Records' paths begin behind one diffuse event, so components have the numbers of parts.
  view.records_frame = picture.frame_for(
      {.lookups = ray_routes_,
       .fallback = record_routes_.parts,
       .gather = paths::gather_routes(picture.task.automaton, record_routes_.parts, record_routes_)},
      ray_routes_.traced);
  view.records_enabled = record_routes_.parts;
  view.width = picture.width, view.height = picture.height;
  view.scene_radius = picture.flat.core_radius;
  if (picture.flat.core_radius < picture.flat.scene_radius) {
    view.core.grow(picture.flat.core_centre - picture.flat.core_radius);
    view.core.grow(picture.flat.core_centre + picture.flat.core_radius);
  }
  view.dark = !picture.flat.effects.lights;
  return view;
}

void CacheSolver::adopt(transport::Wavefront& wavefront, const solvers::Solver& before) {
  const auto& other = dynamic_cast<const CacheSolver&>(before);
  lacks_ = cache_.adopt(wavefront, other.cache_);
  grouping_ = other.grouping_;
}

void CacheSolver::begin(const Picture& picture, solvers::Invalidation invalidated) {
  invalidated |= std::exchange(lacks_, solvers::k_invalidates_nothing);
  // The edit may have changed the groups of lights.
  const uint64_t before = std::exchange(grouping_, light_grouping(picture.flat));
  if (cache_.records().groups() > 1) invalidated.light |= before != grouping_;
  overlap_.reset();
  cache_.look_from(view(picture));
  if (invalidated.places) {
    cache_.clear();
    return;
  }
  if (!picture.moved.empty()) cache_.drop_near(picture.moved);
  if (invalidated.light) cache_.relight(picture.light_factors, picture.frame.sky_group);
  if (invalidated.coverage) cache_.extend();
}

void CacheSolver::on_settings_changed(const OptionValues& settings, bool interactive) {
  interactive_ = interactive;
  cache_.preview_relighting(interactive);
  if (interactive) cache_.pause(PauseAfter(settings.choice("cache.pause")));
}

bool CacheSolver::prepare(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
  const bool progress = cache_.step(wavefront, picture.task.automaton, view(picture), cancel);
  if (cache_.ready()) {
    warn_of_full_cache();
    cache_.preview_relighting(interactive_);
  }
  return progress;
}

bool CacheSolver::refine(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
  return cache_.step(wavefront, picture.task.automaton, view(picture), cancel);
}

bool CacheSolver::estimate_errors(transport::Wavefront& wavefront, film::Film& film, const Picture& picture,
                                  bool restarted, const Cancel& cancel) {
  return cache_.estimate_errors(wavefront, film, view(picture), restarted, cancel);
}

void CacheSolver::warn_of_full_cache() {
  const bool full = cache_.status().stop == StopReason::records;
  const uint32_t at = full ? cache_.status().records : 0;
  if (full && at != full_at_)
    log::warning(
        "the irradiance cache is full ({} records); pixels without records are path traced: correct but "
        "slower. Raise cache.max_records",
        at);
  full_at_ = at;
}

void CacheSolver::command(const std::string& name) { cache_.go_on(name == "step"); }

}  // namespace lucerna::irradiance_cache
