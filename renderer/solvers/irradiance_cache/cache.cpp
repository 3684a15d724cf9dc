#include "solvers/irradiance_cache/cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "gpu/stream.h"
#include "schedule/uniform.h"
#include "solvers/irradiance_cache/placement.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

/// Spacing of the first pass, in the scene's radius; each pass halves it down to the least.
constexpr float k_first_spacing = 1.0f / 16, k_least_spacing = 1.0f / 512;
constexpr float k_normal_tolerance = 0.015f;  // 1 - cos of 10 degrees
constexpr float k_behind = 0.05f;
/// References of the octree that there is memory for, a record.
constexpr uint32_t k_references = 16;

/// Records that go on with a noisy one, on either side.
constexpr size_t k_company = 4;

enum class Stage { probe, evaluate, done };

/// Elevations of a level of that many rays; there are four times as many azimuths.
uint32_t elevations_for(uint32_t rays) { return static_cast<uint32_t>(std::lround(std::sqrt(rays / 4.0))); }

}  // namespace

struct Cache::Impl {
  CacheOptions options;
  Records records;
  lookup::Octree octree;
  gpu::Buffer frame, candidates;
  gpu::Kernel radius, overlay;
  gpu::Resources resources;
  Evaluator evaluator;
  CacheFrame told{};
  uint32_t parts = 0;
  CacheStatus status;
  Stage stage = Stage::probe;
  schedule::UniformSchedule picture;
  bool probing = false;  // the schedule of this pass has begun
  std::array<std::pair<float, float>, 3> scales{{{1, 2}, {1, 2}, {1, 2}}};  // rays, distance, error
  std::vector<Place> asked;
  uint32_t evaluated = 0;      // records up to here are complete
  std::vector<uint32_t> list;  // of this level, in the order of the records
  size_t at = 0;               // of which so many are done
  uint32_t level = 0, rays_before = 0;

  Impl(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheOptions& o)
      : options(o),
        records(device, o.most_records),
        octree(device, compiler, {.spheres = o.most_records, .references = k_references * o.most_records}),
        evaluator(device, compiler, slots) {
    frame = gpu::Buffer(device, {.name = "cache frame", .bytes = sizeof(CacheFrame)});
    candidates = gpu::Buffer(device, {.name = "cache candidates",
                                      .bytes = uint64_t{slots} * 16 * k_candidate_texels,
                                      .memory = gpu::Memory::host});
    status.bytes = uint64_t{o.most_records} * k_record_bytes + candidates.bytes() + octree.bytes();
  }

  void build_octree(transport::Wavefront& wavefront) {
    const shared::OctreeHeader& h = octree.build(wavefront.stream(), records.spheres(), {.most = evaluated});
    // What all but a few records lie between.
    const std::vector<vec3> figures = records.figures();
    for (int k = 0; k < 3 && !figures.empty(); ++k) {
      std::vector<float> values;
      for (const vec3& f : figures)
        if (f[k] > 0 && std::isfinite(f[k])) values.push_back(f[k]);
      std::sort(values.begin(), values.end());
      const size_t n = values.size();
      const float lo = n ? values[n / 50] : 1, hi = n ? values[n - 1 - n / 50] : 2;
      scales[k] = {lo, std::max(hi, 1.01f * lo)};
    }
    status.references = h.spheres ? double(h.references) / h.spheres : 0;
    wavefront.rebind_lookup();
  }

  /// What paths know of the cache from here on.
  void tell(uint32_t count, bool probes, bool looks = true) {
    CacheFrame f = told;
    f.record_count = count;
    f.probing = probes ? 1 : 0;
    if (!looks) std::fill(std::begin(f.routes), std::end(f.routes), k_no_routes);
    frame.write(&f, sizeof f);
  }

  /// The records of this pass that are still too noisy, for four times as many rays. False when there are
  /// none.
  bool next_level(uint32_t slots) {
    const uint32_t rays = options.rays << 2 * level;
    if (list.empty() || uint64_t{4} * rays > std::min(options.most_rays, slots)) return false;
    const std::vector<vec3> figures = records.figures();
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
      if (figures[r].z <= options.noise * std::max(light[r], least)) continue;
      next = std::max(next, i > k_company ? i - k_company : 0);
      for (; next < std::min(list.size(), i + k_company + 1); ++next) kept.push_back(list[next]);
    }
    list = std::move(kept);
    rays_before += rays;
    ++level;
    at = 0;
    return !list.empty();
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
    tell(records.size(), false);
  }
};

Cache::Cache(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots,
             const paths::LookupRoutes& routes, const CacheOptions& options)
    : impl_(std::make_unique<Impl>(device, compiler, slots, options)) {
  Impl& c = *impl_;
  const uint32_t elevations = elevations_for(options.rays);
  if (options.rays == 0 || elevations * elevations * 4 != options.rays)
    throw_error("cache.rays", "'{}': expected four times a square, such as 256 or 1024", options.rays);
  c.parts = routes.parts;
  c.radius = gpu::Kernel(device, compiler, "irradiance_cache/radius.comp");
  c.overlay = gpu::Kernel(device, compiler, "irradiance_cache/overlay.comp", defines(routes));
  c.told.normal_tolerance = k_normal_tolerance;
  c.told.behind = k_behind;
  for (uint32_t s = 0; s < 16; ++s) {
    c.told.routes[s] = k_no_routes;
    if (s >= routes.component.size()) continue;
    c.told.routes[s] = 0;
    for (uint32_t p = 0; p < k_part_count; ++p)
      c.told.routes[s] |= std::min<uint32_t>(routes.component[s][p], k_component_count) << (4 * p);
  }
  clear();
}

Cache::~Cache() = default;

gpu::Defines Cache::defines(const paths::LookupRoutes& routes) {
  return {{"LUCERNA_CACHE", "1"}, {"LUCERNA_CACHE_PARTS", std::to_string(routes.parts)}};
}

void Cache::bind(gpu::Resources& resources) const {
  const Impl& c = *impl_;
  c.records.bind(resources);
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
  c.tell(0, false);
}

void Cache::extend() {
  Impl& c = *impl_;
  c.status.pass = 0;
  c.status.stop = StopReason::building;
  // Records that are being evaluated stay so; what was asked for from where the camera was is dropped.
  if (c.stage != Stage::evaluate) {
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
  c.tell(c.evaluated, false);
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
      c.probing = true;
    }
    const schedule::UniformSchedule before = c.picture;
    schedule::WorkItem item = c.picture.next();
    // Each pass looks along paths of its own.
    for (WorkBlock& b : item.blocks) b.first_sample = c.status.pass;
    c.tell(c.evaluated, true);
    wavefront.stream().fill(c.candidates, 0);
    if (!wavefront.probe(item, cancel)) {
      c.picture = before;
      c.tell(c.evaluated, false);
      return false;
    }
    c.collect(item.slots());
    c.status.paths += item.slots();
    c.tell(c.evaluated, false);
    if (!c.picture.done()) return true;
    c.probing = false;
    if (double(c.status.asked) <= double(c.options.stop_share) * double(c.status.paths)) {
      c.finish(StopReason::covered);
      return true;
    }
    const float spacing =
        view.scene_radius *
        std::max(k_least_spacing, std::ldexp(k_first_spacing, -static_cast<int>(c.status.pass)));
    const std::vector<Place> chosen =
        choose_places(c.asked, {.spacing = spacing,
                                .normal_tolerance = k_normal_tolerance,
                                .seed = c.options.seed + c.status.pass,
                                .most = c.records.capacity() - c.records.size()});
    c.records.append(chosen, c.status.pass);
    c.list.resize(c.records.size() - c.evaluated);
    std::iota(c.list.begin(), c.list.end(), c.evaluated);
    c.level = c.rays_before = 0;
    c.at = 0;
    c.stage = Stage::evaluate;
    return true;
  }
  if (c.stage == Stage::evaluate) {
    const uint32_t rays = c.options.rays << 2 * c.level;
    const uint32_t elevations = elevations_for(rays);
    const size_t batch = std::min<size_t>(c.list.size() - c.at, std::max(1u, wavefront.slots() / rays));
    const std::span<const uint32_t> list(c.list.data() + c.at, batch);
    if (!list.empty()) {
      wavefront.set_frame(view.records_frame, view.records_enabled);
      c.tell(0, false, false);
      const size_t done = c.evaluator.evaluate(wavefront, automaton, c.records, list,
                                               {.elevations = elevations,
                                                .azimuths = 4 * elevations,
                                                .rays_before = c.rays_before,
                                                .parts = c.parts,
                                                .seed = c.options.seed},
                                               cancel);
      wavefront.set_frame(view.paths_frame, view.paths_enabled);
      c.tell(c.evaluated, false);
      if (done < list.size()) return false;
      c.at += done;
      c.status.rays += uint64_t(done) * rays;
      if (c.at < c.list.size()) return true;
    }
    if (c.next_level(wavefront.slots())) return true;
    if (c.evaluated < c.records.size()) {
      wavefront.bind_paths(c.resources);
      bind(c.resources);
      const uint32_t count = c.records.size() - c.evaluated;
      const RadiusPush push{c.evaluated, count, c.options.error, c.options.least_pixels,
                            c.options.most_radius * view.scene_radius};
      wavefront.stream().dispatch(c.radius, c.resources, push, gpu::groups_for(count, 64), "records");
      wavefront.stream().run();
    }
    c.evaluated = c.records.size();
    c.status.records = c.evaluated;
    ++c.status.pass;
    c.build_octree(wavefront);
    c.tell(c.evaluated, false);
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

void Cache::draw(transport::Wavefront& wavefront, const film::Film& film, const Overlay& overlay) {
  Impl& c = *impl_;
  if (!overlay.discs && !overlay.overlap) return;
  wavefront.bind_paths(c.resources);
  bind(c.resources);
  film.bind(c.resources);
  OverlayPush push{film.width(), film.height(), overlay.discs, overlay.overlap, overlay.color, 0, 1, 12};
  const auto [lo, hi] = scale(overlay.color);
  push.lo = lo, push.hi = hi;
  wavefront.stream().dispatch(c.overlay, c.resources, push,
                              gpu::groups_for(uint64_t{film.width()} * film.height(), 64));
  wavefront.stream().run();
  wavefront.stream().take_times();
}

}  // namespace lucerna::irradiance_cache
