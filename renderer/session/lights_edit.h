#pragma once
// Several edits of lights that are one.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace lucerna::session {

/// Strengths of lights, and how their groups are mixed.
struct LightsEdit {
  std::vector<std::pair<uint32_t, scene::Light>> lights;        ///< by index
  std::vector<std::pair<uint32_t, scene::Material>> materials;  ///< that emit otherwise, by index
  std::optional<float> environment_scale;                       ///< none: as it is
  std::string mix;                                              ///< the setting relight.mix
};

}  // namespace lucerna::session
