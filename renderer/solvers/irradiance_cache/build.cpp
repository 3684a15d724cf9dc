#include "solvers/irradiance_cache/build.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/timer.h"
#include "gpu/stream.h"
#include "solvers/irradiance_cache/noise.h"

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
/// Width of the finest cells of the picture that ask, in the spacing of the pass: gaps about finer detail are
/// left to later passes, whose records read those of the first and are cheaper.
constexpr float k_finest_of_spacing = 0.5f;
/// How much of the picture reads a record (Worth) of which the option `noise` is true after the first level,
/// in squares of the picture's height: about what one does with a radius of 3 % of that.
constexpr float k_noisy_worth = 0.03f * 0.03f * 0.5f;
/// Passes that look along one path a pixel; paths a pixel that later ones look along at most, until so many
/// of the pixels' number ask.
constexpr uint32_t k_looks_once = 3, k_most_looks = 16;
constexpr float k_enough_ask = 0.1f;
/// Passes that go on for the irradiance that the records give, when few paths ask.
constexpr uint32_t k_refining_passes = 4;
/// Of metric `hessian`, over `error`: makes about as many records as the split sphere does with the same.
constexpr float k_hessian_reach = 0.5f;
/// Of metric `hessian`, over the nearest thing: how far a place that is tried would serve. The first level
/// has more rays, which meet nearer things.
constexpr float k_tried_near = 0.8f;

/// Paths a pixel that a pass looks along at most: twice as many as the one before, once what is left is fine
/// detail.
uint32_t most_looks(uint32_t pass) {
  uint32_t looks = 1;
  for (uint32_t p = k_looks_once; p <= pass && looks < k_most_looks; ++p) looks *= 2;
  return looks;
}

}  // namespace

uint32_t elevations_for(uint32_t rays) { return static_cast<uint32_t>(std::lround(std::sqrt(rays / 4.0))); }

bool Cache::Impl::probe(const Work& w) {
  if (!probing) {
    picture = {((w.view.width + 7) / 8) * ((w.view.height + 7) / 8), 1, w.wavefront.slots()};
    begin_pass(w);
  }
  bool cancelled = false;
  if (!look(w, cancelled)) return !cancelled;
  const schedule::UniformSchedule before = picture;
  schedule::WorkItem item = picture.next();
  // Each pass looks along paths of its own.
  for (WorkBlock& b : item.blocks) b.first_sample += looked_along;
  tell(recursive && asks_beyond && status.pass < k_deep_passes ? k_probe_beyond : k_probe_lookups);
  StageTimer timer(w.wavefront);
  w.wavefront.stream().fill(candidates, 0);
  const bool complete = w.wavefront.probe(item, w.cancel);
  tell();
  if (!complete) {
    picture = before;
    return false;
  }
  took(BuildStep::probe, timer.milliseconds());
  collect(w, item);
  if (!picture.done()) return true;
  const bool covered = double(status.asked) <= double(options.stop_share) * double(status.paths);
  // Few that ask show where gaps are, not how wide they are: each would get a record that serves little else.
  if (!covered && picture.complete() < most_looks(status.pass) &&
      double(status.asked) * picture.complete() < double(k_enough_ask) * double(status.paths)) {
    picture.set_samples(2 * picture.complete());
    return true;
  }
  looked_along += picture.complete();
  probing = false;
  const bool last =
      covered && (status.pass >= k_refining_passes ||
                  double(pass().screen) <= double(options.stop_share) * double(screen.sight().points()));
  // Few ask, and may stand side by side: a hole in a wall is seen however small its share of the picture is.
  // Not when light has changed: then there would be a little more with every change.
  filling = last && asks_beyond && status.asked > 0;
  if (last && !filling)
    finish(StopReason::covered);
  else
    stage = Stage::choose;
  ended(BuildStage::probe);
  return true;
}

void Cache::Impl::begin_pass(const Work& w) {
  if (moved) drop_roomy(w);
  moved = false;
  if (!status.passes.empty() && !pass().complete) status.passes.pop_back();
  status.passes.push_back({.number = status.pass});
  status.asked = status.paths = 0;
  forget_placement();
  ms_before = 0, rays_at_end = 0;
  probing = true;
  looked = false;
}

bool Cache::Impl::looks_first() const {
  return options.screen.density > 0 && routes[0] != k_no_routes && status.pass == 0;
}

ReachOptions Cache::Impl::reach(const CacheView& view) const {
  return {.spacing = view.scene_radius * std::ldexp(k_first_spacing, -2 * static_cast<int>(status.pass)),
          .spacing_beyond = view.scene_radius * k_deep_spacing,
          .spacing_of_distance = k_spacing_of_least * least.of_distance,
          .eye = least.eye,
          .parallel = least.parallel};
}

bool Cache::Impl::see(transport::Wavefront& wavefront, const CacheView& view,
                      const std::function<bool()>& cancel) {
  if (!screen.begun()) screen.begin(view.paths_frame);
  tell(k_probe_screen);
  const bool complete = screen.see(wavefront, candidates, cancel);
  tell();
  return complete;
}

bool Cache::Impl::look(const Work& w, bool& cancelled) {
  // The first pass looks at the geometry; later ones at what the records make of it.
  const bool geometry = looks_first();
  const bool irradiance = options.screen.density > 0 && options.screen.irradiance_weight > 0 &&
                          routes[0] != k_no_routes && status.pass > 0 && evaluated > 0;
  if (looked || !(geometry || irradiance)) return true;
  StageTimer timer(w.wavefront);
  if (!screen.seen()) {
    cancelled = !see(w.wavefront, w.view, w.cancel);
  } else {
    const Discontinuity::Of of = geometry ? Discontinuity::Of::geometry : Discontinuity::Of::irradiance;
    gpu::Stream& stream = w.wavefront.stream();
    screen.look_up(stream, [this](gpu::Resources& r) { bind(r); });
    screen.measure(stream, of, options.screen, dark(records.luminances(), evaluated));
    const float spacing = reach(w.view).spacing;
    screen.dither(stream, of, options.screen,
                  {.least_width = k_spacing_of_least * options.least_pixels,
                   .finest = k_finest_of_spacing * spacing,
                   .flat_side = geometry ? spacing : 0},
                  options.seed + status.pass);
    pass().screen = placement.collect(stream, screen.screen(), reach(w.view));
    looked = true;
  }
  took(BuildStep::screen, timer.milliseconds());
  return false;
}

void Cache::Impl::collect(const Work& w, const schedule::WorkItem& item) {
  StageTimer timer(w.wavefront);
  const std::array<uint32_t, 3> by_origin = placement.collect(
      w.wavefront.stream(), candidates, item.slots(), item.sample_count, !looks_first(), reach(w.view));
  took(BuildStep::choose, timer.milliseconds());
  status.asked += by_origin[0] + by_origin[1] + by_origin[2];
  status.paths += item.slots();
  pass().asked = status.asked, pass().paths = status.paths;
  pass().asked_world += by_origin[1] + by_origin[2];
  pass().candidates = placement.size();
  ++placement_version;
}

/// Which of the places asked for are tried.
bool Cache::Impl::choose(const Work& w) {
  const Timer wall;
  tried = placement.choose(w.wavefront.stream(), {.normal_tolerance = k_normal_tolerance,
                                                  .seed = options.seed + status.pass,
                                                  .most = records.capacity() - records.size()});
  pass().tried = uint32_t(tried.size());
  pass().clusters = placement.clusters();
  count_bytes();
  records.append(tried, status.pass);
  list_until(records.size());
  took(BuildStep::choose, wall.milliseconds());
  stage = Stage::measure;
  ended(BuildStage::choose);
  return true;
}

/// How far things are around what is tried, and how light bends there, says how wide its records will be, and
/// so which are needed.
bool Cache::Impl::measure(const Work& w) {
  const size_t batch =
      std::min<size_t>(list.size() - at, std::max(1u, w.wavefront.slots() / Evaluator::k_distance_rays));
  const std::span<const uint32_t> some = std::span(list).subspan(at, batch);
  w.wavefront.set_frame(w.view.records_frame, w.view.records_enabled);
  tell(k_probe_none, own_routes);
  StageTimer timer(w.wavefront);
  const size_t done =
      by_light() ? evaluator.pilot(w.wavefront, w.automaton, records, some,
                                   {.elevations = Evaluator::k_distance_elevations,
                                    .azimuths = Evaluator::k_distance_rays / Evaluator::k_distance_elevations,
                                    .parts = parts,
                                    .seed = options.seed},
                                   w.cancel)
                 : evaluator.measure(w.wavefront, records, some, options.seed, w.cancel);
  w.wavefront.set_frame(w.view.paths_frame, w.view.paths_enabled);
  tell();
  at += done;
  took(BuildStep::measure, timer.milliseconds());
  spent(done, Evaluator::k_distance_rays);
  if (done < batch) return false;
  if (at < list.size()) return true;
  set_radii(w, By::distance);
  if (by_light()) {
    pool(w);
    set_radii(w, By::light);
  }
  if (status.relighting > 0) {
    list_until(until);
    stage = Stage::evaluate;
  } else {
    clamp_radii(w, until, tried_near());
    tried_radii = records.radii(evaluated);
    stage = Stage::thin;
  }
  ended(BuildStage::measure);
  return true;
}

bool Cache::Impl::thin() {
  const Timer host;
  std::vector<float> off_planes;
  for (size_t i = 0; i < tried.size(); ++i) off_planes.push_back(off_plane(tried[i], tried_radii[i]));
  kept = thin_out(tried, tried_radii, off_planes,
                  {.share = options.thinning, .normal_tolerance = k_normal_tolerance});
  records.keep(evaluated, kept);
  pass().records = uint32_t(kept.size());
  list_until(records.size());
  took(BuildStep::choose, host.milliseconds());
  level = level_done = rays_before = 0;
  stage = Stage::evaluate;
  ended(BuildStage::thin);
  return true;
}

bool Cache::Impl::see_reads(const Work& w) {
  if (!reads.begun()) reads.begin(w.view.paths_frame);
  StageTimer timer(w.wavefront);
  w.wavefront.set_frame(reads.frame(), w.view.paths_enabled);
  const bool complete = reads.see(
      w.wavefront, candidates, recursive, [this](uint32_t probing) { tell(probing); }, w.cancel);
  w.wavefront.set_frame(w.view.paths_frame, w.view.paths_enabled);
  took(BuildStep::probe, timer.milliseconds());
  return complete;
}

bool Cache::Impl::evaluate(const Work& w) {
  if (!reads.seen()) return see_reads(w);
  // A level of more rays than can be summed at once is done in rounds of as many.
  const uint32_t level_rays = options.rays << 2 * level;
  uint32_t rays = level_rays;
  while (rays > Evaluator::k_most_rays) rays /= 4;
  const uint32_t elevations = elevations_for(rays);
  const size_t batch = std::min<size_t>(list.size() - at, std::max(1u, w.wavefront.slots() / rays));
  if (batch > 0) {
    w.wavefront.set_frame(w.view.records_frame, w.view.records_enabled);
    tell(k_probe_none, own_routes);
    StageTimer timer(w.wavefront);
    const size_t done =
        evaluator.evaluate(w.wavefront, w.automaton, records, std::span(list).subspan(at, batch),
                           {.elevations = elevations,
                            .azimuths = 4 * elevations,
                            .rays_before = rays_before,
                            .parts = parts,
                            .seed = options.seed,
                            .near = by_light() && level == 0 && level_done == 0,
                            .guides = options.gather && level == 0},
                           w.cancel);
    w.wavefront.set_frame(w.view.paths_frame, w.view.paths_enabled);
    tell();
    if (done < batch) return false;
    took(BuildStep::evaluate, timer.milliseconds());
    at += done;
    if (status.relighting > 0 && level == 0)
      status.relit = (float(evaluated) + float(until - evaluated) * float(at) / float(list.size())) /
                     float(status.relighting);
    spent(done, rays);
    if (at < list.size()) return true;
    rays_before += rays;
    level_done += rays;
    at = 0;
    if (level_done < level_rays) return true;
  }
  level_done = 0;
  const uint32_t done_level = level + 1;
  const bool first = evaluated < until;
  if (first) {
    stage = Stage::index;
  } else {
    more_levels = next_level();
    publish_level(w);
  }
  ended(BuildStage::evaluate, !first && !more_levels);
  status.last->level = done_level;
  if (!first && !more_levels) end_pass(w);
  return true;
}

/// Records of the first level get their radii and become those that paths find.
bool Cache::Impl::index(const Work& w) {
  stage = Stage::evaluate;
  publish_level(w);
  StageTimer timer(w.wavefront);
  worth = reads.measure(
      w.wavefront.stream(), [&](gpu::Resources& to) { bind(to); }, evaluated);
  took(BuildStep::probe, timer.milliseconds());
  more_levels = next_level();
  ended(BuildStage::octree, !more_levels);
  if (!more_levels) end_pass(w);
  return true;
}

void Cache::Impl::ended(BuildStage which, bool last) {
  const double ms = pass().total_ms();
  status.last = StageDone{
      .stage = which, .pass = pass().number, .ms = ms - ms_before, .rays = pass().rays - rays_at_end};
  ms_before = ms, rays_at_end = pass().rays;
  ++placement_version;
  if (stage != Stage::done) pauses.ended(last);
  status.waits = pauses.waits();
}

void Cache::Impl::forget_placement() {
  placement.clear();
  tried.clear(), kept.clear(), tried_radii.clear();
  ++placement_version;
}

void Cache::Impl::publish_level(const Work& w) {
  records.publish(w.wavefront.stream());
  // Radii come from the first level; what the rays of later ones meet clamps them at the end of the pass, and
  // the next one fills the gaps. A cache that reads itself does so from the second level on: the first, of
  // few rays, then is all that is traced without the records of its own pass.
  ++status.published;
  if (evaluated == until) return;
  // Ellipses are by the light; circles stand.
  const bool anew = until > standing || by_light();
  if (anew) {
    set_radii(w, by_light() ? By::light : By::distance);
    hold();
  }
  evaluated = status.records = until;
  standing = std::max(standing, evaluated);
  StageTimer timer(w.wavefront);
  build_octree(w.wavefront);
  if (anew && neighbours) {
    bound_radii(w);
    build_octree(w.wavefront);
  }
  took(BuildStep::octree, timer.milliseconds());
  if (anew) clamp_radii(w, evaluated, options.nearest);
  tell();
}

void Cache::Impl::bound_radii(const Work& w) {
  neighbours->bound(
      w.wavefront.stream(), [&](gpu::Resources& to) { bind(to); }, evaluated);
  count_bytes();
}

void Cache::Impl::end_pass(const Work& w) {
  // The levels' rays have met more than the first's. Records that are relit stay as they are: nobody would
  // fill gaps.
  if (level > 0 && status.relighting == 0) clamp_radii(w, evaluated, options.nearest);
  set_scales();
  pass().complete = true;
  if (status.relighting > 0) return relight_pass();
  if (evaluated > complete()) ends.push_back(evaluated);
  ++status.pass;
  next_pass();
}

void Cache::Impl::next_pass() {
  stage = Stage::probe;
  if (records.size() == records.capacity())
    finish(StopReason::records);
  else if (std::exchange(filling, false))
    finish(StopReason::covered);
  else if (status.pass >= options.most_passes)
    finish(StopReason::passes);
}

/// What noise a record may have and be done, over the option. One more level is worth what it takes from the
/// picture's squared error, per ray: with n rays so far, noise^2 A / n where A is how much of the picture
/// reads the record (Worth). Equal worth is noise in proportion to sqrt(n) / sqrt(A).
float Cache::Impl::share_of_noise(uint32_t record) const {
  // Nobody reads some: those stop at the first level.
  constexpr float k_least = 1e-20f;
  return std::ldexp(std::sqrt(k_noisy_worth / std::max(worth[record], k_least)), int(level));
}

bool Cache::Impl::next_level() {
  const uint32_t rays = options.rays << 2 * level;
  leave_crowded();  // the rays so far may have met what is near
  if (list.empty() || uint64_t{4} * rays > options.most_rays) return false;
  const std::vector<Records::Figures> figures = records.figures();
  const std::vector<float> light = records.luminances();
  std::vector<Noise> noises;
  for (const uint32_t r : list)
    noises.push_back({figures[r].error, light[r], options.noise * share_of_noise(r)});
  std::vector<uint32_t> longer;
  for (const uint32_t i : too_noisy(noises, dark(light, evaluated))) longer.push_back(list[i]);
  list = std::move(longer);
  if (list.empty()) return false;
  ++level;
  return true;
}

float Cache::Impl::dark(std::span<const float> light, uint32_t count) const {
  // Where records crowd they have none.
  double sum = 0;
  uint32_t lit = 0;
  for (const float l : light.first(count)) sum += double(l), lit += l > 0;
  return lit > 0 ? 0.1f * float(sum / lit) : 1.0f;
}

float Cache::Impl::tried_near() const { return options.nearest * (by_light() ? k_tried_near : 1); }

void Cache::Impl::pool(const Work& w) {
  const uint32_t count = until - evaluated;
  if (count == 0) return;
  StageTimer timer(w.wavefront);
  build_octree(w.wavefront, until);
  bind(resources);
  resources.set("Pooled", pooled);
  resources.set("pooled_texels", pooled);
  const PoolPush push{evaluated, count};
  const uint32_t groups = gpu::groups_for(count, 64);
  w.wavefront.stream().dispatch(pooling, resources, push, groups, "records");
  w.wavefront.stream().dispatch(pool_keep, resources, push, groups, "records");
  w.wavefront.stream().run();
  build_octree(w.wavefront);
  took(BuildStep::radius, timer.milliseconds());
}

void Cache::Impl::set_radii(const Work& w, By by) {
  const uint32_t count = until - evaluated;
  if (count == 0) return;
  StageTimer timer(w.wavefront);
  bind(resources);
  const uint32_t groups = gpu::groups_for(count, 64);
  if (by == By::light) {
    const EllipsePush push{evaluated,
                           count,
                           k_hessian_reach * options.error * std::sqrt(w.view.scene_radius),
                           least.most,
                           dark(records.pilot_luminances(), until),
                           options.nearest,
                           tried_near(),
                           crowd()};
    w.wavefront.stream().dispatch(ellipse, resources, push, groups, "records");
  } else {
    const RadiusPush push{evaluated, count, options.error, least.most, tried_near(), crowd()};
    w.wavefront.stream().dispatch(radius, resources, push, groups, "records");
  }
  w.wavefront.stream().run();
  took(BuildStep::radius, timer.milliseconds());
}

void Cache::Impl::clamp_radii(const Work& w, uint32_t count, float near) {
  const auto index_first = [&](uint32_t n) {
    StageTimer timer(w.wavefront);
    build_octree(w.wavefront, n);
    took(BuildStep::octree, timer.milliseconds());
  };
  if (count > evaluated) index_first(count);
  StageTimer timer(w.wavefront);
  clamping.clamp(
      w.wavefront.stream(), [&](gpu::Resources& to) { bind(to); }, count, near, crowd(), evaluated);
  took(BuildStep::radius, timer.milliseconds());
  index_first(evaluated);
}

void Cache::Impl::leave_crowded() {
  if (!options.gather) return;
  const std::vector<bool> crowded = records.crowded();
  std::erase_if(list, [&](uint32_t record) { return crowded[record]; });
}

void Cache::Impl::drop_roomy(const Work& w) {
  // Twice as much room as they need, so that they are not tried again with every move of the camera.
  constexpr float k_roomy = 2;
  if (!options.gather || complete() == 0) return;
  RawRecords raw = records.raw(complete());
  std::vector<uint32_t> kept;
  for (uint32_t r = 0; r < raw.size(); ++r) {
    const vec4* const texels = &raw.places[size_t{r} * k_record_texels];
    const float needed = k_roomy * least.at(vec3(texels[0])), lesser_radius = texels[3].w,
                nearest = texels[2].y;
    if (!raw.crowded(r) || lesser_radius < needed || options.nearest * nearest < k_crowds * needed)
      kept.push_back(r);
  }
  if (kept.size() == raw.size()) return;
  raw.keep(kept);
  const uint64_t published = status.published;
  take(raw);
  status.published = published + 1;
  build_octree(w.wavefront);
  tell();
}

void Cache::Impl::list_until(uint32_t end) {
  until = end;
  list.resize(until - evaluated);
  std::iota(list.begin(), list.end(), evaluated);
  at = 0;
}

void Cache::Impl::finish(StopReason reason) {
  stage = Stage::done;
  status.stop = reason;
  pauses.complete();
  status.waits = false;
  if (!status.passes.empty()) pass().complete = true;
  tell();
}

void Cache::Impl::spent(size_t done, uint32_t rays) {
  pass().rays += uint64_t(done) * rays;
  status.rays += uint64_t(done) * rays;
}

}  // namespace lucerna::irradiance_cache
