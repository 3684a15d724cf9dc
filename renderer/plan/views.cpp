#include "plan/views.h"

namespace lucerna::plan {

std::span<const solvers::ViewInfo> views() {
  static const solvers::ViewInfo all[] = {
      {.option = "overlay.lights", .label = "Lights of a point", .inspects_pointer = true},
      {.option = "overlay.light_arrival", .label = "Shadow rays that arrive"},
      {.option = "overlay.focus", .label = "Depth of field"},
  };
  return all;
}

}  // namespace lucerna::plan
