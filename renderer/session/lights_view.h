#pragma once
// Views of learned lights (overlay.lights, overlay.light_arrival): overlay, legends, and a card for the
// inspected place.
#include "overlay/learned_lights.h"
#include "plan/settings.h"
#include "scene/scene.h"
#include "solvers/report.h"
#include "upload/flatten.h"

namespace lucerna::session {

class LightsView {
 public:
  /// Both must outlive it.
  LightsView(gpu::Device& device, gpu::ShaderCompiler& compiler) : painter_(device, compiler) {}

  static bool shown(const plan::Settings& settings);
  /// Requires shown(). `learning`: null if nothing is learned.
  void draw(const overlay::Canvas& canvas, const transport::LightLearning* learning,
            const upload::FlatScene& flat, const shared::Frame& frame, const scene::Scene& scene,
            const plan::Settings& settings, std::optional<vec2> looked_at);
  /// Result of the latest draw().
  const std::optional<solvers::Report>& report() const { return report_; }
  void forget() { report_.reset(); }

 private:
  overlay::LearnedLightsPainter painter_;
  std::optional<solvers::Report> report_;
};

/// "Chandelier", "12 lamps", "480 triangles, bulb", "sky, 30 degrees high".
std::string cluster_text(const upload::ClusterPlace& place, const upload::FlatScene& flat,
                         const scene::Scene& scene);

}  // namespace lucerna::session
