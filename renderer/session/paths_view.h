#pragma once
// Recorded paths over the picture, with a legend (overlay.path_color). They stay when the camera moves, so
// that they can be seen from elsewhere.
#include <optional>

#include "overlay/painter.h"
#include "plan/settings.h"
#include "session/shown_paths.h"
#include "solvers/report.h"

namespace lucerna::session {

class PathsView {
 public:
  PathsView(gpu::Device& device, gpu::ShaderCompiler& compiler) : painter_(device, compiler) {}
  void draw(const overlay::Canvas& canvas, const ShownPaths& shown, const plan::Settings& settings,
            float radius);
  const std::optional<solvers::Report>& report() const { return report_; }
  void forget() { report_.reset(); }

 private:
  overlay::Painter painter_;
  std::optional<solvers::Report> report_;
};

}  // namespace lucerna::session
