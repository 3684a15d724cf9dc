// Records that survive a change: relit in place, or adopted by a cache made for other lookups.
#include <algorithm>
#include <bit>
#include <utility>

#include "solvers/irradiance_cache/build.h"

namespace lucerna::irradiance_cache {

using namespace shared;

void Cache::Impl::replace_records(const RawRecords& raw) {
  tables.records.restore(raw);
  // A pass ends where the next record has another number.
  const auto pass_of = [&](uint32_t r) {
    return std::bit_cast<uint32_t>(raw.places[size_t{r} * k_record_texels + 2].w) & k_record_pass;
  };
  std::vector<uint32_t> ends;
  for (uint32_t r = 1; r <= raw.size(); ++r)
    if (r == raw.size() || pass_of(r) != pass_of(r - 1)) ends.push_back(r);
  ranges.restore(std::move(ends));
  status.records = raw.size();
}

namespace {

/// Share of its radius that a record may lose before it is dropped.
constexpr float k_lost_radius = 0.2f;

/// True if an object in the box determines or would determine the radius of a record there: as the nearest
/// geometry, or by the mean of 1 / r over the hemisphere, 1 / `mean_distance`. At a distance d, its bounding
/// sphere covers at most (radius / d)^2 of the cosine-weighted hemisphere, and so adds at most (radius / d)^2
/// / d.
bool limits(const Box& box, const vec3& position, float validity, float mean_distance,
            const RadiusOptions& options) {
  if (box.empty()) return false;
  const float d = glm::distance(position, glm::clamp(position, box.lo, box.hi));
  if (options.nearest * d <= validity) return true;
  if (options.metric != Metric::split_sphere) return false;  // relighting measures the ellipse again
  // A radius at its minimum is beyond that of the distances.
  const float kept = (1 - k_lost_radius) * std::min(validity, options.error * mean_distance);
  const float seen = box.radius() / d;
  return options.error < kept * (1 / mean_distance + std::min(1.0f, seen * seen) / d);
}

}  // namespace

void Cache::Impl::drop_near(std::span<const Box> moved) {
  if (status.relighting.records == 0 && ranges.complete_pass()) ++status.pass;
  RawRecords raw = tables.records.raw(ranges.complete());
  std::vector<uint32_t> kept;
  for (uint32_t r = 0; r < raw.size(); ++r) {
    const vec4* const texels = &raw.places[size_t{r} * k_record_texels];
    if (std::none_of(moved.begin(), moved.end(), [&](const Box& box) {
          return limits(box, vec3(texels[0]), raw.spheres[r].w, texels[1].w, options.radius);
        }))
      kept.push_back(r);
  }
  if (kept.empty()) return clear();
  forget_refining();
  drop_pass();
  if (kept.size() == raw.size()) return;
  raw.keep(kept);
  replace_records(raw);
}

void Cache::drop_near(std::span<const Box> moved) { impl_->drop_near(moved); }

bool Cache::Impl::relight_first_places() {
  if (ranges.placed() > 0 || status.relighting.records > 0 || progress.stage == Stage::done) return false;
  if (progress.stage >= Stage::measure && radii.by_light()) {
    // The choice among the tried places depends on the light, too.
    tables.records.truncate(0);
    tables.records.append(places.tried, status.pass);
    progress.stage = Stage::measure;
    queue_until(tables.records.size());
  } else if (progress.stage >= Stage::evaluate) {
    progress.stage = Stage::evaluate;
    progress.levels.restart();
    queue_until(tables.records.size());
  }
  progress.pauses.dropped();
  status.waits = false;
  return true;
}

void Cache::Impl::relight(const std::optional<std::vector<vec3>>& factors, uint32_t sky_group) {
  if (relight_first_places()) return;
  forget_refining();
  if (status.relighting.records == 0) {
    progress.stopped_before = status.stop == StopReason::dark ? StopReason::building : status.stop;
    // A pass with a first level has places and radii; relighting completes it. Without a first level it is
    // dropped, and its places become candidates again.
    if (ranges.complete_pass()) ++status.pass;
  }
  ranges.keep_complete();
  // For records still being relit, the light before is known only from a preview.
  if (previews && preview.known(factors) && (preview.active() || status.relighting.records == 0))
    preview.begin(tables, ranges.placed(), *factors, sky_group);
  else
    preview.end();
  drop_pass();
  progress.probing.filling = false;
  progress.pauses.dropped();
  status.waits = false;
  ranges.lose_light();
  held = gathers;
  status.stop = StopReason::building;
  // If relit again before completion, they have not had all their rays.
  const uint64_t rays = std::max(status.relighting.records > 0 ? status.relighting.rays : 0, status.rays);
  status.records = 0, status.relighting = {.records = ranges.placed(), .share = 0, .rays = rays},
  status.rays = 0;
  status.passes.clear();
  write_frame();
  relight_pass();
}

void Cache::Impl::relight_pass() {
  if (ranges.evaluated() < ranges.placed()) {
    const uint32_t begin = ranges.evaluated(), end = ranges.next_end();
    if (!status.passes.empty() && status.passes.back().relit && status.passes.back().rays == 0)
      status.passes.pop_back();  // that one has waited without light
    status.passes.push_back(
        {.number = tables.records.read(begin).pass, .relit = true, .records = end - begin});
    queue_until(end);
    progress.clock.restart();
    progress.levels.restart();
    // Ellipses depend on the light, which has changed.
    progress.stage = radii.by_light() ? Stage::measure : Stage::evaluate;
    return;
  }
  status.relighting.records = 0;
  preview.end();
  if (progress.stopped_before == StopReason::building) return next_pass();
  if (!radii.by_light()) return finish(progress.stopped_before);
  // Ellipses depend on the light: gaps between them become candidates, as after a camera move. Not beyond the
  // picture's lookups: gaps there cost time, not accuracy, and each change of the light would add records.
  restart_passes(false);
  next_pass();
}

void Cache::relight(const std::optional<std::vector<vec3>>& factors, uint32_t sky_group) {
  impl_->relight(factors, sky_group);
}

void Cache::preview_relighting(bool on) {
  Impl& c = *impl_;
  c.previews = on;
  if (!on) c.preview.end();
  if (on && ready()) c.preview.make_room(c.ranges.placed());
}

bool Cache::previews_relighting() const { return impl_->preview.active(); }

void Cache::look_up_preview(transport::Wavefront& wavefront, bool on) {
  Impl& c = *impl_;
  if (c.preview.active()) c.preview.look_up(wavefront, c.tables, on);
}

solvers::Invalidation Cache::adopt(transport::Wavefront& wavefront, const Cache& other) {
  Impl& c = *impl_;
  const Impl& o = *other.impl_;
  clear();
  const uint32_t count = o.ranges.complete();
  if (count > c.tables.records.capacity()) return solvers::k_invalidates_all;
  c.tables.records.restore(o.tables.records.raw(count));
  c.ranges.restore(o.ranges.complete_ends());
  c.held = o.held;
  const uint64_t bytes = c.status.bytes;
  c.status = o.status;
  c.status.bytes = bytes, c.status.records = count, c.status.relighting.records = 0;
  if (!c.status.passes.empty() && !c.status.passes.back().complete) c.status.passes.pop_back();
  if (count > 0) c.build_octree(wavefront, count, IndexFor::picture);
  c.overlay.set_scales(c.tables.records.figures());
  c.write_frame();
  const bool relit = o.status.relighting.records > 0;  // and some are not yet relit
  const StopReason stop = relit ? o.progress.stopped_before : o.status.stop;
  if (stop != StopReason::building) c.finish(stop);
  solvers::Invalidation lacks;
  const uint32_t tertiary = 1u << k_part_tertiary;
  lacks.light = relit || (c.gathers.parts & ~c.held.parts) != 0 ||
                ((c.gathers.recursive != c.held.recursive || c.gathers.elsewhere != c.held.elsewhere) &&
                 (c.gathers.parts & tertiary) != 0);
  // Gathering paths make no candidates.
  for (size_t s = 0; s < k_phase_states; ++s)
    lacks.coverage |= c.tables.picture_routes[s] != k_no_routes && o.tables.picture_routes[s] == k_no_routes;
  return lacks;
}

}  // namespace lucerna::irradiance_cache
