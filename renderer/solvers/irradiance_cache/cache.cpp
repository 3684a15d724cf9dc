#include "solvers/irradiance_cache/cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/timer.h"
#include "gpu/stream.h"
#include "schedule/uniform.h"
#include "solvers/irradiance_cache/placement.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

/// Spacing of the points that are tried in the first pass, in the scene's radius; each pass quarters it, down
/// to a share of the least radius that records may have there. Of what is tried only what is needed is kept,
/// so that this says how finely a pass looks, not how many records it leaves.
constexpr float k_first_spacing = 1.0f / 24, k_spacing_of_least = 0.6f;
/// Passes that ask beyond the lookup too, where the cache reads itself, and how finely they look there: what
/// no record serves there costs time, not accuracy.
constexpr uint32_t k_deep_passes = 3;
constexpr float k_deep_spacing = 1.0f / 64;
/// Noise that they may have, over that of others: a record's ray reads some of them, and a record's rays
/// many.
constexpr float k_deep_noise = 4;
constexpr float k_normal_tolerance = 0.06f;  // 1 - cos of 20 degrees
constexpr float k_behind = 0.05f;
/// Of its radius: where a record makes others superfluous.
constexpr float k_overlap_share = 0.6f;
/// References of the octree that there is memory for, a record.
constexpr uint32_t k_references = 16;

/// Records that go on with a noisy one, on either side.
constexpr size_t k_company = 4;

enum class Stage { probe, measure, evaluate, done };

/// Elevations of a level of that many rays; there are four times as many azimuths.
uint32_t elevations_for(uint32_t rays) { return static_cast<uint32_t>(std::lround(std::sqrt(rays / 4.0))); }

/// As CacheFrame::routes.
std::array<uint32_t, 16> packed(const paths::LookupRoutes& routes) {
  std::array<uint32_t, 16> table;
  table.fill(k_no_routes);
  for (size_t s = 0; s < routes.component.size(); ++s) {
    table[s] = 0;
    for (uint32_t p = 0; p < k_part_count; ++p)
      table[s] |= std::min<uint32_t>(routes.component[s][p], k_component_count) << (4 * p);
  }
  return table;
}

}  // namespace

const char* words(StopReason reason) {
  switch (reason) {
    case StopReason::covered:
      return "few paths still ask for records";
    case StopReason::passes:
      return "as many passes as are allowed";
    case StopReason::records:
      return "the room for records is used up";
    case StopReason::building:
      break;
  }
  return "it goes on";
}

struct Cache::Impl {
  CacheOptions options;
  Records records;
  lookup::Octree octree;
  gpu::Buffer frame, candidates;
  gpu::Kernel radius, overlay;
  gpu::Resources resources;
  Evaluator evaluator;
  std::array<uint32_t, 16> routes, own_routes;  // of the picture's paths, of the records'
  bool recursive = false;
  uint32_t parts = 0;
  CacheStatus status;
  Stage stage = Stage::probe;
  schedule::UniformSchedule picture;
  bool probing = false;  // the schedule of this pass has begun
  std::array<std::pair<float, float>, 3> scales{{{1, 2}, {1, 2}, {1, 2}}};  // rays, distance, error
  std::vector<Place> asked, tried;
  uint32_t evaluated = 0;      // records up to here have light and radius, and are in the octree
  std::vector<uint32_t> list;  // of this level, in the order of the records
  size_t at = 0;               // of which so many are done
  uint32_t level = 0, level_done = 0, rays_before = 0;  // ... and rays of each record, in this level, so far

  Impl(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheOptions& o)
      : options(o),
        records(device, o.most_records),
        octree(device, compiler,
               {.spheres = o.most_records, .references = k_references * o.most_records, .copies = true}),
        evaluator(device, compiler, slots) {
    frame = gpu::Buffer(device, {.name = "cache frame", .bytes = sizeof(CacheFrame)});
    candidates = gpu::Buffer(device, {.name = "cache candidates",
                                      .bytes = uint64_t{slots} * 16 * k_candidate_texels,
                                      .memory = gpu::Memory::host});
    status.bytes = uint64_t{o.most_records} * k_record_bytes + candidates.bytes() + octree.bytes();
  }

  void build_octree(transport::Wavefront& wavefront) {
    const shared::OctreeHeader& h = octree.build(wavefront.stream(), records.spheres(), {.most = evaluated});
    status.references = h.spheres ? double(h.references) / h.spheres : 0;
    wavefront.rebind_lookup();
  }

  /// What all but a few records lie between.
  void set_scales() {
    const std::vector<Records::Figures> figures = records.figures();
    constexpr float Records::Figures::*k_scaled[] = {
        &Records::Figures::rays, &Records::Figures::mean_distance, &Records::Figures::error};
    for (int k = 0; k < 3 && !figures.empty(); ++k) {
      std::vector<float> values;
      for (const Records::Figures& f : figures)
        if (f.*k_scaled[k] > 0 && std::isfinite(f.*k_scaled[k])) values.push_back(f.*k_scaled[k]);
      std::sort(values.begin(), values.end());
      const size_t n = values.size();
      const float lo = n ? values[n / 50] : 1, hi = n ? values[n - 1 - n / 50] : 2;
      scales[k] = {lo, std::max(hi, 1.01f * lo)};
    }
  }

  CachePass& pass() { return status.passes.back(); }
  void took(BuildStep step, double ms) { pass().ms[size_t(step)] += ms; }
  void spent(size_t done, uint32_t rays) {
    pass().rays += uint64_t(done) * rays;
    status.rays += uint64_t(done) * rays;
  }
  void begin_pass() {
    if (!status.passes.empty() && !pass().complete) status.passes.pop_back();
    status.passes.push_back({.number = status.pass});
  }

  /// What paths know of the cache from here on.
  void tell(uint32_t probing, const std::array<uint32_t, 16>& table) {
    CacheFrame f{};
    std::copy(table.begin(), table.end(), f.routes);
    f.record_count = evaluated;
    f.normal_tolerance = k_normal_tolerance;
    f.behind = k_behind;
    f.probing = probing;
    frame.write(&f, sizeof f);
  }
  void tell(uint32_t probing = k_probe_none) { tell(probing, routes); }

  /// The records of this pass that are still too noisy, for four times as many rays. False when there are
  /// none.
  bool next_level() {
    const uint32_t rays = options.rays << 2 * level;
    if (list.empty() || uint64_t{4} * rays > options.most_rays) return false;
    const std::vector<Records::Figures> figures = records.figures();
    const std::vector<float> light = records.luminances();
    double sum = 0;
    for (const float l : light) sum += double(l);
    const float least = 0.1f * float(sum / double(light.size()));
    // Light that few rays find (a caustic) is looked for wherever a record near by has found it: one that has
    // not would else stop, content with its darkness. The list is in Morton order, so that neighbours in it
    // are near.
    std::vector<uint32_t> kept;
    size_t next = 0;  // the first that no noisy one so far has kept or passed
    for (size_t i = 0; i < list.size(); ++i) {
      const uint32_t r = list[i];
      const float enough =
          figures[r].origin == k_origin_recursive ? k_deep_noise * options.noise : options.noise;
      if (figures[r].error <= enough * std::max(light[r], least)) continue;
      next = std::max(next, i > k_company ? i - k_company : 0);
      for (; next < std::min(list.size(), i + k_company + 1); ++next) kept.push_back(list[next]);
    }
    list = std::move(kept);
    ++level;
    return !list.empty();
  }

  /// Radii of the records that are added in this pass, by what is known of them.
  void set_radii(transport::Wavefront& wavefront, const CacheView& view, const Cache& cache) {
    const uint32_t count = records.size() - evaluated;
    if (count == 0) return;
    StageTimer timer(wavefront);
    wavefront.bind_paths(resources);
    cache.bind(resources);
    const RadiusPush push{evaluated, count, options.error, options.least_pixels,
                          options.most_radius * view.scene_radius};
    wavefront.stream().dispatch(radius, resources, push, gpu::groups_for(count, 64), "records");
    wavefront.stream().run();
    took(BuildStep::radius, timer.milliseconds());
  }

  /// The records that are added in this pass, for the next piece of work on them.
  void list_new() {
    list.resize(records.size() - evaluated);
    std::iota(list.begin(), list.end(), evaluated);
    at = 0;
  }

  void collect(uint32_t slots) {
    const auto* texels = static_cast<const vec4*>(candidates.mapped());
    for (uint32_t slot = 0; slot < slots; ++slot) {
      const vec4& place = texels[size_t{slot} * k_candidate_texels];
      if (place.w == 0) continue;
      ++status.asked;
      const vec4& facing = texels[size_t{slot} * k_candidate_texels + 1];
      asked.push_back(
          {vec3(place), vec3(facing), std::bit_cast<uint32_t>(facing.w), static_cast<uint32_t>(place.w) - 1});
    }
  }

  void finish(StopReason reason) {
    stage = Stage::done;
    status.stop = reason;
    asked = {};
    if (!status.passes.empty()) pass().complete = true;
    tell();
  }
};

Cache::Cache(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots,
             const paths::LookupRoutes& routes, const paths::LookupRoutes& own, const CacheOptions& options)
    : impl_(std::make_unique<Impl>(device, compiler, slots, options)) {
  Impl& c = *impl_;
  const uint32_t elevations = elevations_for(options.rays);
  if (options.rays == 0 || elevations * elevations * 4 != options.rays)
    throw_error("cache.rays", "'{}': expected four times a square, such as 256 or 1024", options.rays);
  c.parts = own.parts;
  c.routes = packed(routes), c.own_routes = packed(own);
  c.recursive =
      std::any_of(c.own_routes.begin(), c.own_routes.end(), [](uint32_t r) { return r != k_no_routes; });
  c.radius = gpu::Kernel(device, compiler, "irradiance_cache/radius.comp");
  c.overlay = gpu::Kernel(device, compiler, "irradiance_cache/overlay.comp", defines(own));
  clear();
}

Cache::~Cache() = default;

gpu::Defines Cache::defines(const paths::LookupRoutes& own) {
  return {{"LUCERNA_CACHE", "1"}, {"LUCERNA_CACHE_PARTS", std::to_string(own.parts)}};
}

void Cache::bind(gpu::Resources& resources) const {
  const Impl& c = *impl_;
  c.records.bind(resources, Records::Use::look_up);
  resources.set("CacheBlock", c.frame);
  resources.set("Candidates", c.candidates);
  c.octree.bind(resources);
}

void Cache::clear() {
  Impl& c = *impl_;
  c.records.clear();
  c.asked.clear();
  c.status = {.bytes = c.status.bytes};
  c.stage = Stage::probe;
  c.probing = false;
  c.evaluated = 0;
  c.tell();
}

void Cache::extend() {
  Impl& c = *impl_;
  c.status.pass = 0;
  c.status.stop = StopReason::building;
  // Records that are being evaluated stay so; what was asked for from where the camera was is dropped.
  if (c.stage != Stage::evaluate) {
    c.records.truncate(c.evaluated);
    c.stage = Stage::probe;
    c.probing = false;
    c.asked.clear();
  }
}

void Cache::restore(transport::Wavefront& wavefront, RawRecords raw, const CacheStatus& status,
                    bool complete) {
  Impl& c = *impl_;
  clear();
  for (size_t i = 0; i < raw.lights.size(); ++i)
    if (!(c.parts >> i / k_part_texels % k_part_count & 1)) raw.lights[i] = vec4(0);
  c.records.restore(raw);
  c.evaluated = raw.size();
  c.status.records = c.status.loaded = raw.size();
  c.status.rays = status.rays;
  if (raw.size() > 0) c.build_octree(wavefront);
  c.set_scales();
  c.tell();
  if (!complete) return;
  c.status.pass = status.pass;
  c.status.asked = status.asked, c.status.paths = status.paths;
  c.finish(status.stop);
}

bool Cache::ready() const { return impl_->stage == Stage::done; }
const CacheStatus& Cache::status() const { return impl_->status; }
const Records& Cache::records() const { return impl_->records; }
uint32_t Cache::parts() const { return impl_->parts; }

bool Cache::step(transport::Wavefront& wavefront, const paths::Automaton& automaton, const CacheView& view,
                 const std::function<bool()>& cancel) {
  Impl& c = *impl_;
  if (c.stage == Stage::probe) {
    if (!c.probing) {
      c.picture = {((view.width + 7) / 8) * ((view.height + 7) / 8), 1, wavefront.slots()};
      c.status.asked = c.status.paths = 0;
      c.asked.clear();
      c.begin_pass();
      c.probing = true;
    }
    const schedule::UniformSchedule before = c.picture;
    schedule::WorkItem item = c.picture.next();
    // Each pass looks along paths of its own.
    for (WorkBlock& b : item.blocks) b.first_sample = c.status.pass;
    c.tell(c.recursive && c.status.pass < k_deep_passes ? k_probe_beyond : k_probe_lookups);
    StageTimer timer(wavefront);
    wavefront.stream().fill(c.candidates, 0);
    if (!wavefront.probe(item, cancel)) {
      c.picture = before;
      c.tell();
      return false;
    }
    c.took(BuildStep::probe, timer.milliseconds());
    c.collect(item.slots());
    c.status.paths += item.slots();
    c.pass().asked = c.status.asked, c.pass().paths = c.status.paths;
    c.tell();
    if (!c.picture.done()) return true;
    c.probing = false;
    c.pass().asked_world = uint64_t(std::count_if(
        c.asked.begin(), c.asked.end(), [](const Place& p) { return p.origin != k_origin_screen; }));
    if (double(c.status.asked) <= double(c.options.stop_share) * double(c.status.paths)) {
      c.finish(StopReason::covered);
      return true;
    }
    const Frame& f = view.paths_frame;
    const float pixel = 2 * glm::length(f.camera_up) / float(f.height);  // at 1 m, or everywhere
    const Timer host;
    c.tried = choose_places(
        c.asked,
        {.spacing = view.scene_radius * std::ldexp(k_first_spacing, -2 * static_cast<int>(c.status.pass)),
         .spacing_beyond = view.scene_radius * k_deep_spacing,
         .spacing_of_distance = k_spacing_of_least * c.options.least_pixels * pixel,
         .eye = f.camera_origin,
         .parallel = f.orthographic != 0,
         .normal_tolerance = k_normal_tolerance,
         .seed = c.options.seed + c.status.pass,
         .most = c.records.capacity() - c.records.size()});
    c.records.append(c.tried, c.status.pass);
    c.list_new();
    c.took(BuildStep::choose, host.milliseconds());
    c.stage = Stage::measure;
    return true;
  }
  if (c.stage == Stage::measure) {
    // How far things are around what is tried says how wide its records will be, and so which are needed.
    const size_t batch =
        std::min<size_t>(c.list.size() - c.at, std::max(1u, wavefront.slots() / Evaluator::k_distance_rays));
    const std::span<const uint32_t> list(c.list.data() + c.at, batch);
    wavefront.set_frame(view.records_frame, view.records_enabled);
    StageTimer timer(wavefront);
    const size_t done = c.evaluator.measure(wavefront, c.records, list, c.options.seed, cancel);
    wavefront.set_frame(view.paths_frame, view.paths_enabled);
    c.at += done;
    c.took(BuildStep::measure, timer.milliseconds());
    c.spent(done, Evaluator::k_distance_rays);
    if (done < list.size()) return false;
    if (c.at < c.list.size()) return true;
    c.set_radii(wavefront, view, *this);
    const Timer host;
    const std::vector<float> radii = c.records.radii(c.evaluated);
    std::vector<Place> needed;
    for (const uint32_t i :
         thin_out(c.tried, radii,
                  {.share = k_overlap_share, .normal_tolerance = k_normal_tolerance, .behind = k_behind}))
      needed.push_back(c.tried[i]);
    c.records.truncate(c.evaluated);
    c.pass().records = c.records.append(needed, c.status.pass);
    c.tried.clear();
    c.list_new();
    c.took(BuildStep::choose, host.milliseconds());
    c.level = c.level_done = c.rays_before = 0;
    c.stage = Stage::evaluate;
    return true;
  }
  if (c.stage == Stage::evaluate) {
    // A level of more rays than can be summed at once is done in rounds of as many.
    const uint32_t level_rays = c.options.rays << 2 * c.level;
    uint32_t rays = level_rays;
    while (rays > std::min(Evaluator::k_most_rays, wavefront.slots())) rays /= 4;
    const uint32_t elevations = elevations_for(rays);
    const size_t batch = std::min<size_t>(c.list.size() - c.at, std::max(1u, wavefront.slots() / rays));
    const std::span<const uint32_t> list(c.list.data() + c.at, batch);
    if (!list.empty()) {
      wavefront.set_frame(view.records_frame, view.records_enabled);
      c.tell(k_probe_none, c.own_routes);
      StageTimer timer(wavefront);
      const size_t done = c.evaluator.evaluate(wavefront, automaton, c.records, list,
                                               {.elevations = elevations,
                                                .azimuths = 4 * elevations,
                                                .rays_before = c.rays_before,
                                                .parts = c.parts,
                                                .seed = c.options.seed},
                                               cancel);
      wavefront.set_frame(view.paths_frame, view.paths_enabled);
      c.tell();
      if (done < list.size()) return false;
      c.took(BuildStep::evaluate, timer.milliseconds());
      c.at += done;
      c.spent(done, rays);
      if (c.at < c.list.size()) return true;
      c.rays_before += rays;
      c.level_done += rays;
      c.at = 0;
      if (c.level_done < level_rays) return true;
    }
    c.level_done = 0;
    // Radii come from the first level alone: the nearest thing that any ray met comes nearer with every ray,
    // and records that shrank would leave gaps. A cache that reads itself does so from the second level on:
    // the first, of few rays, then is all that is traced without the records of its own pass.
    const bool more = c.next_level();
    c.records.publish(wavefront.stream());
    if (c.evaluated < c.records.size()) {
      c.set_radii(wavefront, view, *this);
      c.evaluated = c.status.records = c.records.size();
      StageTimer indexing(wavefront);
      c.build_octree(wavefront);
      c.took(BuildStep::octree, indexing.milliseconds());
      c.tell();
    }
    if (more) return true;
    c.set_scales();
    c.pass().complete = true;
    ++c.status.pass;
    c.stage = Stage::probe;
    if (c.records.size() == c.records.capacity())
      c.finish(StopReason::records);
    else if (c.status.pass >= c.options.most_passes)
      c.finish(StopReason::passes);
  }
  return true;
}

std::pair<float, float> Cache::scale(uint32_t color) const {
  return color < k_record_by_rays ? std::pair(1.0f, 2.0f) : impl_->scales[color - k_record_by_rays];
}

void Cache::draw(transport::Wavefront& wavefront, const film::Film& film, const film::Film& coarse,
                 const Overlay& overlay) {
  Impl& c = *impl_;
  if (!overlay.discs && !overlay.overlap) return;
  wavefront.bind_paths(c.resources);
  bind(c.resources);
  film.bind(c.resources);
  coarse.bind_coarse(c.resources);
  OverlayPush push{film.width(),   film.height(), overlay.discs, overlay.overlap, overlay.color, 0, 1,
                   k_overlap_scale};
  const auto [lo, hi] = scale(overlay.color);
  push.lo = lo, push.hi = hi;
  wavefront.stream().dispatch(c.overlay, c.resources, push,
                              gpu::groups_for(uint64_t{film.width()} * film.height(), 64));
  wavefront.stream().run();
  wavefront.stream().take_times();
}

}  // namespace lucerna::irradiance_cache
