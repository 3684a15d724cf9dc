#pragma once
// Records of one batch do not know each other when they are placed, and reach too far: into what others know
// better, and listed wherever nobody needs them. Here each radius is bounded by the nearest records in
// different directions.
#include <functional>
#include <memory>

#include "gpu/stream.h"
#include "solvers/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

class Neighbours {
 public:
  /// `defines`: Cache::defines().
  Neighbours(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines);
  ~Neighbours();
  /// Shrinks the radii of the first `count` records where records stand all around, never below the least
  /// (shared::CacheFrame); of ellipses both in proportion. `bind`: what lookup.glsl reads, with these records
  /// in the octree. On the device; the stream is run.
  void bound(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind, uint32_t count);
  uint64_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
