#pragma once
// How much the light of records has changed, told by the first rays of a relighting: pooled over clusters of
// records that lie together, and over all of them (shaders/irradiance_cache/light_change.glsl).
#include <vector>

#include "gpu/kernel.h"
#include "gpu/stream.h"
#include "solvers/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

/// Records in the order in which they lie together: by the Morton code of their places. `records`: indices of
/// `spheres` (position, radius).
std::vector<uint32_t> by_place(std::vector<uint32_t> records, const std::vector<vec4>& spheres);

/// Of each record, the variance of one ray over the square of its light, as all its rays tell.
std::vector<float> ray_noise(const Records& records);

class LightChange {
 public:
  LightChange(gpu::Device& device, gpu::ShaderCompiler& compiler);
  /// Room for so many records. Throws Error when memory is short.
  void make_room(uint32_t count);
  /// Those that tell, in the order of by_place(), and ray_noise() of all records. In make_room().
  void set(const std::vector<uint32_t>& ordered, const std::vector<float>& noise);
  uint32_t clusters() const;
  /// Sums over them, or over the leading ones alone (shared::k_light_leading). `resources` have
  /// record_texels, irradiance_texels and old_texels, and get what light_change.glsl reads. Recorded.
  void measure(gpu::Stream& stream, gpu::Resources& resources, const vec3& factor, uint32_t parts,
               uint32_t rays, bool leading) const;
  uint64_t bytes() const {
    return order_ ? order_.bytes() + places_.bytes() + noise_.bytes() + sums_.bytes() : 0;
  }

 private:
  gpu::Device& device_;
  gpu::Kernel kernel_;
  gpu::Buffer order_, places_, noise_, sums_;
  uint32_t ordered_ = 0;
};

}  // namespace lucerna::irradiance_cache
