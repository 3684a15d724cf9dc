#pragma once
// Scenes with other materials: variants that the file names (KHR_materials_variants), and clay.
#include <memory>
#include <string>

#include "scene/scene.h"

namespace lucerna::scene {

/// The scene with the materials of a variant (Scene::variants); "": the scene itself. Throws Error located at
/// `where` if there is none of that name, with the names that there are.
std::shared_ptr<const Scene> with_variant(std::shared_ptr<const Scene> scene, const std::string& name,
                                          const std::string& where);

/// The scene in matt grey clay. What transmits light or emits it stays as it is, and so do holes (alpha).
std::shared_ptr<const Scene> in_clay(std::shared_ptr<const Scene> scene);
/// Shadow catchers without all that they do not show: colours, reflections, textures, emission.
std::shared_ptr<const Scene> with_plain_catchers(std::shared_ptr<const Scene> scene);
inline constexpr float k_clay_reflectance = 0.5f;

}  // namespace lucerna::scene
