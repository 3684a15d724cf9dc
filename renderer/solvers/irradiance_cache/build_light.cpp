// Light of a pass's records, level by level, and its publication to lookups.
#include <algorithm>
#include <cmath>
#include <utility>

#include "gpu/stream.h"
#include "solvers/irradiance_cache/build.h"
#include "solvers/irradiance_cache/noise.h"
#include "solvers/irradiance_cache/smoothing.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

/// Importance (PictureReads) for which the option `noise` holds at the first level, in squares of the
/// picture's height: about that of a record with a radius of 3 % of it.
constexpr float k_noisy_importance = 0.03f * 0.03f * 0.5f;

/// Most rays per pixel of the picture in all levels of a pass after the first, for the default of `noise`; in
/// proportion to noise^-2. Whether more of them pay is only known in comparison with samples (refinement). In
/// a room lit through a window (256x256) a pass without a bound took 88, and 8 samples then had the same
/// error as after 32, in twice the time.
double most_further_rays(float noise) {
  constexpr double k_rays = 16, k_noise = 0.3;
  const double ratio = k_noise / double(noise);
  return k_rays * ratio * ratio;
}

}  // namespace

bool Cache::Impl::see_reads(const Work& w) {
  PictureReads& reads = picture.reads;
  if (!reads.begun()) reads.begin(w.view.paths_frame);
  StageTimer timer(w.wavefront);
  w.wavefront.set_frame(reads.frame(), w.view.paths_enabled);
  const bool complete = reads.see(
      w.wavefront, tables.candidates, gathers.recursive, [this](uint32_t probing) { write_frame(probing); },
      w.cancel);
  w.wavefront.set_frame(w.view.paths_frame, w.view.paths_enabled);
  add_time(BuildStep::probe, timer.milliseconds());
  return complete;
}

bool Cache::Impl::gather(const Work& w) {
  RecordQueue& queue = progress.queue;
  const RayLevels& levels = progress.levels;
  const uint32_t rays = levels.round_rays(), elevations = elevations_for(rays);
  const std::span<const uint32_t> batch = queue.next(std::max(1u, w.wavefront.slots() / rays));
  w.wavefront.set_frame(w.view.records_frame, w.view.records_enabled);
  write_frame(k_probe_none, tables.record_routes);
  StageTimer timer(w.wavefront);
  const size_t done = evaluator.evaluate(w.wavefront, w.automaton, tables.records, batch,
                                         {.elevations = elevations,
                                          .azimuths = 4 * elevations,
                                          .rays_before = levels.rays_before(),
                                          .parts = gathers.parts,
                                          .elsewhere = gathers.elsewhere,
                                          .seed = options.seed,
                                          .near = radii.by_light() && levels.in_first_round(),
                                          .guides = options.gather && levels.level() == 0},
                                         w.cancel);
  w.wavefront.set_frame(w.view.paths_frame, w.view.paths_enabled);
  write_frame();
  if (done < batch.size()) return false;
  add_time(BuildStep::evaluate, timer.milliseconds());
  queue.advance(done);
  if (status.relighting.records > 0 && levels.level() == 0)
    status.relighting.share =
        (float(ranges.evaluated()) +
         float(ranges.waiting()) * float(queue.done_count()) / float(queue.all().size())) /
        float(status.relighting.records);
  add_rays(done, rays);
  return true;
}

bool Cache::Impl::evaluate(const Work& w) {
  if (!picture.reads.seen()) return see_reads(w);
  RayLevels& levels = progress.levels;
  if (progress.refining.under_way && progress.queue.all().empty()) {
    if (picture.importance.size() != ranges.evaluated())
      picture.importance = picture.reads.measure(w.stream(), binding(), ranges.evaluated());
    if (!next_refined()) end_refining();
    return true;
  }
  if (!progress.queue.done()) {
    if (!gather(w)) return false;
    if (!progress.queue.done()) return true;
    progress.queue.rewind();
    if (!levels.end_round()) return true;
  }
  levels.end_level();
  if (progress.refining.under_way) {
    publish_smoothed();
    if (!next_refined()) end_refining();
    return true;
  }
  const uint32_t done_level = levels.level() + 1;
  const bool first = ranges.waiting() > 0;
  bool more_levels = true;
  if (first) {
    progress.stage = Stage::index;
    progress.ends_early = false;
  } else {
    more_levels = next_level(w.view);
    publish_level(w);
  }
  end_stage(BuildStage::evaluate, !more_levels);
  status.last->level = done_level;
  if (!more_levels) end_pass(w);
  return true;
}

/// Sets the radii of records after their first level, and makes them available to paths.
bool Cache::Impl::index(const Work& w) {
  progress.stage = Stage::evaluate;
  publish_level(w);
  if (progress.ends_early) {
    end_stage(BuildStage::octree, true);
    ranges.complete_pass();
    finish(StopReason::finished_early);
    return true;
  }
  StageTimer timer(w.wavefront);
  picture.importance = picture.reads.measure(w.stream(), binding(), ranges.evaluated());
  add_time(BuildStep::probe, timer.milliseconds());
  const bool more_levels = next_level(w.view);
  end_stage(BuildStage::octree, !more_levels);
  if (!more_levels) end_pass(w);
  return true;
}

void Cache::Impl::publish_level(const Work& w) {
  tables.records.publish(w.stream());
  // Radii come from the first level. Hits of later levels clamp them at the end of the pass, and the next
  // pass fills the gaps. A cache that reads itself uses its own pass's records from the second level on: only
  // the first, of few rays, is traced without them.
  if (status.relighting.records > 0) preview.take(w.stream(), tables, ranges.pass_end());
  if (ranges.waiting() == 0) return;
  // Ellipses depend on the light; circles do not.
  const bool sets_radii = ranges.has_new() || radii.by_light();
  if (sets_radii) {
    set_radii(w, radii.by_light() ? By::light : By::distance);
    held = gathers;
  }
  ranges.evaluate_pass();
  status.records = ranges.evaluated();
  index_records(w, ranges.evaluated(), sets_radii ? IndexFor::radii : IndexFor::building);
  if (sets_radii) clamp_radii(w, ranges.evaluated(), options.radius.nearest);
  write_frame();
}

void Cache::Impl::publish_smoothed() {
  tables.records.publish(smooth(tables.records.raw(ranges.evaluated()),
                                {.reach = options.smooth ? SmoothingOptions{}.reach : 0}));
}

/// Noise bound of a record, relative to the option. The gain of one more level in the picture's squared
/// error, per ray, is noise^2 A / n with n rays so far and importance A (PictureReads). Equal gain means
/// noise proportional to sqrt(n) / sqrt(A).
float Cache::Impl::share_of_noise(uint32_t record) const {
  // Records that the picture does not read stop at the first level.
  constexpr float k_least = 1e-20f;
  return std::ldexp(std::sqrt(k_noisy_importance / std::max(picture.importance[record], k_least)),
                    int(progress.levels.level()));
}

bool Cache::Impl::at_last_level() const { return progress.levels.next_rays() > options.most_rays; }

std::vector<uint32_t> Cache::Impl::noisy(const std::vector<uint32_t>& records,
                                         const std::vector<Records::Figures>& figures, size_t most) const {
  if (records.empty()) return {};
  const std::vector<float> light = tables.records.luminances();
  const float noise = options.noise * progress.refining.noise;
  std::vector<Noise> noises;
  for (const uint32_t r : records) noises.push_back({figures[r].error, light[r], noise * share_of_noise(r)});
  std::vector<uint32_t> found;
  for (const uint32_t i : too_noisy(noises, dark_luminance(light, ranges.evaluated()), most))
    found.push_back(records[i]);
  return found;
}

bool Cache::Impl::next_level(const CacheView& view) {
  RecordQueue& queue = progress.queue;
  queue.set(without_crowded(queue.all()));  // the rays so far may have hit near geometry
  if (queue.done() || at_last_level()) return false;
  RayLevels& levels = progress.levels;
  const double left =
      most_further_rays(options.noise) * view.width * view.height - double(levels.further_rays());
  const double most = std::clamp(left / double(levels.next_rays()), 0.0, double(queue.all().size()));
  queue.set(noisy(queue.all(), tables.records.figures(), size_t(most)));
  if (queue.done()) return false;
  levels.next(queue.all().size());
  return true;
}

void Cache::Impl::begin_refining(double factor) {
  if (progress.stage != Stage::done || ranges.evaluated() == 0) return;
  progress.refining = {.under_way = true, .noise = progress.refining.noise / float(std::sqrt(factor))};
  progress.queue.set({});
  progress.stage = Stage::evaluate;
  if (status.passes.empty()) status.passes.push_back({.number = status.pass, .complete = true});  // loaded
}

void Cache::Impl::end_refining() {
  if (!progress.refining.under_way) return;
  progress.refining.under_way = false;
  progress.queue.set({});
  progress.stage = Stage::done;
}

void Cache::Impl::forget_refining() {
  end_refining();
  progress.refining = {};
}

bool Cache::Impl::next_refined() {
  const std::vector<Records::Figures> figures = tables.records.figures();
  for (uint32_t& level = progress.refining.level;; ++level) {
    progress.levels.resume(level);
    if (at_last_level()) return false;
    std::vector<uint32_t> here;
    for (uint32_t r = 0; r < ranges.evaluated(); ++r)
      if (figures[r].rays == float(progress.levels.rays_before())) here.push_back(r);
    progress.queue.set(noisy(without_crowded(std::move(here)), figures));
    if (progress.queue.done()) continue;
    progress.levels.next(progress.queue.all().size());
    ++level;
    return true;
  }
}

std::vector<uint32_t> Cache::Impl::without_crowded(std::vector<uint32_t> list) const {
  if (!options.gather) return list;
  const std::vector<bool> crowded = tables.records.crowded();
  std::erase_if(list, [&](uint32_t record) { return crowded[record]; });
  return list;
}

}  // namespace lucerna::irradiance_cache
