#pragma once
// Display of traced light paths, for solvers that trace them: segments from vertex to vertex, and the boxes
// that they are aimed at.
#include <optional>

#include "overlay/painter.h"
#include "transport/light_emitter.h"

namespace lucerna::overlay {

/// A group of lights, a target box, and the share of the paths from one to the other.
struct AimedPair {
  std::string light;  ///< name or description: "Chandelier", "Light 3", "12 lights", "sky"
  uint32_t box = 0;
  double share = 0;
  std::optional<vec3> from;   ///< position of the light, if it has one
  std::optional<vec3> along;  ///< unit, direction of a distant light
};
/// Largest share first; empty if no light is aimed.
std::vector<AimedPair> aimed_pairs(const upload::FlatScene& flat, const transport::LightSource& lights);

/// Encoded colour of draw_aim() for a share of the paths.
vec3 aim_ink(double share);

class LightPathsPainter {
 public:
  /// Kernels are compiled on first use. All arguments must outlive it.
  LightPathsPainter(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
                    const paths::Automaton& automaton);
  /// `round`: selects the traced parts of light; its number and count of paths are replaced by constants, so
  /// that the picture is steady. `lamp`: only its paths are drawn, from 1 in the scene's order of lamps; 0:
  /// all lights. Returns the number of traced paths.
  uint32_t draw(const Canvas& canvas, const upload::FlatScene& flat, const transport::LightSource& lights,
                transport::LightRound round, uint32_t lamp, const shared::Frame& picture, uint32_t enabled);
  /// Draws the boxes, coloured by the share of paths aimed at each, and lines from the lights.
  void draw_aim(const Canvas& canvas, const upload::FlatScene& flat, const transport::LightSource& lights,
                std::span<const Box> boxes);

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Defines scene_defines_;
  const paths::Automaton& automaton_;
  std::optional<transport::LightEmitter> emitter_;
  gpu::Kernel vertex_;
  gpu::Buffer segments_, block_;
  Painter painter_;
};

}  // namespace lucerna::overlay
