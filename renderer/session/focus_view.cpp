#include "session/focus_view.h"

#include <fmt/format.h>

namespace lucerna::session {

void FocusView::draw(const overlay::Canvas& canvas, const shared::Frame& frame) {
  solvers::Report report{.solver = "focus"};
  solvers::Legend legend{.title = "Depth of field"};
  if (frame.lens_radius == 0) {
    legend.note = frame.projection != shared::k_projection_perspective
                      ? "Only a perspective camera has depth of field."
                      : "The camera is a pinhole: everything is sharp. Depth of field gives it a lens.";
  } else {
    painter_.draw(canvas, frame);
    const overlay::DepthOfField sharp = overlay::depth_of_field(frame);
    const std::string to =
        std::isfinite(sharp.farthest) ? fmt::format("to {:.3g} m", sharp.farthest) : "and farther";
    legend.marks = {
        {.ink = overlay::k_focus_line, .text = fmt::format("Focus, {:.3g} m", frame.focus_distance)},
        {.ink = overlay::k_sharp_tint, .text = fmt::format("Sharp, {:.3g} m {}", sharp.nearest, to)}};
    legend.marks_in_line = false;
    legend.note =
        "Sharp: a point's blur is at most 0.03 mm wide on film 36 mm wide. Distances are along the view "
        "axis.";
    report.figures = {{"nearest", double(sharp.nearest)}, {"farthest", double(sharp.farthest)}};
  }
  report.legends.push_back(std::move(legend));
  report_ = std::move(report);
}

}  // namespace lucerna::session
