#include "solvers/irradiance_cache/cache.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "gpu/stream.h"
#include "solvers/irradiance_cache/build.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

/// References of the octree that there is memory for, a record.
constexpr uint32_t k_references = 16;

/// Records that a leaf of it lists before it is split.
constexpr uint32_t k_crowd = 16;

/// Of a record's radius: how far off its plane it serves at most. Off the plane between its own and the
/// point's it is `off_plane`; half of what the normals differ by turns that away from its own.
float slab_thickness(float off_plane, float normal_tolerance) {
  return off_plane + 0.5f * std::sqrt(2 * normal_tolerance);
}

/// As CacheFrame::routes.
RouteTable packed(const paths::LookupRoutes& routes, const paths::LookupRoutes& gather) {
  RouteTable table;
  table.fill(k_no_routes);
  for (const auto& [from, of] : {std::pair{0u, &routes}, std::pair{k_gather_state, &gather}})
    for (size_t s = 0; s < of->component.size(); ++s) {
      table[from + s] = 0;
      for (uint32_t p = 0; p < k_part_count; ++p)
        table[from + s] |= std::min<uint32_t>(of->component[s][p], k_component_count) << (4 * p);
    }
  return table;
}

void drop_crowded(RawRecords& raw) {
  std::vector<uint32_t> kept;
  for (uint32_t r = 0; r < raw.size(); ++r)
    if (!raw.crowded(r)) kept.push_back(r);
  raw.keep(kept);
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
    case StopReason::dark:
      return "there is no light in the scene";
    case StopReason::building:
      break;
  }
  return "it goes on";
}

Cache::Impl::Impl(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots,
                  const paths::LookupRoutes& own, const CacheOptions& o)
    : options(o),
      records(device, o.most_records),
      octree(device, compiler,
             {.spheres = o.most_records,
              .references = k_references * o.most_records,
              .copies = true,
              .discs = true,
              .crowd = k_crowd}),
      evaluator(device, compiler, slots),
      screen(device, compiler, defines(own, o.metric)),
      placement(device, compiler),
      clamping(device, compiler, o.most_records, defines(own, o.metric)),
      reads(device, compiler, o.most_records, defines(own, o.metric)),
      picture_error(device, compiler, defines(own, o.metric)) {
  if (o.neighbours) neighbours.emplace(device, compiler, defines(own, o.metric));
  frame = gpu::Buffer(device, {.name = "cache frame", .bytes = sizeof(CacheFrame)});
  candidates = gpu::Buffer(device, {.name = "cache candidates",
                                    .bytes = uint64_t{slots} * 16 * k_candidate_texels,
                                    .memory = gpu::Memory::host,
                                    .texel = true});
  own_bytes =
      uint64_t{o.most_records} * k_record_bytes + candidates.bytes() + clamping.bytes() + octree.bytes();
  count_bytes();
}

void Cache::Impl::count_bytes() {
  status.bytes = own_bytes + screen.bytes() + placement.bytes() + reads.bytes() +
                 (neighbours ? neighbours->bytes() : uint64_t{0});
}

void Cache::Impl::build_octree(transport::Wavefront& wavefront, uint32_t count) {
  const lookup::Discs discs =
      records.discs(slab_thickness(std::max(k_off_plane, k_off_plane_least), k_normal_tolerance));
  const shared::OctreeHeader& h =
      octree.build(wavefront.stream(), records.spheres(), {.most = count}, &discs);
  status.references = h.spheres ? double(h.references) / h.spheres : 0;
  wavefront.rebind_lookup();
}

void Cache::Impl::set_scales() {
  const std::vector<Records::Figures> figures = records.figures();
  constexpr float Records::Figures::*k_scaled[] = {&Records::Figures::rays, &Records::Figures::mean_distance,
                                                   &Records::Figures::error};
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

void Cache::Impl::tell(uint32_t probing, const RouteTable& table) {
  CacheFrame f{};
  std::copy(table.begin(), table.end(), f.routes);
  f.record_count = evaluated;
  f.normal_tolerance = k_normal_tolerance;
  f.off_plane = k_off_plane, f.off_plane_least = k_off_plane_least;
  f.least_of_distance = least.of_distance, f.least_most = least.most;
  f.eye = least.eye, f.parallel = least.parallel;
  f.probing = probing;
  frame.write(&f, sizeof f);
}

Cache::Cache(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheRoutes& routes,
             const CacheOptions& options)
    : impl_(std::make_unique<Impl>(device, compiler, slots, routes.records, options)) {
  Impl& c = *impl_;
  if (slots < k_least_slots)
    throw_error("irradiance cache", "room for {} paths in flight; {} are needed", slots, k_least_slots);
  const uint32_t elevations = elevations_for(options.rays);
  if (options.rays == 0 || elevations * elevations * 4 != options.rays)
    throw_error("cache.rays", "'{}': expected four times a square, such as 256 or 1024", options.rays);
  const paths::LookupRoutes& own = routes.records;
  c.parts = own.parts;
  const paths::LookupRoutes none;
  c.routes = packed(routes.picture, options.gather ? routes.picture_gather : none);
  c.own_routes = packed(own, options.gather ? routes.records_gather : none);
  c.recursive =
      std::any_of(c.own_routes.begin(), c.own_routes.end(), [](uint32_t r) { return r != k_no_routes; });
  c.radius = gpu::Kernel(device, compiler, "irradiance_cache/radius.comp");
  c.overlay = gpu::Kernel(device, compiler, "irradiance_cache/overlay.comp", defines(own, options.metric));
  if (c.by_light()) {
    c.ellipse = gpu::Kernel(device, compiler, "irradiance_cache/ellipse.comp");
    c.pooling = gpu::Kernel(device, compiler, "irradiance_cache/pool.comp", defines(own, options.metric));
    c.pool_keep = gpu::Kernel(device, compiler, "irradiance_cache/pool_keep.comp");
    c.pooled = gpu::Buffer(
        device,
        {.name = "pooled pilots", .bytes = uint64_t{options.most_records} * sizeof(vec4), .texel = true});
    c.own_bytes += c.pooled.bytes();
    c.count_bytes();
  }
  clear();
}

Cache::~Cache() = default;

gpu::Defines Cache::defines(const paths::LookupRoutes& own, Metric metric) {
  return {{"LUCERNA_CACHE_PARTS", std::to_string(own.parts)},
          {"LUCERNA_CACHE_ELLIPSES", metric == Metric::hessian ? "1" : "0"}};
}

void Cache::Impl::bind(gpu::Resources& to) const {
  records.bind(to, Records::Use::look_up);
  to.set("CacheBlock", frame);
  to.set("Candidates", candidates);
  octree.bind(to);
}

void Cache::bind(gpu::Resources& resources) const { impl_->bind(resources); }

void Cache::clear() {
  Impl& c = *impl_;
  c.records.clear();
  c.forget_placement();
  c.pauses.dropped();
  c.look_elsewhere();
  c.status = {.bytes = c.status.bytes, .published = c.status.published};
  c.stage = Stage::probe;
  c.probing = false;
  c.asks_beyond = true;
  c.filling = false;
  c.looked_along = 0;
  c.evaluated = c.standing = c.until = 0;
  c.ends.clear();
  c.hold();
  c.stopped = StopReason::building;
  c.moved = false;
  c.tell();
}

void Cache::Impl::drop_pass() {
  records.truncate(standing);
  list_until(standing);
  stage = Stage::probe;
  probing = false;
  forget_placement();
}

void Cache::extend() {
  Impl& c = *impl_;
  c.moved = true;
  c.count_anew(true);
  c.look_elsewhere();
  // Records that are being evaluated stay so; what was asked for from where the camera was is dropped, unless
  // somebody is looking at it, maybe from all sides.
  if (c.stage != Stage::evaluate && c.stage != Stage::index && !c.status.waits) {
    c.drop_pass();
    if (c.status.relighting > 0) c.relight_pass();  // they have been waiting in the dark
  }
}

void Cache::restore(transport::Wavefront& wavefront, RawRecords raw, const CacheStatus& status,
                    bool complete) {
  Impl& c = *impl_;
  clear();
  if (!c.options.gather) drop_crowded(raw);
  for (size_t i = 0; i < raw.lights.size(); ++i)
    if (!raw.crowded(uint32_t(i / (k_part_texels * k_part_count))) &&
        !(c.parts >> i / k_part_texels % k_part_count & 1))
      raw.lights[i] = vec4(0);
  c.take(raw);
  c.status.loaded = raw.size();
  c.moved = true;  // for all that is known
  c.status.rays = status.rays;
  if (raw.size() > 0) c.build_octree(wavefront);
  c.set_scales();
  c.tell();
  if (!complete) return;
  c.status.pass = status.pass;
  c.status.asked = status.asked, c.status.paths = status.paths;
  c.finish(status.stop);
}

void Cache::Impl::look_from(const CacheView& view) {
  const Frame& f = view.paths_frame;
  const LeastRadius now{.eye = f.camera_origin,
                        .parallel = f.orthographic != 0,
                        .of_distance = options.least_pixels * 2 * glm::length(f.camera_up) / float(f.height),
                        .most = options.most_radius * view.scene_radius};
  if (now == least) return;
  least = now;
  tell();
}

void Cache::look_from(const CacheView& view) { impl_->look_from(view); }

bool Cache::ready() const { return impl_->stage == Stage::done; }

void Cache::pause(PauseAfter after) {
  impl_->pauses.set(after);
  impl_->status.waits = impl_->pauses.waits();
}

void Cache::go_on(bool one_stage) {
  if (ready()) return;
  if (one_stage)
    impl_->pauses.step();
  else
    impl_->pauses.run();
  impl_->status.waits = false;
}

PlacementShown Cache::placement() const {
  Impl& c = *impl_;
  if (c.shown_version != c.placement_version)
    c.shown = c.placement.choice(), c.shown_version = c.placement_version;
  return {c.shown.candidates, c.shown.cluster, c.tried, c.tried_radii, c.kept, c.placement_version};
}

const CacheStatus& Cache::status() const { return impl_->status; }
const Records& Cache::records() const { return impl_->records; }
const std::vector<float>& Cache::worth() const { return impl_->worth; }
uint32_t Cache::parts() const { return impl_->parts; }
bool Cache::recursive() const { return impl_->recursive; }

bool Cache::step(transport::Wavefront& wavefront, const paths::Automaton& automaton, const CacheView& view,
                 const std::function<bool()>& cancel) {
  if (impl_->status.waits) return false;
  const Impl::Work work{wavefront, automaton, view, cancel};
  impl_->look_from(view);
  if (view.dark) impl_->finish(StopReason::dark);
  switch (impl_->stage) {
    case Stage::probe:
      return impl_->probe(work);
    case Stage::choose:
      return impl_->choose(work);
    case Stage::measure:
      return impl_->measure(work);
    case Stage::thin:
      return impl_->thin();
    case Stage::evaluate:
      return impl_->evaluate(work);
    case Stage::index:
      return impl_->index(work);
    case Stage::done:
      break;
  }
  return true;
}

void Cache::look_at_picture(transport::Wavefront& wavefront, const CacheView& view) {
  Impl& c = *impl_;
  if (ready()) c.see_all(wavefront, view);
}

bool Cache::tell_picture(transport::Wavefront& wavefront, film::Film& film, const CacheView& view, bool anew,
                         const std::function<bool()>& cancel) {
  Impl& c = *impl_;
  // Beyond the picture's lookups paths read where the rays of records do; and what those have read has read
  // what its own rays met, however many diffuse events further on.
  RouteTable table = c.routes;
  const auto own_end = c.own_routes.begin() + k_gather_state;
  const auto own = std::find_if(c.own_routes.begin(), own_end, [](uint32_t r) { return r != k_no_routes; });
  if (own != own_end) std::fill_n(table.begin() + k_fallback_state + 1, k_gather_state - 1, *own);
  if (anew) c.picture_error.begin();
  const bool complete = c.picture_error.step(
      {wavefront, film, view.paths_frame, view.paths_enabled, c.evaluated, c.recursive, c.candidates,
       [&](gpu::Resources& r) { bind(r); }, [&](uint32_t probing) { c.tell(probing, table); }, cancel});
  c.tell();
  return complete;
}

SightGrid Cache::bind_sight(gpu::Resources& to) const {
  const Impl& c = *impl_;
  const SightGrid grid = c.screen.sight().grid();
  // Kernels name it whether they read it or not.
  to.set("surface_texels", grid.across > 0 ? c.screen.sight().surfaces() : c.candidates);
  return grid;
}

void Cache::draw_discontinuity(transport::Wavefront& wavefront, const film::Film& film, const CacheView& view,
                               Discontinuity::Of of, uint32_t level) {
  Impl& c = *impl_;
  c.see_all(wavefront, view);
  gpu::Stream& stream = wavefront.stream();
  c.screen.look_up(stream, [&](gpu::Resources& r) { bind(r); });
  DiscontinuityOptions options = c.options.screen;
  if (options.irradiance_weight <= 0) options.irradiance_weight = DiscontinuityOptions{}.irradiance_weight;
  c.screen.measure(stream, of, options, c.dark(c.records.luminances(), c.evaluated));
  c.screen.draw(stream, film.picture(), level);
  stream.run();
  stream.take_times();
}

std::pair<float, float> Cache::scale(uint32_t color) const {
  return color < k_record_by_rays ? std::pair(1.0f, 2.0f) : impl_->scales[color - k_record_by_rays];
}

void Cache::draw(const overlay::Canvas& canvas, const Overlay& overlay) {
  Impl& c = *impl_;
  if (!overlay.discs && !overlay.overlap) return;
  canvas.bind(c.resources);
  bind(c.resources);
  const auto [lo, hi] = scale(overlay.color);
  const SightGrid sight = bind_sight(c.resources);
  const OverlayPush push{canvas.width(), canvas.height(), overlay.discs, overlay.overlap, overlay.color, lo,
                         hi, k_overlap_scale,
                         // Discs are drawn where the film's surfaces are.
                         overlay.overlap ? sight : overlay::k_no_sight};
  canvas.stream().dispatch(c.overlay, c.resources, push, gpu::groups_for(canvas.pixels(), 64));
  canvas.finish();
}

}  // namespace lucerna::irradiance_cache
