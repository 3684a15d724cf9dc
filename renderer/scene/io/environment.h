#pragma once
// What light comes from outside, and the settings beside the scene.
#include "scene/io/document.h"

namespace lucerna::scene {

/// Reads settings.json in the document's folder, if there is one: an object; "environment" as load.h says,
/// all else to Scene::settings. Gives back whether it set the environment.
bool load_settings(Document& document, Scene& scene);

/// Reads extras.environment of the default scene, if there is one.
void load_extras_environment(Document& document, Scene& scene);

}  // namespace lucerna::scene
