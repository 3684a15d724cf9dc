#pragma once
// Rounds of paths from lights, in batches of as many as the wavefront has slots: begins them, and traces them
// through a kernel of the caller's at their vertices. For photons and for light tracing.
#include <functional>
#include <string>

#include "paths/light_paths.h"
#include "transport/light_source.h"
#include "transport/wavefront.h"

namespace lucerna::transport {

/// Parameters of a round for these kernels.
struct LightRound {
  uint32_t number = 0;   ///< its random numbers are those of this number and the frame's seed
  uint32_t paths = 0;    ///< at most shared::k_most_light_paths
  uint32_t parts = 0;    ///< of light that is wanted (bits, paths::k_part_count)
  uint32_t account = 0;  ///< component that their time is accounted to
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
  /// `scene_defines`: of the kernels that know the scene. Throws Error: a kernel does not compile (located).
  LightEmitter(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
               const paths::Automaton& automaton);

  /// Paths first ... first + count - 1 of the round, one a slot. The wavefront's frame is then `picture`, of
  /// `enabled` components, again. False when it was cancelled.
  bool trace(Wavefront& wavefront, const LightSource& lights, const LightRound& round, uint32_t first,
             uint32_t count, const LightVertexWork& work, const shared::Frame& picture, uint32_t enabled,
             const std::function<bool()>& cancel);
  /// Of the last batch.
  uint32_t dark() const { return dark_; }        ///< paths that began where their light has no light
  uint32_t escaped() const { return escaped_; }  ///< paths that left the scene

  /// Of strata over the paths of a round (shaders/lib/emission.glsl).
  static uint32_t stratum_step(uint32_t paths) { return uint32_t((uint64_t{1} << 32) / paths); }

 private:
  shared::Frame frame_of(const LightRound& round, const shared::Frame& picture) const;

  paths::LightAutomaton automaton_;
  gpu::Kernel emit_;
  gpu::Buffer counts_;
  uint32_t dark_ = 0, escaped_ = 0;
};

}  // namespace lucerna::transport
