#include "solvers/irradiance_cache/relight_preview.h"

#include <algorithm>
#include <utility>

#include "scene/light_factor.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr uint64_t k_light_bytes = uint64_t{k_part_count} * k_part_texels * 16;

}  // namespace

void RelightPreview::make_room(uint32_t count) {
  if (!kernel_)
    kernel_ =
        gpu::Kernel(device_, compiler_, "irradiance_cache/relight_preview.comp", group_defines(groups_));
  if (!change_) change_.emplace(device_, compiler_);
  change_->make_room(count);
  if (!frame_)
    frame_ = gpu::Buffer(device_, {.name = "cache frame of a preview", .bytes = sizeof(CacheFrame)});
  if (records_ && records_->capacity() >= count) return;
  const uint32_t room = std::min(count + count / 4 + 64, Records::most_records(device_));
  records_.reset(), octree_.reset();
  records_ = std::make_unique<Records>(device_, room, groups_);
  octree_ = std::make_unique<lookup::Octree>(device_, compiler_, LookupTables::octree_options(room));
  old_ =
      gpu::Buffer(device_, {.name = "cache irradiance before", .bytes = room * k_light_bytes, .texel = true});
  if (groups_ > 1)
    old_shares_ = gpu::Buffer(
        device_,
        {.name = "cache shares of groups before", .bytes = room * records_->group_bytes(), .texel = true});
  if (groups_ > 1)
    group_factors_ =
        gpu::Buffer(device_, {.name = "cache factors of groups", .bytes = groups_ * sizeof(vec4)});
}

void RelightPreview::begin(const LookupTables& tables, uint32_t count,
                           const std::optional<std::vector<vec3>>& factors, uint32_t sky_group) {
  if (count == 0) return end();
  const bool anew = !active() || count != count_;
  const std::optional<vec3> common = factors ? scene::common_factor(*factors) : std::nullopt;
  const bool told = common || (factors && factors->size() == groups_);
  known_ = told && (anew || known_);
  if (anew) {
    make_room(count);
    const RawRecords raw = tables.records.raw(count);
    records_->restore(raw);
    indexed_ = false;
    std::fill(factors_.begin(), factors_.end(), vec3(1));
    // Those that bring no light because paths gather there keep telling where it came from.
    std::vector<uint32_t> lit;
    for (uint32_t r = 0; r < count; ++r)
      if (!raw.crowded(r)) lit.push_back(r);
    const std::vector<uint32_t> ordered = by_place(std::move(lit), raw.spheres);
    change_->set(ordered, ray_noise(*records_));
    std::vector<uint32_t> leading, others;
    for (size_t i = 0; i < ordered.size(); ++i)
      (i % k_light_leading == 0 ? leading : others).push_back(ordered[i]);
    leading_ = leading.size();
    leading.insert(leading.end(), others.begin(), others.end());
    queue_.set(std::move(leading));
  }
  queue_.rewind();
  count_ = count;
  for (size_t g = 0; told && g < factors_.size(); ++g) factors_[g] *= common ? *common : (*factors)[g];
  sky_group_ = sky_group;
  begun_ = true;
  round_ = known_ ? k_rounds.size() : 0, rays_ = 0;
}

void RelightPreview::make_ready(gpu::Stream& stream) {
  if (!std::exchange(indexed_, true)) {
    const lookup::Discs discs = LookupTables::discs(*records_);
    octree_->build(stream, records_->spheres(), {.most = count_}, &discs);
  }
  if (!std::exchange(begun_, false)) return;
  keep_as_old(stream, *records_, Records::Use::look_up, count_);
  mix(stream, ~0u, 0, false);
  keep_as_old(stream, *records_, Records::Use::look_up, count_);
  stream.run();
  std::fill(factors_.begin(), factors_.end(), vec3(1));
}

void RelightPreview::keep_as_old(gpu::Stream& stream, const Records& records, Records::Use use,
                                 uint32_t count) {
  stream.copy(records.light(use), old_, count * k_light_bytes);
  if (groups_ > 1) stream.copy(records.shares(use), old_shares_, count * records.group_bytes());
}

bool RelightPreview::step(transport::Wavefront& wavefront, const paths::Automaton& automaton,
                          const LookupTables& tables, Evaluator& evaluator, const RecordLight& light,
                          uint32_t seed, const std::function<bool()>& cancel) {
  if (complete()) return true;
  const uint32_t elevations = k_rounds[round_], cells = 4 * elevations * elevations;
  const size_t most = std::max(1u, wavefront.slots() / cells);
  const bool first = round_ == 0 && queue_.done_count() < leading_;
  const std::span<const uint32_t> batch =
      queue_.next(first ? std::min(most, leading_ - queue_.done_count()) : most);
  look_up(wavefront, tables, tables.record_routes, true);
  const size_t done = evaluator.evaluate(wavefront, automaton, *records_, batch,
                                         {.elevations = elevations,
                                          .azimuths = 4 * elevations,
                                          .rays_before = rays_,
                                          .parts = light.parts,
                                          .elsewhere = light.elsewhere,
                                          .seed = seed},
                                         cancel);
  look_up(wavefront, tables, tables.picture_routes, false);
  queue_.advance(done);
  if (done < batch.size()) return false;
  if (!queue_.done()) {
    if (!first || queue_.done_count() < leading_) return true;
    mix(wavefront.stream(), light.parts, cells, true);
  } else {
    queue_.rewind();
    rays_ += cells;
    ++round_;
    mix(wavefront.stream(), light.parts, rays_, false);
  }
  ++published_;
  return true;
}

void RelightPreview::mix(gpu::Stream& stream, uint32_t parts, uint32_t rays, bool leading) {
  records_->bind(resources_, Records::Use::gather);
  resources_.set("old_texels", old_);
  if (groups_ > 1) {
    resources_.set("old_group_texels", old_shares_);
    resources_.set("ShownGroups", records_->shares(Records::Use::look_up));
    std::vector<vec4> factors;
    for (const vec3& f : factors_) factors.emplace_back(f, 0);
    group_factors_.write(std::span<const vec4>(factors));
    resources_.set("GroupFactors", group_factors_);
  }
  const vec3 factor = groups_ > 1 ? vec3(1) : factors_[0];
  resources_.set("Shown", records_->light(Records::Use::look_up));
  change_->measure(stream, resources_, factor, parts, rays, leading);
  stream.dispatch(kernel_, resources_,
                  RelightPreviewPush{factor, count_, parts, rays, change_->clusters(), leading, sky_group_},
                  gpu::groups_for(count_, 64));
  stream.run();
  stream.take_times();
}

void RelightPreview::take(gpu::Stream& stream, const LookupTables& tables, uint32_t count) {
  if (!active()) return;
  count = std::min(count, count_);
  if (count == 0) return;
  make_ready(stream);
  constexpr auto k_gathered = Records::Use::gather, k_shown = Records::Use::look_up;
  stream.copy(tables.records.light(k_gathered), records_->light(k_shown), count * k_light_bytes);
  if (groups_ > 1)
    stream.copy(tables.records.shares(k_gathered), records_->shares(k_shown),
                count * records_->group_bytes());
  keep_as_old(stream, tables.records, k_gathered, count);
  stream.run();
}

void RelightPreview::look_up(transport::Wavefront& wavefront, const LookupTables& tables,
                             const RouteTable& routes, bool on) {
  looked_up_ = on && active();
  if (looked_up_) {
    make_ready(wavefront.stream());
    const CacheFrame frame = tables.frame_for(count_, k_probe_none, routes);
    frame_.write(&frame, sizeof frame);
  }
  wavefront.rebind_lookup();
}

void RelightPreview::bind(gpu::Resources& to) const {
  records_->bind(to, Records::Use::look_up);
  to.set("CacheBlock", frame_);
  octree_->bind(to);
}

uint64_t RelightPreview::bytes() const {
  if (!records_) return 0;
  return records_->bytes() + octree_->bytes() + old_.bytes() + change_->bytes() +
         (groups_ > 1 ? old_shares_.bytes() : 0);
}

}  // namespace lucerna::irradiance_cache
