// Radii of a pass's records, and which of them are crowded.
#include <algorithm>

#include "gpu/stream.h"
#include "solvers/irradiance_cache/build.h"
#include "solvers/irradiance_cache/noise.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

/// Records become crowded if geometry is nearer than this times the minimum radius: few pixels would read
/// them, each with separate noise.
constexpr float k_crowds = 2;

}  // namespace

float Cache::Impl::crowd() const {
  return options.gather && progress.stage == Stage::measure && status.relighting.records == 0 ? k_crowds
                                                                                              : 0.0f;
}

Radii::Wanted Cache::Impl::wanted_radii() const {
  return {
      .first = ranges.evaluated(), .count = ranges.waiting(), .most = tables.least.most, .crowd = crowd()};
}

/// Measures distances around the tried places, and the curvature of the light, to get their radii and the
/// ones to keep.
bool Cache::Impl::measure(const Work& w) {
  const std::span<const uint32_t> batch =
      progress.queue.next(std::max(1u, w.wavefront.slots() / Evaluator::k_distance_rays));
  w.wavefront.set_frame(w.view.records_frame, w.view.records_enabled);
  write_frame(k_probe_none, tables.record_routes);
  StageTimer timer(w.wavefront);
  const size_t done =
      radii.by_light()
          ? evaluator.pilot(w.wavefront, w.automaton, tables.records, batch,
                            {.elevations = Evaluator::k_distance_elevations,
                             .azimuths = Evaluator::k_distance_rays / Evaluator::k_distance_elevations,
                             .parts = gathers.parts,
                             .elsewhere = gathers.elsewhere,
                             .seed = options.seed},
                            w.cancel)
          : evaluator.measure(w.wavefront, tables.records, batch, options.seed, w.cancel);
  w.wavefront.set_frame(w.view.paths_frame, w.view.paths_enabled);
  write_frame();
  progress.queue.advance(done);
  add_time(BuildStep::measure, timer.milliseconds());
  add_rays(done, Evaluator::k_distance_rays);
  if (done < batch.size()) return false;
  if (!progress.queue.done()) return true;
  set_radii(w, By::distance);
  if (radii.by_light()) {
    pool(w);
    set_radii(w, By::light);
  }
  if (status.relighting.records > 0) {
    queue_until(ranges.pass_end());
    progress.stage = Stage::evaluate;
  } else {
    index_records(w, ranges.pass_end(), IndexFor::radii);
    clamp_radii(w, ranges.pass_end(), radii.tried_near());
    places.radii = tables.records.radii(ranges.evaluated());
    progress.stage = Stage::thin;
  }
  end_stage(BuildStage::measure);
  return true;
}

void Cache::Impl::pool(const Work& w) {
  if (ranges.waiting() == 0) return;
  StageTimer timer(w.wavefront);
  build_octree(w.wavefront, ranges.pass_end(), IndexFor::radii);
  radii.pool(w.stream(), binding(), ranges.evaluated(), ranges.waiting());
  build_octree(w.wavefront, ranges.evaluated(), IndexFor::building);
  add_time(BuildStep::radius, timer.milliseconds());
}

void Cache::Impl::set_radii(const Work& w, By by) {
  if (ranges.waiting() == 0) return;
  StageTimer timer(w.wavefront);
  if (by == By::light)
    radii.set_by_light(w.stream(), binding(), wanted_radii(), w.view.scene_radius,
                       dark_luminance(tables.records.pilot_luminances(), ranges.pass_end()));
  else
    radii.set_by_distance(w.stream(), binding(), wanted_radii());
  add_time(BuildStep::radius, timer.milliseconds());
}

void Cache::Impl::clamp_radii(const Work& w, uint32_t count, float near) {
  StageTimer timer(w.wavefront);
  radii.clamp(w.stream(), binding(), count, near, crowd(), ranges.evaluated());
  add_time(BuildStep::radius, timer.milliseconds());
  index_records(w, ranges.evaluated(), IndexFor::building);
}

void Cache::Impl::index_records(const Work& w, uint32_t count, IndexFor use) {
  StageTimer timer(w.wavefront);
  build_octree(w.wavefront, count, use);
  add_time(BuildStep::octree, timer.milliseconds());
}

void Cache::Impl::drop_roomy(const Work& w) {
  // With twice the necessary room, so that small camera moves do not drop them again.
  constexpr float k_roomy = 2;
  if (!options.gather || ranges.complete() == 0) return;
  RawRecords raw = tables.records.raw(ranges.complete());
  std::vector<uint32_t> kept;
  for (uint32_t r = 0; r < raw.size(); ++r) {
    const vec4* const texels = &raw.places[size_t{r} * k_record_texels];
    const float needed = k_roomy * tables.least.at(vec3(texels[0])), lesser_radius = texels[3].w,
                nearest = texels[2].y;
    if (!raw.crowded(r) || lesser_radius < needed || options.radius.nearest * nearest < k_crowds * needed)
      kept.push_back(r);
  }
  if (kept.size() == raw.size()) return;
  raw.keep(kept);
  replace_records(raw);
  build_octree(w.wavefront, ranges.evaluated(), IndexFor::building);
  write_frame();
}

}  // namespace lucerna::irradiance_cache
