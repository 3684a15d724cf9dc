#pragma once
// Records of one batch do not know each other when they are placed, and reach too far: into what others know
// better, and listed wherever nobody needs them. Here each radius is bounded by the nearest records in
// different directions (METHODS 3.3).
#include <functional>
#include <memory>

#include "gpu/stream.h"
#include "solvers/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

class Neighbours {
 public:
  struct Options {
    uint32_t first = 0, count = 0;     ///< records; those from `first` on are bounded
    float least_pixels = 0, most = 0;  ///< shared::RadiusPush
  };

  /// `defines`: Cache::defines().
  Neighbours(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines);
  ~Neighbours();
  /// Shrinks radii where records stand all around, never below least_pixels as the camera sees them; of
  /// ellipses both in proportion. `bind`: the frame, and the records in an octree with the radii that they
  /// have. On the device; the stream is run.
  void bound(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind, const Options& options);
  uint64_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
