#pragma once
// The panel of held results, on the right in the scene's place: their pictures with methods, time and error,
// the comparison with the live picture, and a plot of accuracy against time.
#include "compare_view.h"
#include "controls.h"
#include "layout.h"

namespace lucerna::ui {

/// Its name among the right panel's contents.
inline constexpr const char* k_compare_side = "compare";

void draw_compare_panel(Controls& controls, const commands::Workspace& work, CompareState& state,
                        const Area& area);

/// Accuracy against time of the held results and the live picture; part of it.
void draw_compare_plot(const commands::Workspace& work, float width);

}  // namespace lucerna::ui
