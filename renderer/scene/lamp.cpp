#include "scene/lamp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lucerna::scene {

double solid_angle(const Light& lamp) {
  switch (lamp.kind) {
    case LightKind::point:
      return 4 * std::numbers::pi;
    case LightKind::spot: {
      // Full within the inner cone, and the square of what is left of the way to the outer cosine, as
      // shaders/lib/lights.glsl has it: the ramp holds a third of its width.
      const double inner{std::cos(lamp.inner_cone)}, outer{std::cos(lamp.outer_cone)};
      const double width = std::max(inner - outer, 1e-4), ramp = std::min(1.0, (1 - outer) / width);
      return 2 * std::numbers::pi * (std::max(0.0, 1 - outer - width) + width * ramp * ramp * ramp / 3);
    }
    case LightKind::directional:
      break;
  }
  return 0;
}

}  // namespace lucerna::scene
