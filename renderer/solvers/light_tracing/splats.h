#pragma once
// What the light paths of one round bring straight to the camera's pixels (shaders/shared/splat.h).
//
// Bit-identical, however threads run and however many paths are in flight: light is summed in whole numbers.
// A picture of more pixels than a storage buffer holds is summed in bands, each by the same light paths.
#include <array>

#include "shaders/shared/splat.h"
#include "transport/light_emitter.h"

namespace lucerna::light_tracing {

/// Of the last complete round.
struct RoundFigures {
  uint32_t round = 0, paths = 0;
  uint32_t joined = 0;   ///< vertices that lie in the picture, were nothing between
  uint32_t pixels = 0;   ///< that have got light
  uint32_t escaped = 0;  ///< paths that left the scene
  uint32_t dark = 0;     ///< paths that began where their light has no light
  double trace_s = 0;    ///< wall time of it
};

class Splats {
 public:
  /// `scene_defines`: of the kernels that know the scene. `groups`: that of lights are kept in short, so that
  /// it is drawn whose a pixel's light is (SplatOwners). Throws Error: a kernel does not compile (located),
  /// no memory.
  Splats(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
         const paths::Automaton& automaton, bool groups);

  /// SplatBlock, splat_picture: as they are until a picture of another size begins.
  void bind(gpu::Resources& resources) const;
  /// A picture of that size begins, of that component; nothing is brought to it until a round is complete.
  /// `unit`: that sums are counted in, of radiance.
  void begin(transport::Wavefront& wavefront, uint32_t width, uint32_t height, uint32_t component,
             float unit);
  /// The next round is to begin anew.
  void restart() { tracing_ = false, complete_ = false, band_ = 0; }

  /// One batch of the round, as many paths as the wavefront has slots; with the last the round is complete,
  /// and paths from the camera bring it. The wavefront's frame is then `picture`, of `enabled` components,
  /// again. False when it was cancelled: it will be done again.
  bool trace(transport::Wavefront& wavefront, const transport::LightSource& lights,
             const transport::LightRound& round, const shared::Frame& picture, uint32_t enabled,
             const std::function<bool()>& cancel);
  /// The same of a pilot, whose light goes nowhere but here: what each stratum of emission brings to the
  /// picture, up to a factor. Nothing when it was cancelled, or is not yet complete.
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
  Kernels compile(bool weighed) const;
  enum class Went { cancelled, on, complete };
  Went batch(transport::Wavefront& wavefront, const transport::LightSource& lights,
             const transport::LightRound& round, const Kernels& kernels, const shared::Frame& picture,
             uint32_t enabled, const std::function<bool()>& cancel);
  void write_frame(bool whole = false);  ///< whole: of all bands
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
  Kernels summed_, weighed_;  ///< weighed_: when it is first called for
  gpu::Kernel resolve_;
  gpu::Buffer counts_, block_, round_, picture_, contributions_;
  /// LongSum of each pixel of a band: red, green, blue. One buffer of all would be the largest that a picture
  /// needs.
  std::array<gpu::Buffer, 3> sums_;
  gpu::Buffer owners_;        ///< of groups_
  gpu::Buffer band_picture_;  ///< where there are several bands
  uint32_t band_pixels_ = 1, band_ = 0;
  bool shown_ = false;  ///< picture_ is that of a round
  shared::SplatFrame frame_{};
  RoundFigures figures_, next_;
  bool tracing_ = false, complete_ = false;
  uint32_t traced_ = 0;
};

}  // namespace lucerna::light_tracing
