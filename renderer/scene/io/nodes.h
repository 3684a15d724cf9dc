#pragma once
// The node hierarchy of a glTF document.
#include <map>

#include "scene/io/document.h"

namespace lucerna::scene {

/// Walks the default scene (scenes[scene], else the first, else all roots) and fills instances, cameras and
/// lights. Instance::mesh holds the glTF mesh index. Throws a located Error where a matrix above a mesh,
/// camera or light is singular or not finite.
void load_nodes(Document& document, Scene& scene);

/// The scene object that load_nodes walks, if there is one.
std::optional<Item> default_scene(const Document& document);

}  // namespace lucerna::scene
