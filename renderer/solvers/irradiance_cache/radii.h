#pragma once
// Radii of validity of records, on the device: from distances, or from the curvature of light too; then
// clamped by the neighbours' distances.
#include <functional>

#include "solvers/irradiance_cache/cache.h"
#include "solvers/irradiance_cache/clamping.h"

namespace lucerna::irradiance_cache {

/// All functions run the stream. `bind` binds lookup.glsl.
class Radii {
 public:
  using Bind = std::function<void(gpu::Resources&)>;
  /// Records to process, and bounds that do not come from their own rays.
  struct Wanted {
    uint32_t first = 0, count = 0;
    float most = 0;  ///< [m]
    /// Records become crowded (records.h) if geometry is nearer than this times the minimum radius; 0: never.
    float crowd = 0;
  };

  /// `options` must outlive it. `defines`: Cache::defines().
  Radii(gpu::Device& device, gpu::ShaderCompiler& compiler, const RadiusOptions& options,
        uint32_t most_records, const gpu::Defines& defines);
  /// True if radii depend on light, measured by pilot rays.
  bool by_light() const { return options_.metric == Metric::hessian; }
  /// Upper bound of the (minor) radius over the nearest distance, for places that are only tried.
  float tried_near() const;

  /// Averages the pilot results of these records with their neighbours'; all must be in the octree. Only if
  /// radii depend on light.
  void pool(gpu::Stream& stream, const Bind& bind, uint32_t first, uint32_t count);
  void set_by_distance(gpu::Stream& stream, const Bind& bind, const Wanted& wanted);
  /// `dark`: as dark_luminance(), from pilot results.
  void set_by_light(gpu::Stream& stream, const Bind& bind, const Wanted& wanted, float scene_radius,
                    float dark);
  /// Like Clamping::clamp().
  void clamp(gpu::Stream& stream, const Bind& bind, uint32_t count, float near, float crowd,
             uint32_t undecided);
  uint64_t bytes() const;  ///< of device memory

 private:
  const RadiusOptions& options_;
  gpu::Kernel distance_, ellipse_, pooling_, pool_keep_;  // the last three only if radii depend on light
  gpu::Buffer pooled_;                                    // likewise
  gpu::Resources resources_;
  Clamping clamping_;
};

}  // namespace lucerna::irradiance_cache
