// Records that outlive a change: relit where they are, or taken over by a cache made for other lookups.
#include <algorithm>
#include <bit>

#include "solvers/irradiance_cache/build.h"

namespace lucerna::irradiance_cache {

using namespace shared;

void Cache::Impl::take(const RawRecords& raw) {
  records.restore(raw);
  evaluated = standing = until = status.records = raw.size();
  // Passes end where the number of the next record's is another.
  const auto pass_of = [&](uint32_t r) {
    return std::bit_cast<uint32_t>(raw.places[size_t{r} * k_record_texels + 2].w) & k_record_pass;
  };
  ends.clear();
  for (uint32_t r = 1; r <= raw.size(); ++r)
    if (r == raw.size() || pass_of(r) != pass_of(r - 1)) ends.push_back(r);
}

void Cache::Impl::relight() {
  if (status.relighting == 0) {
    stopped = status.stop == StopReason::dark ? StopReason::building : status.stop;
    // A pass that has its first level has places and radii, and is complete when it is relit. Of one before
    // that nothing is left; its places are asked for again.
    if (evaluated > complete()) ends.push_back(evaluated), ++status.pass;
  }
  standing = complete();
  drop_pass();
  filling = false;
  pauses.dropped();
  status.waits = false;
  evaluated = 0;
  hold();
  status.stop = StopReason::building;
  status.records = 0, status.relighting = standing, status.relit = 0, status.rays = 0;
  status.passes.clear();
  tell();
  relight_pass();
}

void Cache::Impl::relight_pass() {
  if (evaluated < standing) {
    const uint32_t end = *std::upper_bound(ends.begin(), ends.end(), evaluated);
    if (!status.passes.empty() && status.passes.back().relit && status.passes.back().rays == 0)
      status.passes.pop_back();  // that one waited in the dark
    status.passes.push_back(
        {.number = records.read(evaluated).pass, .relit = true, .records = end - evaluated});
    list_until(end);
    ms_before = 0, rays_at_end = 0;
    level = level_done = rays_before = 0;
    // Ellipses are by the light, which is another.
    stage = by_light() ? Stage::measure : Stage::evaluate;
    return;
  }
  status.relighting = 0;
  if (stopped == StopReason::building) return next_pass();
  if (!by_light()) return finish(stopped);
  // Ellipses are by the light: where they no longer reach is asked for as if it had come into view. Not
  // beyond the picture's lookups: the gaps that building has left there cost time, not accuracy, and would be
  // filled a little more with every change of the light.
  count_anew(false);
  next_pass();
}

void Cache::relight() { impl_->relight(); }

solvers::Spoils Cache::adopt(transport::Wavefront& wavefront, const Cache& other) {
  Impl& c = *impl_;
  const Impl& o = *other.impl_;
  clear();
  const uint32_t count = o.complete();
  if (count > c.records.capacity()) return solvers::k_spoils_all;
  c.take(o.records.raw(count));
  c.ends = o.ends;
  c.held = o.held, c.held_recursive = o.held_recursive;
  const uint64_t bytes = c.status.bytes, published = c.status.published;
  c.status = o.status;
  c.status.bytes = bytes, c.status.published = published + 1;
  c.status.records = count, c.status.relighting = 0;
  if (!c.status.passes.empty() && !c.status.passes.back().complete) c.status.passes.pop_back();
  if (count > 0) c.build_octree(wavefront);
  c.set_scales();
  c.tell();
  const bool relit = o.status.relighting > 0;  // and some are not yet
  const StopReason stop = relit ? o.stopped : o.status.stop;
  if (stop != StopReason::building) c.finish(stop);
  solvers::Spoils lacks;
  const uint32_t tertiary = 1u << k_part_tertiary;
  lacks.light =
      relit || (c.parts & ~c.held) != 0 || (c.recursive != c.held_recursive && (c.parts & tertiary) != 0);
  // Paths that gather ask for no records.
  for (size_t s = 0; s < k_gather_state; ++s)
    lacks.coverage |= c.routes[s] != k_no_routes && o.routes[s] == k_no_routes;
  return lacks;
}

}  // namespace lucerna::irradiance_cache
