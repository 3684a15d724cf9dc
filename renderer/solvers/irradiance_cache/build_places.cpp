// Places of a pass's records: candidates, tried places, and the ones to keep.
#include <algorithm>
#include <cmath>

#include "base/timer.h"
#include "gpu/stream.h"
#include "solvers/irradiance_cache/build.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

/// Spacing of the places tried in the first pass, in the scene's radius. Each pass divides it by 4, down to a
/// fraction of the minimum radius. Only needed places are kept, so this sets how finely a pass searches, not
/// the number of records.
constexpr float k_first_spacing = 1.0f / 24, k_spacing_of_least = 0.6f;
/// Number of passes with candidates beyond the lookup, if the cache reads itself, and their spacing: places
/// without a record there cost time, not accuracy.
constexpr uint32_t k_deep_passes = 2;
constexpr float k_deep_spacing = 1.0f / 32;
/// Minimum width of picture cells with candidates, in the spacing of the pass. Gaps at finer detail are left
/// to later passes, whose records read earlier ones and are cheaper.
constexpr float k_finest_of_spacing = 0.5f;
/// Number of passes with one path a pixel; later ones take up to k_most_looks paths a pixel, until this share
/// of the pixels is uncovered.
constexpr uint32_t k_looks_once = 3, k_most_looks = 16;
constexpr float k_enough_uncovered = 0.1f;
/// Minimum number of passes, so that detail of the irradiance is refined even if few paths are uncovered.
constexpr uint32_t k_refining_passes = 4;

/// Maximum number of paths a pixel in a pass: doubled from pass to pass once only fine detail is missing.
uint32_t most_looks(uint32_t pass) {
  uint32_t looks = 1;
  for (uint32_t p = k_looks_once; p <= pass && looks < k_most_looks; ++p) looks *= 2;
  return looks;
}

}  // namespace

bool Cache::Impl::probe(const Work& w) {
  PictureProbing& probing = progress.probing;
  if (!probing.begun) {
    begin_pass(w);
  }
  bool cancelled = false;
  if (!look(w, cancelled)) return !cancelled;
  const schedule::UniformSchedule before = probing.schedule;
  schedule::WorkItem item = probing.schedule.next();
  // Each pass uses new paths.
  const uint32_t first = item.blocks.empty() ? 0 : item.blocks.front().index;
  for (WorkBlock& b : item.blocks)
    b = {probing.blocks.list()[b.index], b.first_sample + probing.paths_before};
  write_frame(gathers.recursive && probing.probes_beyond && status.pass < k_deep_passes ? k_probe_beyond
                                                                                        : k_probe_lookups);
  StageTimer timer(w.wavefront);
  w.stream().fill(tables.candidates, 0);
  const bool complete = w.wavefront.probe(item, w.cancel);
  write_frame();
  if (!complete) {
    probing.schedule = before;
    return false;
  }
  add_time(BuildStep::probe, timer.milliseconds());
  collect(w, item, first);
  if (probing.schedule.done()) end_probing();
  return true;
}

void Cache::Impl::end_probing() {
  PictureProbing& probing = progress.probing;
  const uint32_t looks = probing.schedule.complete();
  const bool covered =
      double(status.probed.uncovered) <= double(options.stop_share) * double(status.probed.paths);
  // Few uncovered paths locate gaps but do not show their width: each would get a record that serves little
  // else.
  if (!covered && looks < most_looks(status.pass) &&
      double(status.probed.uncovered) * looks < double(k_enough_uncovered) * double(status.probed.paths)) {
    probing.schedule.set_samples(2 * looks);
    return;
  }
  probing.paths_before += looks;
  probing.begun = false;
  probing.blocks.end();
  const bool last = covered && (status.pass >= k_refining_passes ||
                                double(pass().screen) <=
                                    double(options.stop_share) * double(picture.screen.sight().points()));
  // Few uncovered paths may be adjacent: a hole in a wall is visible however small its share of the picture.
  // Not after a change of the light: each change would add a few records.
  probing.filling = last && probing.probes_beyond && status.probed.uncovered > 0;
  if (last && !probing.filling)
    finish(StopReason::covered);
  else
    progress.stage = Stage::choose;
  end_stage(BuildStage::probe);
}

bool Cache::Impl::looks_first() const { return tables.picture_routes[0] != k_no_routes && status.pass == 0; }

ReachOptions Cache::Impl::reach(const CacheView& view) const {
  return {.spacing = view.scene_radius * std::ldexp(k_first_spacing, -2 * static_cast<int>(status.pass)),
          .spacing_beyond = view.scene_radius * k_deep_spacing,
          .spacing_of_distance = k_spacing_of_least * tables.least.of_distance,
          .eye = tables.least.eye,
          .parallel = tables.least.parallel};
}

bool Cache::Impl::see(transport::Wavefront& wavefront, const CacheView& view,
                      const std::function<bool()>& cancel) {
  if (!picture.screen.begun()) picture.screen.begin(view.paths_frame);
  write_frame(k_probe_screen);
  const bool complete = picture.screen.see(wavefront, tables.candidates, cancel);
  write_frame();
  return complete;
}

bool Cache::Impl::see_all(transport::Wavefront& wavefront, const CacheView& view,
                          const std::function<bool()>& cancel) {
  bool complete = true;
  if (!picture.screen.seen())
    wavefront.uncounted([&] {
      while (complete && !picture.screen.seen())
        complete = !(cancel && cancel()) && see(wavefront, view, cancel);
    });
  return complete;
}

bool Cache::Impl::look(const Work& w, bool& cancelled) {
  // The first pass searches detail of the geometry; later ones of the irradiance.
  const bool geometry = looks_first();
  const bool irradiance = options.screen.irradiance_weight > 0 && tables.picture_routes[0] != k_no_routes &&
                          status.pass > 0 && ranges.evaluated() > 0;
  if (progress.probing.screen_done || !(geometry || irradiance)) return true;
  StageTimer timer(w.wavefront);
  Discontinuity& screen = picture.screen;
  if (!screen.seen()) {
    cancelled = !see(w.wavefront, w.view, w.cancel);
  } else {
    const Discontinuity::Of of = geometry ? Discontinuity::Of::geometry : Discontinuity::Of::irradiance;
    screen.look_up(w.stream(), binding());
    screen.measure(w.stream(), of, options.screen, dark());
    const float spacing = reach(w.view).spacing;
    screen.dither(w.stream(), of, options.screen,
                  {.least_width = k_spacing_of_least * options.radius.least_pixels,
                   .finest = k_finest_of_spacing * spacing,
                   .flat_side = geometry ? spacing : 0},
                  options.seed + status.pass);
    pass().screen = places.candidates.collect(w.stream(), screen.screen(), reach(w.view));
    progress.probing.screen_done = true;
  }
  add_time(BuildStep::screen, timer.milliseconds());
  return false;
}

void Cache::Impl::collect(const Work& w, const schedule::WorkItem& item, uint32_t first) {
  PictureProbing& probing = progress.probing;
  StageTimer timer(w.wavefront);
  const std::vector<std::array<uint32_t, 3>> counts = places.candidates.collect(
      w.stream(), tables.candidates, item.slots(), item.sample_count, !looks_first(), reach(w.view));
  add_time(BuildStep::choose, timer.milliseconds());
  for (uint32_t i = 0; i < item.blocks.size(); ++i) {
    const double stands_for = probing.blocks.stands_for(first + i);
    for (size_t origin = 0; origin < 3; ++origin) probing.uncovered[origin] += stands_for * counts[i][origin];
    probing.paths += stands_for * 64 * item.sample_count;
    // Lookups by records' rays are not tied to a block.
    if (counts[i][k_origin_screen] + counts[i][k_origin_world] > 0) probing.blocks.note(item.blocks[i].index);
  }
  const auto& by_origin = probing.uncovered;
  status.probed.uncovered = uint64_t(std::llround(by_origin[0] + by_origin[1] + by_origin[2]));
  status.probed.paths = uint64_t(std::llround(probing.paths));
  pass().uncovered = status.probed.uncovered, pass().paths = status.probed.paths;
  pass().uncovered_world = uint64_t(std::llround(by_origin[1] + by_origin[2]));
  pass().candidates = places.candidates.size();
  places.changed();
}

/// Selects the candidates to try.
bool Cache::Impl::choose(const Work& w) {
  const Timer wall;
  Records& records = tables.records;
  places.tried = places.candidates.choose(w.stream(), {.normal_tolerance = k_normal_tolerance,
                                                       .seed = options.seed + status.pass,
                                                       .most = records.capacity() - records.size()});
  pass().tried = uint32_t(places.tried.size());
  pass().clusters = places.candidates.clusters();
  count_bytes();
  records.append(places.tried, status.pass);
  queue_until(records.size());
  add_time(BuildStep::choose, wall.milliseconds());
  progress.stage = Stage::measure;
  end_stage(BuildStage::choose);
  return true;
}

bool Cache::Impl::thin(const Work& w) {
  const Timer host;
  std::vector<float> off_planes;
  for (size_t i = 0; i < places.tried.size(); ++i)
    off_planes.push_back(tables.off_plane(places.tried[i], places.radii[i]));
  places.chosen = thin_out(places.tried, places.radii, off_planes,
                           {.share = options.thinning,
                            .normal_tolerance = k_normal_tolerance,
                            .least_beyond = k_deep_spacing * w.view.scene_radius});
  tables.records.keep(ranges.evaluated(), places.chosen);
  pass().records = uint32_t(places.chosen.size());
  queue_until(tables.records.size());
  add_time(BuildStep::choose, host.milliseconds());
  progress.levels.restart();
  progress.stage = Stage::evaluate;
  end_stage(BuildStage::thin);
  return true;
}

}  // namespace lucerna::irradiance_cache
