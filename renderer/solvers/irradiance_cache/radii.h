#pragma once
// How far records serve, on the device: by how far things are, or by how light bends too; then held to what
// the records around know.
#include <functional>

#include "solvers/irradiance_cache/cache.h"
#include "solvers/irradiance_cache/clamping.h"

namespace lucerna::irradiance_cache {

/// All of it runs the stream. `bind` is what lookup.glsl reads.
class Radii {
 public:
  using Bind = std::function<void(gpu::Resources&)>;
  /// Records that get radii, and what of them is not by their own rays.
  struct Wanted {
    uint32_t first = 0, count = 0;
    float most = 0;  ///< [m]
    /// Where the nearest thing is nearer than that times the least radius, they crowd (records.h); 0:
    /// nowhere.
    float crowd = 0;
  };

  /// `options` must outlive it. `defines`: Cache::defines().
  Radii(gpu::Device& device, gpu::ShaderCompiler& compiler, const RadiusOptions& options,
        uint32_t most_records, const gpu::Defines& defines);
  /// Whether radii are by the light, of which pilot rays tell.
  bool by_light() const { return options_.metric == Metric::hessian; }
  /// Greatest radius, of ellipses the lesser, over the distance of the nearest thing: of what is only tried.
  float tried_near() const;

  /// What pilots of these records tell is pooled with what those around them do; all are in the octree. Only
  /// where radii are by the light.
  void pool(gpu::Stream& stream, const Bind& bind, uint32_t first, uint32_t count);
  void set_by_distance(gpu::Stream& stream, const Bind& bind, const Wanted& wanted);
  /// `dark`: as dark_luminance() has it, of what pilots tell.
  void set_by_light(gpu::Stream& stream, const Bind& bind, const Wanted& wanted, float scene_radius,
                    float dark);
  /// As Clamping::clamp().
  void clamp(gpu::Stream& stream, const Bind& bind, uint32_t count, float near, float crowd,
             uint32_t undecided);
  uint64_t bytes() const;  ///< of device memory

 private:
  const RadiusOptions& options_;
  gpu::Kernel distance_, ellipse_, pooling_, pool_keep_;  // the last three only where radii are by the light
  gpu::Buffer pooled_;                                    // the same
  gpu::Resources resources_;
  Clamping clamping_;
};

}  // namespace lucerna::irradiance_cache
