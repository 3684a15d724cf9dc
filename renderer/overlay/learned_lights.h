#pragma once
// What lights are chosen by, over the picture (transport/light_learning.h): arrows from a point to the
// clusters of lights that serve it, and the share of shadow rays that arrive as a heat map.
#include <optional>
#include <vector>

#include "overlay/painter.h"
#include "shaders/shared/learned_view.h"
#include "transport/light_learning.h"

namespace lucerna::overlay {

/// A cluster that lights are chosen from at a point.
struct ServingCluster {
  uint32_t cluster = 0;
  float share = 0;  ///< of the light samples there
  float plain = 0;  ///< without learning
};
struct ServedPoint {
  vec3 position{0}, normal{0};
  float arrived = -1;                    ///< share of the shadow rays that arrive there; < 0: not known
  std::vector<ServingCluster> clusters;  ///< all of them, greatest share first
};

/// Arrows are drawn to so many clusters at most, and of shares from this on.
inline constexpr size_t k_most_arrows = 24;
inline constexpr float k_least_share = 0.005f;
/// Encoded, of a share of the light samples: the ink of its arrow.
vec3 share_ink(float share);

class LearnedLightsPainter {
 public:
  /// Kernels are compiled when they are first called for. Both must outlive it.
  LearnedLightsPainter(gpu::Device& device, gpu::ShaderCompiler& compiler);
  /// Arrows from what that pixel shows. Nothing where it shows no surface. `far_away`: length of an arrow to
  /// what is infinitely far [m].
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
