#pragma once
// Edits of a scene's lights, environment, materials and objects, as functions of the scene.
#include <memory>
#include <vector>

#include "scene/texture_source.h"
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
/// The material with its present textures.
EditedScene with_material(const ScenePtr& scene, uint32_t index, const scene::Material& material);
/// The material with textures from these sources; image files that the scene lacks are read. Surfaces get
/// tangents if they need some. `loaded`: the scene as its file has it. Throws Error also as
/// scene::load_texture.
EditedScene with_material(const ScenePtr& scene, const scene::Scene& loaded, uint32_t index,
                          const scene::Material& material, const scene::TextureSources& textures,
                          uint64_t most_bytes);
/// True if rays pass through the surfaces in another way, or shading reads other data of them, so that the
/// flattened scene must be made again: other textures, alpha, transmission, solid instead of thin, emitting
/// sides, tangents.
bool needs_flattening(const scene::Scene& before, const scene::Scene& after, uint32_t material);
/// Lights, emission and strength of the environment; the mix is not the scene's.
EditedScene with_strengths(const ScenePtr& scene, const LightsEdit& edit);
EditedScene with_objects(const ScenePtr& scene, const std::vector<ObjectEdit>& edits);

}  // namespace lucerna::session
