#include "solvers/irradiance_cache/build.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/irradiance_cache/noise.h"

namespace lucerna::irradiance_cache {

using namespace shared;

uint32_t elevations_for(uint32_t rays) { return static_cast<uint32_t>(std::lround(std::sqrt(rays / 4.0))); }

Cache::Impl::Impl(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots,
                  const CacheRoutes& routes, const CacheOptions& o)
    : options(o),
      tables(device, compiler, slots, routes, o),
      gathers{.parts = routes.records.parts,
              .recursive = tables.records_look_up(),
              .elsewhere = routes.elsewhere},
      radii(device, compiler, options.radius, o.most_records,
            defines(routes.records, o.radius.metric, o.gather)),
      evaluator(device, compiler, slots, o.groups),
      places(device, compiler),
      picture(device, compiler, o.most_records, defines(routes.records, o.radius.metric, o.gather)),
      overlay(device, compiler, defines(routes.records, o.radius.metric, o.gather)),
      progress{.probing = {}, .queue = {}, .levels = RayLevels(o.rays), .clock = {}, .pauses = {}},
      preview(device, compiler, o.groups) {
  count_bytes();
}

void Cache::Impl::count_bytes() {
  status.bytes = tables.bytes() + radii.bytes() + picture.bytes() + places.candidates.bytes();
}

void Cache::Impl::clear() {
  forget_refining();
  preview.end();
  tables.records.clear();
  places.forget();
  progress.pauses.dropped();
  picture.forget();
  status = {.bytes = status.bytes};
  progress.stage = Stage::probe;
  progress.probing.begun = progress.probing.camera_moved = false;
  restart_passes(true);
  ranges.clear();
  held = gathers;
  write_frame();
}

void Cache::Impl::look_from(const CacheView& view) {
  tables.octree.set_core(view.core);
  const Frame& f = view.paths_frame;
  const LeastRadius now{
      .eye = f.camera_origin,
      .parallel = f.projection == shared::k_projection_orthographic,
      .of_distance = options.radius.least_pixels * 2 * glm::length(f.camera_up) / float(f.height),
      .most = options.radius.most_radius * view.scene_radius};
  if (now == tables.least) return;
  tables.least = now;
  write_frame();
}

void Cache::Impl::restart_passes(bool beyond) {
  status.pass = 0;
  progress.probing.restart(beyond);
  progress.ends_early = false;
  status.stop = progress.stopped_before = StopReason::building;
}

void Cache::Impl::drop_pass() {
  tables.records.truncate(ranges.placed());
  queue_until(ranges.placed());
  progress.stage = Stage::probe;
  progress.probing.begun = false;
  places.forget();
}

bool Cache::Impl::end_with_first_level() {
  if (progress.stage == Stage::evaluate && ranges.waiting() > 0) {
    // Records get a level of many rays in rounds, all of them a round before the next.
    const bool one_round = progress.levels.round_rays() == progress.levels.rays();
    const auto have = uint32_t(one_round ? progress.queue.done_count() : 0);
    if (have == 0) return false;
    tables.records.truncate(ranges.evaluated() + have);
    pass().records = have;
    queue_until(tables.records.size());
    progress.stage = Stage::index;
  } else if (progress.stage != Stage::index) {
    return false;
  }
  progress.ends_early = true;
  progress.pauses.dropped();
  status.waits = false;
  return true;
}

double Cache::Impl::missing() const {
  // Paths count the gaps that the passes before have left. The records of a first pass leave gaps that are
  // not known yet.
  if (status.passes.empty() || status.passes.back().paths == 0) return 1;
  const CachePass& now = status.passes.back();
  const double before = now.uncovered_share();
  if (now.number == 0 || progress.stage < Stage::evaluate) return before;
  if (ranges.waiting() == 0 || progress.stage == Stage::index) return 0;
  const RecordQueue& queue = progress.queue;
  return before * (1 - double(queue.done_count()) / double(std::max<size_t>(queue.all().size(), 1)));
}

bool Cache::Impl::work_on_stage(const Work& w) {
  switch (progress.stage) {
    case Stage::probe:
      return probe(w);
    case Stage::choose:
      return choose(w);
    case Stage::measure:
      return measure(w);
    case Stage::thin:
      return thin(w);
    case Stage::evaluate:
      return evaluate(w);
    case Stage::index:
      return index(w);
    case Stage::done:
      break;
  }
  return true;
}

void Cache::Impl::begin_pass(const Work& w) {
  PictureProbing& probing = progress.probing;
  if (probing.camera_moved) drop_roomy(w);
  probing.camera_moved = false;
  if (!status.passes.empty() && !pass().complete) status.passes.pop_back();
  status.passes.push_back({.number = status.pass});
  status.probed.uncovered = status.probed.paths = 0;
  probing.blocks.begin((w.view.width + 7) / 8, (w.view.height + 7) / 8, status.pass);
  probing.schedule = {uint32_t(probing.blocks.list().size()), 1, w.wavefront.slots()};
  probing.uncovered = {}, probing.paths = 0;
  places.forget();
  progress.clock.restart();
  probing.begun = true;
  probing.screen_done = false;
}

void Cache::Impl::end_stage(BuildStage stage, bool last) {
  status.last = progress.clock.end(stage, pass());
  places.changed();
  if (progress.stage != Stage::done) progress.pauses.ended(last);
  status.waits = progress.pauses.waits();
}

void Cache::Impl::end_pass(const Work& w) {
  // Later levels may hit nearer geometry than the first. Relit records stay unchanged: nothing would fill the
  // gaps.
  if (progress.levels.level() > 0 && status.relighting.records == 0)
    clamp_radii(w, ranges.evaluated(), options.radius.nearest);
  overlay.set_scales(tables.records.figures());
  pass().complete = true;
  if (status.relighting.records > 0) return relight_pass();
  ranges.complete_pass();
  ++status.pass;
  next_pass();
}

void Cache::Impl::next_pass() {
  progress.stage = Stage::probe;
  if (tables.records.size() == tables.records.capacity())
    finish(StopReason::records);
  else if (std::exchange(progress.probing.filling, false))
    finish(StopReason::covered);
  else if (status.pass >= options.most_passes)
    finish(StopReason::passes);
}

void Cache::Impl::finish(StopReason reason) {
  progress.stage = Stage::done;
  status.stop = reason;
  progress.pauses.complete();
  status.waits = false;
  if (!status.passes.empty()) pass().complete = true;
  publish_smoothed();
  write_frame();
}

void Cache::Impl::queue_until(uint32_t end) {
  ranges.set_pass_end(end);
  progress.queue.set(ranges.evaluated(), end);
}

void Cache::Impl::add_rays(size_t records, uint32_t rays) {
  pass().rays += uint64_t(records) * rays;
  status.rays += uint64_t(records) * rays;
}

float Cache::Impl::dark() const { return dark_luminance(tables.records.luminances(), ranges.evaluated()); }

}  // namespace lucerna::irradiance_cache
