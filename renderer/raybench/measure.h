#pragma once
// Measurements: rays a second of every tracer on the same rays, and seconds of a path-traced frame.
#include <memory>

#include "gpu/kernel.h"
#include "raybench/rays.h"
#include "transport/wavefront.h"

namespace lucerna::raybench {

/// Traces a set; returns the time in seconds.
struct Tracer {
  std::string name;
  std::function<double(const RaySet&, std::span<shared::Hit>)> trace;
};

/// The kernels of shaders/trace.comp on a device, with the scene's tree uploaded. Time is that of submit to
/// finish, rays already on the device. `defines`: variants of lib/bvh.glsl.
class ComputeTracer {
 public:
  ComputeTracer(gpu::Device& device, gpu::ShaderCompiler& compiler, const bvh::BvhData& tree,
                const gpu::Defines& defines = {});
  ~ComputeTracer();
  double trace(const RaySet& set, std::span<shared::Hit> hits);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct Rate {
  double median = 0, low = 0, high = 0;  ///< million rays a second
};
/// rates[tracer][set]. Tracers take turns, `repeats` times, after one round that is not counted.
std::vector<std::vector<Rate>> measure(std::span<const Tracer> tracers, std::span<const RaySet> sets,
                                       int repeats);

/// Rays of a set for which two tracers disagree: on hit or miss, or (closest queries) on the primitive.
uint64_t count_differences(const Tracer& a, const Tracer& b, const RaySet& set);

struct FrameOptions {
  uint32_t width = 480, height = 270, samples = 16, seed = 1, slots = 131072;
};
struct FrameTime {
  double seconds = 0;  ///< rendering alone: kernels warm
  uint64_t rays = 0;
  std::vector<transport::StageSum> stages;
};
/// Path-traces a frame with all components on, as `lucerna render` does. `host_trace` empty: compute-bvh.
class PathTracedFrame {
 public:
  PathTracedFrame(gpu::Device& device, gpu::ShaderCompiler& compiler, const FlatFile& scene,
                  const FrameOptions& options, const transport::HostTrace& host_trace);
  ~PathTracedFrame();
  FrameTime run();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The median of `repeats` runs of each, by seconds; they take turns.
std::vector<FrameTime> measure(std::span<PathTracedFrame* const> frames, int repeats);

}  // namespace lucerna::raybench
