#pragma once
// An object that is moved, hidden or shown.
#include <cstdint>

#include "base/math.h"

namespace lucerna::session {

struct ObjectEdit {
  uint32_t index = 0;  ///< into Scene::instances
  mat4 to_world{1};
  bool hidden = false;
  bool operator==(const ObjectEdit&) const = default;
};

}  // namespace lucerna::session
