#pragma once
// Views over the picture that belong to no solver: settings that turn them on, with a place in the window.
#include <span>

#include "solvers/info.h"

namespace lucerna::plan {

/// All of them, in the menu's order; each is a boolean setting.
std::span<const solvers::ViewInfo> views();

}  // namespace lucerna::plan
