#pragma once
// Paths from lights as they are traced and aimed: segments from vertex to vertex, and what they are aimed at.
// For solvers that send some.
#include <optional>

#include "overlay/painter.h"
#include "transport/light_emitter.h"

namespace lucerna::overlay {

/// A group of lights and a box that is aimed at, and which share of the paths is sent from one to the other.
struct AimedPair {
  std::string light;  ///< by name, or in words: "Chandelier", "Light 3", "12 lights", "sky"
  uint32_t box = 0;
  double share = 0;
  std::optional<vec3> from;   ///< where the light is, if it is anywhere
  std::optional<vec3> along;  ///< unit, from a light that is far away
};
/// Greatest first; empty where nothing is aimed.
std::vector<AimedPair> aimed_pairs(const upload::FlatScene& flat, const transport::LightSource& lights);

/// Encoded, of a share of the paths: what draw_aim() draws it in.
vec3 aim_ink(double share);

class LightPathsPainter {
 public:
  /// Kernels are compiled when they are first called for. All must outlive it.
  LightPathsPainter(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
                    const paths::Automaton& automaton);
  /// `round`: which parts of light are followed; its number and paths are the view's own, so that it stands
  /// still. `lamp`: of which alone paths are drawn, from 1 on in the scene's order of lamps; 0: of all
  /// lights. Returns how many paths were sent.
  uint32_t draw(const Canvas& canvas, const upload::FlatScene& flat, const transport::LightSource& lights,
                transport::LightRound round, uint32_t lamp, const shared::Frame& picture, uint32_t enabled);
  /// The boxes, by the share of paths that is aimed at each, and lines from lights.
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
