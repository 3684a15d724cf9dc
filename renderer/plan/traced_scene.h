#pragma once
// What settings make of a scene before it is traced: another variant of its materials, clay, and effects left
// out.
#include <memory>
#include <string>

#include "plan/settings.h"
#include "scene/scene.h"

namespace lucerna::plan {

/// By scene.variant, scene.clay and effects.off; the scene itself if they change nothing. Throws Error
/// located at the setting.
std::shared_ptr<const scene::Scene> traced_scene(std::shared_ptr<const scene::Scene> scene,
                                                 const Settings& settings);
/// Equal for settings that make the same of every scene.
std::string traced_scene_key(const Settings& settings);
/// Keys of these settings.
inline constexpr const char* k_traced_scene_settings[] = {"scene.variant", "scene.clay", "effects.off"};

}  // namespace lucerna::plan
