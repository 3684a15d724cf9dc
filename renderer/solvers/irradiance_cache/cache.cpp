#include "solvers/irradiance_cache/cache.h"

#include <algorithm>

#include "base/error.h"
#include "gpu/stream.h"
#include "solvers/irradiance_cache/build.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

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
      return "few paths still find no record";
    case StopReason::passes:
      return "the maximum number of passes is reached";
    case StopReason::records:
      return "the maximum number of records is reached";
    case StopReason::dark:
      return "the scene has no light";
    case StopReason::finished_early:
      return "it was ended early";
    case StopReason::building:
      break;
  }
  return "it continues";
}

Cache::Cache(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheRoutes& routes,
             const CacheOptions& options)
    : impl_(std::make_unique<Impl>(device, compiler, slots, routes, options)) {
  if (slots < k_least_slots)
    throw_error("irradiance cache", "{} paths in flight; at least {} are needed", slots, k_least_slots);
  const uint32_t elevations = elevations_for(options.rays);
  if (options.rays == 0 || elevations * elevations * 4 != options.rays)
    throw_error("cache.rays", "'{}': expected four times a square, such as 256 or 1024", options.rays);
  clear();
}

Cache::~Cache() = default;

gpu::Defines Cache::defines(const paths::LookupRoutes& own, Metric metric, bool gathers) {
  return {{"LUCERNA_CACHE_PARTS", std::to_string(own.parts)},
          {"LUCERNA_CACHE_ELLIPSES", metric == Metric::hessian ? "1" : "0"},
          {"LUCERNA_CACHE_GATHERS", gathers ? "1" : "0"}};
}

void Cache::bind(gpu::Resources& resources) const {
  impl_->tables.bind(resources);
  if (impl_->preview.looked_up()) impl_->preview.bind(resources);
}

void Cache::clear() { impl_->clear(); }

void Cache::extend() {
  Impl& c = *impl_;
  c.forget_refining();
  c.progress.probing.camera_moved = true;
  c.restart_passes(true);
  c.picture.forget();
  // Records in evaluation stay. Candidates for the old camera are dropped, unless building is paused for
  // inspection.
  if (c.progress.stage != Stage::evaluate && c.progress.stage != Stage::index && !c.status.waits) {
    c.drop_pass();
    if (c.status.relighting.records > 0) c.relight_pass();  // their relighting has waited without light
  }
}

void Cache::finish_early() {
  Impl& c = *impl_;
  if (ready() || c.status.relighting.records > 0 || c.end_with_first_level()) return;
  c.drop_pass();
  if (!c.ranges.complete_pass() && !c.status.passes.empty() && !c.status.passes.back().complete)
    c.status.passes.pop_back();
  c.finish(StopReason::finished_early);
}

void Cache::restore(transport::Wavefront& wavefront, RawRecords raw, const CacheStatus& status,
                    bool complete) {
  Impl& c = *impl_;
  clear();
  if (!c.options.gather) drop_crowded(raw);
  for (size_t i = 0; i < raw.lights.size(); ++i)
    if (!raw.crowded(uint32_t(i / (k_part_texels * k_part_count))) &&
        !(c.gathers.parts >> i / k_part_texels % k_part_count & 1))
      raw.lights[i] = vec4(0);
  c.replace_records(raw);
  c.status.loaded = raw.size();
  c.progress.probing.camera_moved = true;  // all present records are for the old camera
  c.status.rays = status.rays;
  if (raw.size() > 0) c.build_octree(wavefront, c.ranges.evaluated(), IndexFor::picture);
  c.overlay.set_scales(c.tables.records.figures());
  c.write_frame();
  if (!complete) return;
  c.status.pass = status.pass;
  c.status.probed.uncovered = status.probed.uncovered, c.status.probed.paths = status.probed.paths;
  c.finish(status.stop);
}

void Cache::look_from(const CacheView& view) { impl_->look_from(view); }

bool Cache::ready() const { return impl_->progress.stage == Stage::done || refines(); }

bool Cache::usable() const {
  // Where interreflection has the noise, a tenth of its paths has more of it than the records that are there.
  constexpr double k_most_missing = 0.1;
  return ready() || impl_->missing() <= k_most_missing;
}

void Cache::refine(double factor) { impl_->begin_refining(factor); }

bool Cache::refines() const { return impl_->progress.refining.under_way; }

void Cache::pause(PauseAfter after) {
  impl_->progress.pauses.set(after);
  impl_->status.waits = impl_->progress.pauses.waits();
}

bool Cache::stepped() const { return impl_->progress.pauses.after() != PauseAfter::off; }

void Cache::go_on(bool one_stage) {
  if (ready()) return;
  if (one_stage)
    impl_->progress.pauses.step();
  else
    impl_->progress.pauses.run();
  impl_->status.waits = false;
}

PlacementShown Cache::placement() const { return impl_->places.shown(); }

const CacheStatus& Cache::status() const { return impl_->status; }
const Records& Cache::records() const { return impl_->tables.records; }
const std::vector<float>& Cache::importance() const { return impl_->picture.importance; }
uint32_t Cache::parts() const { return impl_->gathers.parts; }
bool Cache::recursive() const { return impl_->gathers.recursive; }
bool Cache::elsewhere() const { return impl_->gathers.elsewhere; }

bool Cache::step(transport::Wavefront& wavefront, const paths::Automaton& automaton, const CacheView& view,
                 const std::function<bool()>& cancel) {
  if (impl_->status.waits) return false;
  const Impl::Work work{wavefront, automaton, view, cancel};
  impl_->look_from(view);
  if (view.dark) impl_->finish(StopReason::dark);
  const bool complete = impl_->work_on_stage(work);
  if (impl_->progress.stage == Stage::done) impl_->index_for_picture(wavefront);
  return complete;
}

bool Cache::look_at_picture(transport::Wavefront& wavefront, const CacheView& view,
                            const std::function<bool()>& cancel) {
  return !ready() || impl_->see_all(wavefront, view, cancel);
}

bool Cache::estimate_errors(transport::Wavefront& wavefront, film::Film& film, const CacheView& view,
                            bool restarted, const std::function<bool()>& cancel) {
  Impl& c = *impl_;
  const RouteTable routes = c.tables.routes_beyond_picture();
  if (restarted) c.picture.error.begin();
  const bool complete = c.picture.error.step(
      {wavefront, film, view.paths_frame, view.paths_enabled, c.ranges.evaluated(), c.gathers.recursive,
       c.tables.candidates, c.binding(), [&](uint32_t probing) { c.write_frame(probing, routes); }, cancel});
  c.write_frame();
  return complete;
}

SightGrid Cache::bind_sight(gpu::Resources& to) const {
  const Impl& c = *impl_;
  const SightGrid grid = c.picture.screen.sight().grid();
  // Kernels declare it whether or not they read it.
  to.set("surface_texels", grid.across > 0 ? c.picture.screen.sight().surfaces() : c.tables.candidates);
  return grid;
}

void Cache::draw_discontinuity(const overlay::Canvas& canvas, const CacheView& view, Discontinuity::Of of,
                               uint32_t level) {
  Impl& c = *impl_;
  if (!c.see_all(canvas.wavefront, view, canvas.cancel)) return;
  gpu::Stream& stream = canvas.stream();
  c.picture.screen.look_up(stream, c.binding());
  DiscontinuityOptions options = c.options.screen;
  if (options.irradiance_weight <= 0) options.irradiance_weight = DiscontinuityOptions{}.irradiance_weight;
  c.picture.screen.measure(stream, of, options, c.dark());
  c.picture.screen.draw(canvas, level);
  stream.run();
  stream.take_times();
}

std::pair<float, float> Cache::scale(uint32_t color) const { return impl_->overlay.scale(color); }

void Cache::draw(const overlay::Canvas& canvas, const Overlay& overlay) {
  impl_->overlay.draw(canvas, overlay, impl_->binding(), [this](gpu::Resources& r) { return bind_sight(r); });
}

}  // namespace lucerna::irradiance_cache
