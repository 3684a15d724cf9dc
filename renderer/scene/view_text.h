#pragma once
// A camera as text, for the metadata of files and to compare views.
#include <string>

#include "scene/scene.h"

namespace lucerna::scene {

/// Projection, place, shift, section plane and lens, to five figures: "perspective 0.8 aspect 0 at ...".
/// Equal texts: the same picture of the same scene and size.
std::string view_text(const Camera& camera);

}  // namespace lucerna::scene
