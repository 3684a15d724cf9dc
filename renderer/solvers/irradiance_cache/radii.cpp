#include "solvers/irradiance_cache/radii.h"

#include <cmath>

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr const char* k_shaping = "records";
/// Metric `hessian`: scale of `error`, so that it makes about as many records as the split-sphere metric.
constexpr float k_hessian_reach = 0.5f;
/// Metric `hessian`: bound over the nearest distance, for tried places. The first level has more rays, which
/// hit nearer geometry.
constexpr float k_tried_near = 0.8f;

}  // namespace

Radii::Radii(gpu::Device& device, gpu::ShaderCompiler& compiler, const RadiusOptions& options,
             uint32_t most_records, const gpu::Defines& defines)
    : options_(options),
      distance_(device, compiler, "irradiance_cache/radius.comp"),
      clamping_(device, compiler, most_records, defines) {
  if (!by_light()) return;
  ellipse_ = gpu::Kernel(device, compiler, "irradiance_cache/ellipse.comp");
  pooling_ = gpu::Kernel(device, compiler, "irradiance_cache/pool.comp", defines);
  pool_keep_ = gpu::Kernel(device, compiler, "irradiance_cache/pool_keep.comp");
  pooled_ = gpu::Buffer(
      device, {.name = "pooled pilots", .bytes = uint64_t{most_records} * sizeof(vec4), .texel = true});
}

float Radii::tried_near() const { return options_.nearest * (by_light() ? k_tried_near : 1); }

void Radii::pool(gpu::Stream& stream, const Bind& bind, uint32_t first, uint32_t count) {
  bind(resources_);
  resources_.set("Pooled", pooled_);
  resources_.set("pooled_texels", pooled_);
  const PoolPush push{first, count};
  const uint32_t groups = gpu::groups_for(count, 64);
  stream.dispatch(pooling_, resources_, push, groups, k_shaping);
  stream.dispatch(pool_keep_, resources_, push, groups, k_shaping);
  stream.run();
}

void Radii::set_by_distance(gpu::Stream& stream, const Bind& bind, const Wanted& wanted) {
  bind(resources_);
  const RadiusPush push{wanted.first, wanted.count, options_.error, wanted.most, tried_near(), wanted.crowd};
  stream.dispatch(distance_, resources_, push, gpu::groups_for(wanted.count, 64), k_shaping);
  stream.run();
}

void Radii::set_by_light(gpu::Stream& stream, const Bind& bind, const Wanted& wanted, float scene_radius,
                         float dark) {
  bind(resources_);
  const EllipsePush push{
      wanted.first, wanted.count, k_hessian_reach * options_.error * std::sqrt(scene_radius),
      wanted.most,  dark,         options_.nearest,
      tried_near(), wanted.crowd};
  stream.dispatch(ellipse_, resources_, push, gpu::groups_for(wanted.count, 64), k_shaping);
  stream.run();
}

void Radii::clamp(gpu::Stream& stream, const Bind& bind, uint32_t count, float near, float crowd,
                  uint32_t undecided) {
  clamping_.clamp(stream, bind, count, near, crowd, undecided);
}

uint64_t Radii::bytes() const { return clamping_.bytes() + pooled_.bytes(); }

}  // namespace lucerna::irradiance_cache
