#pragma once
// Neighbour clamping: rays of one record miss narrow geometry that a neighbour's rays hit, and it would serve
// across it. Records share their nearest distances (J. Krivanek et al., "Making Radiance and Irradiance
// Caching Practical: Adaptive Caching and Neighbor Clamping", 2006).
#include <functional>

#include "gpu/kernel.h"
#include "gpu/stream.h"

namespace lucerna::irradiance_cache {

class Clamping {
 public:
  /// Room for `capacity` records. `defines`: Cache::defines().
  Clamping(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t capacity,
           const gpu::Defines& defines);
  /// For every record i that would serve at record j's place: geometry that a ray of j hit is at most d_j +
  /// |x_i - x_j| away from i. Shrinks the minor radius of i to `near` times that, but not below the minimum
  /// (shared::CacheFrame); both radii of an ellipse shrink in proportion. `bind`: binds lookup.glsl, with
  /// `count` records in the octree. Records from `undecided` on whose radius would be less than `crowd` times
  /// the minimum become crowded (shared::k_record_crowded). Runs the stream.
  void clamp(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind, uint32_t count,
             float near, float crowd = 0, uint32_t undecided = 0);
  uint64_t bytes() const { return bounds_.bytes(); }

 private:
  gpu::Kernel finding_, shrinking_;
  gpu::Buffer bounds_;  // of minor radii; reset between two calls
  gpu::Resources resources_;
};

}  // namespace lucerna::irradiance_cache
