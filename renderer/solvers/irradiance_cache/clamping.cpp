#include "solvers/irradiance_cache/clamping.h"

#include <algorithm>

#include "shaders/shared/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr const char* k_clamping = "clamping";

}  // namespace

Clamping::Clamping(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t capacity,
                   const gpu::Defines& defines)
    : finding_(device, compiler, "irradiance_cache/clamp_find.comp", defines),
      shrinking_(device, compiler, "irradiance_cache/clamp_radius.comp"),
      bounds_(device,
              {.name = "bounds of radii", .bytes = uint64_t{capacity} * 4, .memory = gpu::Memory::host}) {
  std::fill_n(static_cast<uint32_t*>(bounds_.mapped()), capacity, k_no_bound);
}

void Clamping::clamp(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind, uint32_t count,
                     float near, float crowd, uint32_t undecided) {
  if (count == 0) return;
  bind(resources_);
  resources_.set("Bounds", bounds_);
  const ClampPush push{count, near, crowd, undecided};
  stream.dispatch(finding_, resources_, push, gpu::groups_for(count, 64), k_clamping);
  stream.dispatch(shrinking_, resources_, push, gpu::groups_for(count, 64), k_clamping);
  stream.run();
}

}  // namespace lucerna::irradiance_cache
