#pragma once
// Several edits of lights as one.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace lucerna::session {

/// Strengths of lights, and the mix of their groups.
struct LightsEdit {
  std::vector<std::pair<uint32_t, scene::Light>> lights;        ///< by index
  std::vector<std::pair<uint32_t, scene::Material>> materials;  ///< with changed emission, by index
  std::optional<float> environment_scale;                       ///< nullopt: unchanged
  std::string mix;                                              ///< the setting relight.mix
};

}  // namespace lucerna::session
