#pragma once
// Rounds of light paths, in batches of at most the wavefront's slots: starts them and traces them with the
// caller's kernel at their vertices. For photons and light tracing.
#include <functional>
#include <string>

#include "paths/light_paths.h"
#include "transport/light_source.h"
#include "transport/wavefront.h"

namespace lucerna::transport {

/// Parameters of a round for these kernels.
struct LightRound {
  uint32_t number = 0;   ///< its random numbers are determined by this number and the frame's seed
  uint32_t paths = 0;    ///< at most shared::k_most_light_paths
  uint32_t parts = 0;    ///< computed parts of light (bits, paths::k_part_count)
  uint32_t account = 0;  ///< component to which their time is accounted
};

/// Kernels for vertices (PathEnds::vertex) and for light of shadow rays (PathEnds::arrival).
struct LightVertexWork {
  const gpu::Kernel* vertex = nullptr;
  std::string stage;
  std::function<void(gpu::Resources&)> bind;
  const gpu::Kernel* arrival = nullptr;
};

class LightEmitter {
 public:
  /// `scene_defines`: those of kernels that use the scene. Throws Error, located: a kernel does not compile.
  LightEmitter(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
               const paths::Automaton& automaton);

  /// Traces paths first ... first + count - 1 of the round, one a slot. Afterwards the wavefront's frame is
  /// `picture` with `enabled` components again. False if cancelled.
  bool trace(Wavefront& wavefront, const LightSource& lights, const LightRound& round, uint32_t first,
             uint32_t count, const LightVertexWork& work, const shared::Frame& picture, uint32_t enabled,
             const std::function<bool()>& cancel);
  /// Counts of the last batch.
  uint32_t dark() const { return dark_; }        ///< paths that started where their light does not emit
  uint32_t escaped() const { return escaped_; }  ///< paths that left the scene

  /// Step of strata over the paths of a round (shaders/lib/emission.glsl).
  static uint32_t stratum_step(uint32_t paths) { return uint32_t((uint64_t{1} << 32) / paths); }

 private:
  shared::Frame frame_of(const LightRound& round, const shared::Frame& picture) const;

  paths::LightAutomaton automaton_;
  gpu::Kernel emit_;
  gpu::Buffer counts_;
  uint32_t dark_ = 0, escaped_ = 0;
};

}  // namespace lucerna::transport
