#pragma once
// View of the depth of field (overlay.focus): overlay and legend.
#include "overlay/focus.h"
#include "plan/settings.h"
#include "solvers/report.h"

namespace lucerna::session {

class FocusView {
 public:
  /// Both must outlive it.
  FocusView(gpu::Device& device, gpu::ShaderCompiler& compiler) : painter_(device, compiler) {}

  static bool shown(const plan::Settings& settings) { return settings.boolean("overlay.focus"); }
  /// Requires shown(). `frame`: of the picture.
  void draw(const overlay::Canvas& canvas, const shared::Frame& frame);
  /// Result of the latest draw().
  const std::optional<solvers::Report>& report() const { return report_; }
  void forget() { report_.reset(); }

 private:
  overlay::FocusPainter painter_;
  std::optional<solvers::Report> report_;
};

}  // namespace lucerna::session
