#pragma once
// Rays of one record miss narrow things near it that those of another meet, and it would serve across them.
// Here records tell each other (J. Krivanek et al., "Making Radiance and Irradiance Caching Practical:
// Adaptive Caching and Neighbor Clamping", 2006).
#include <functional>

#include "gpu/kernel.h"
#include "gpu/stream.h"

namespace lucerna::irradiance_cache {

class Clamping {
 public:
  /// Room for `capacity` records. `defines`: Cache::defines().
  Clamping(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t capacity,
           const gpu::Defines& defines);
  /// Where record i would serve at record j's place (or is j), nothing that any ray of j met is farther from
  /// i than d_j + |x_i - x_j|: shrinks the lesser radius of i to `near` times that, never below the least
  /// (shared::CacheFrame); of ellipses both radii in proportion. `bind`: what lookup.glsl reads, with `count`
  /// records in the octree. Those from `undecided` on that are to be less than `crowd` of the least crowd
  /// (shared::k_record_crowded). On the device; the stream is run.
  void clamp(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind, uint32_t count,
             float near, float crowd = 0, uint32_t undecided = 0);
  uint64_t bytes() const { return bounds_.bytes(); }

 private:
  gpu::Kernel finding_, shrinking_;
  gpu::Buffer bounds_;  // of lesser radii; between two calls none
  gpu::Resources resources_;
};

}  // namespace lucerna::irradiance_cache
