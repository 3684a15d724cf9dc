#pragma once
// Environment light, and the settings beside the scene.
#include "scene/io/document.h"

namespace lucerna::scene {

/// Reads settings.json in the document's folder, if present: an object; "environment" as in load.h, all else
/// to Scene::settings. Returns whether it set the environment.
bool load_settings(Document& document, Scene& scene);

/// Reads extras.environment of the default scene, if present.
void load_extras_environment(Document& document, Scene& scene);

}  // namespace lucerna::scene
