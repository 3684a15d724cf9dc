#pragma once
// Display of learned light selection (transport/light_learning.h): arrows from a point to the clusters of
// lights that light samples choose there, and a heat map of the share of unblocked shadow rays.
#include <optional>
#include <vector>

#include "overlay/painter.h"
#include "shaders/shared/learned_view.h"
#include "transport/light_learning.h"

namespace lucerna::overlay {

/// A cluster that light samples choose at a point.
struct ServingCluster {
  uint32_t cluster = 0;
  float share = 0;  ///< share of the light samples there
  float plain = 0;  ///< their share without learning
};
struct ServedPoint {
  vec3 position{0}, normal{0};
  float arrived = -1;                    ///< share of unblocked shadow rays there; < 0: unknown
  std::vector<ServingCluster> clusters;  ///< all, largest share first
};

/// Maximum number of arrows, and minimum share of an arrow's cluster.
inline constexpr size_t k_most_arrows = 24;
inline constexpr float k_least_share = 0.005f;
/// Encoded colour of the arrow for a share of the light samples.
vec3 share_ink(float share);

class LearnedLightsPainter {
 public:
  /// Kernels are compiled on first use. Device and compiler must outlive it.
  LearnedLightsPainter(gpu::Device& device, gpu::ShaderCompiler& compiler);
  /// Draws arrows from the surface that the pixel shows; nothing if it shows none. `far_away`: length of an
  /// arrow to an infinitely distant cluster [m].
  std::optional<ServedPoint> draw_arrows(const Canvas& canvas, const transport::LightLearning& learning,
                                         uint32_t x, uint32_t y, const shared::Frame& frame, float far_away);
  void draw_arrival(const Canvas& canvas, const transport::LightLearning& learning);

 private:
  const gpu::Kernel& ready(gpu::Kernel& kernel, const char* file);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel point_, arrival_;
  gpu::Buffer points_, arrivals_;
  gpu::Resources resources_;
  Painter painter_;
};

}  // namespace lucerna::overlay
