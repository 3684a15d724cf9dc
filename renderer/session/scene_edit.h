#pragma once
// Edits of a scene's lights, environment, materials and objects, as functions of the scene.
#include <memory>
#include <vector>

#include "session/lights_edit.h"
#include "session/object_edit.h"

namespace lucerna::session {

/// An edited copy. Each function throws Error located at the edited thing: there is no scene (null), no such
/// index, or a value is out of range (scene::check_range).
using EditedScene = std::shared_ptr<scene::Scene>;
using ScenePtr = std::shared_ptr<const scene::Scene>;

EditedScene with_light(const ScenePtr& scene, uint32_t index, const scene::Light& light);
/// Replaces all lights.
EditedScene with_light_list(const ScenePtr& scene, const std::vector<scene::Light>& lights);
EditedScene with_environment(const ScenePtr& scene, float scale, float rotation_degrees);
/// Throws Error also if textures or transparency (alpha mode, transmission, thickness) would change: rays
/// depend on these.
EditedScene with_material(const ScenePtr& scene, uint32_t index, const scene::Material& material);
/// Lights, emission and strength of the environment; the mix is not the scene's.
EditedScene with_strengths(const ScenePtr& scene, const LightsEdit& edit);
EditedScene with_objects(const ScenePtr& scene, const std::vector<ObjectEdit>& edits);

}  // namespace lucerna::session
