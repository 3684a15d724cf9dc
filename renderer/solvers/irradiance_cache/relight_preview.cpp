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
        {.name = "cache group shares before", .bytes = room * records_->group_bytes(), .texel = true});
  if (groups_ > 1)
    group_factors_ = gpu::Buffer(device_, {.name = "cache group factors", .bytes = groups_ * sizeof(vec4)});
}

bool RelightPreview::known(const std::optional<std::vector<vec3>>& factors) const {
  return factors && (scene::common_factor(*factors) || factors->size() == groups_);
}

void RelightPreview::begin(const LookupTables& tables, uint32_t count, const std::vector<vec3>& factors,
                           uint32_t sky_group) {
  if (count == 0) return end();
  if (!active() || count != count_) {
    make_room(count);
    octree_->set_core(tables.octree.core());
    records_->restore(tables.records.raw(count));
    indexed_ = false;
    std::fill(factors_.begin(), factors_.end(), vec3(1));
  }
  count_ = count;
  const std::optional<vec3> common = scene::common_factor(factors);
  for (size_t g = 0; g < factors_.size(); ++g) factors_[g] *= common ? *common : factors[g];
  sky_group_ = sky_group;
  begun_ = true;
}

void RelightPreview::make_ready(gpu::Stream& stream) {
  if (!std::exchange(indexed_, true)) {
    const lookup::Discs discs = LookupTables::discs(*records_);
    octree_->build(stream, records_->spheres(), {.most = count_}, &discs);
  }
  if (!std::exchange(begun_, false)) return;
  const gpu::Buffer& shown = records_->light(Records::Use::look_up);
  stream.copy(shown, old_, count_ * k_light_bytes);
  if (groups_ > 1)
    stream.copy(records_->shares(Records::Use::look_up), old_shares_, count_ * records_->group_bytes());
  resources_.set("old_texels", old_);
  resources_.set("Shown", shown);
  if (groups_ > 1) {
    resources_.set("old_group_texels", old_shares_);
    resources_.set("ShownGroups", records_->shares(Records::Use::look_up));
    std::vector<vec4> factors;
    for (const vec3& f : factors_) factors.emplace_back(f, 0);
    group_factors_.write(std::span<const vec4>(factors));
    resources_.set("GroupFactors", group_factors_);
  }
  stream.dispatch(kernel_, resources_,
                  RelightPreviewPush{groups_ > 1 ? vec3(1) : factors_[0], count_, sky_group_},
                  gpu::groups_for(count_, 64));
  stream.run();
  stream.take_times();
  std::fill(factors_.begin(), factors_.end(), vec3(1));
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
  stream.run();
}

void RelightPreview::look_up(transport::Wavefront& wavefront, const LookupTables& tables, bool on) {
  looked_up_ = on && active();
  if (looked_up_) {
    make_ready(wavefront.stream());
    const CacheFrame frame = tables.frame_for(count_, k_probe_none, tables.picture_routes);
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
  return records_->bytes() + octree_->bytes() + old_.bytes() + (groups_ > 1 ? old_shares_.bytes() : 0);
}

}  // namespace lucerna::irradiance_cache
