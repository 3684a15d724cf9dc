#pragma once
// Light that the light paths of one round contribute to the camera's pixels (shaders/shared/splat.h).
//
// Bit-identical for any thread timing and any number of paths in flight: light is summed as integers. A
// picture with more pixels than a storage buffer holds is summed in bands, each from the same light paths.
#include <array>

#include "shaders/shared/splat.h"
#include "transport/light_emitter.h"

namespace lucerna::light_tracing {

/// Of the latest complete round.
struct RoundFigures {
  uint32_t round = 0, paths = 0;
  uint32_t joined = 0;   ///< vertices inside the picture, before the visibility test
  uint32_t pixels = 0;   ///< pixels that received light
  uint32_t escaped = 0;  ///< paths that left the scene
  uint32_t dark = 0;     ///< paths that started where their light does not emit
  double trace_s = 0;    ///< wall time
};

class Splats {
 public:
  /// `scene_defines`: of kernels that read the scene. `groups`: the film has compact groups, so one group per
  /// pixel and channel is drawn at random (SplatOwners). Throws Error: a kernel does not compile (located),
  /// memory.
  Splats(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
         const paths::Automaton& automaton, bool groups);

  /// Binds SplatBlock and splat_picture; valid until a picture of another size begins.
  void bind(gpu::Resources& resources) const;
  /// Starts a picture of that size and component; it receives no light until a round is complete. `unit`:
  /// radiance per integer step of the sums.
  void begin(transport::Wavefront& wavefront, uint32_t width, uint32_t height, uint32_t component,
             float unit);
  /// Restarts the next round.
  void restart() { tracing_ = false, complete_ = false, band_ = 0; }

  /// Traces one batch of the round, as many paths as the wavefront has slots. The last batch completes the
  /// round, and camera paths then add its light. Afterwards the wavefront has frame `picture` with `enabled`
  /// components again. False if cancelled: it will be repeated.
  bool trace(transport::Wavefront& wavefront, const transport::LightSource& lights,
             const transport::LightRound& round, const shared::Frame& picture, uint32_t enabled,
             const std::function<bool()>& cancel);
  /// Traces a batch of a pilot, whose light is only measured: returns the contribution of each emission
  /// stratum to the picture, up to a common factor. nullopt if cancelled or not yet complete.
  std::optional<std::vector<double>> weigh(transport::Wavefront& wavefront,
                                           const transport::LightSource& lights,
                                           const transport::LightRound& round, const shared::Frame& picture,
                                           uint32_t enabled, const std::function<bool()>& cancel);
  bool complete() const { return complete_; }
  uint32_t round() const { return figures_.round; }
  const RoundFigures& figures() const { return figures_; }
  uint64_t bytes() const;

 private:
  struct Kernels {
    gpu::Kernel vertex, arrival;
  };
  /// Compiled at the first use.
  const Kernels& kernels(bool weighed, bool lens, bool section);
  enum class Went { cancelled, on, complete };
  Went batch(transport::Wavefront& wavefront, const transport::LightSource& lights,
             const transport::LightRound& round, bool weighed, const shared::Frame& picture, uint32_t enabled,
             const std::function<bool()>& cancel);
  void write_frame(bool whole = false);  ///< whole: covers all bands
  uint32_t bands() const { return (frame_.width * frame_.height - 1) / band_pixels_ + 1; }
  uint32_t pixels_of_band() const;
  void resolve(transport::Wavefront& wavefront);
  void clear(transport::Wavefront& wavefront);
  void bind_sums(gpu::Resources& resources) const;

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Defines scene_defines_;
  bool groups_;
  transport::LightEmitter emitter_;
  Kernels kernels_[2][2][2];  ///< weighed or not, through a lens or not, with a section plane or not
  gpu::Kernel resolve_;
  gpu::Buffer counts_, block_, round_, picture_, contributions_;
  /// LongSum of each pixel of a band: red, green, blue. One buffer for all three would be the largest buffer
  /// of a picture.
  std::array<gpu::Buffer, 3> sums_;
  gpu::Buffer owners_;        ///< if groups_
  gpu::Buffer band_picture_;  ///< if there are several bands
  uint32_t band_pixels_ = 1, band_ = 0;
  bool shown_ = false;  ///< picture_ contains a round
  shared::SplatFrame frame_{};
  RoundFigures figures_, next_;
  bool tracing_ = false, complete_ = false;
  uint32_t traced_ = 0;
};

}  // namespace lucerna::light_tracing
