#pragma once
#include "commands/open_scene.h"
#include "film/io/view_transform.h"

namespace lucerna::commands {

/// How the picture is shown, by its settings.
film::ViewTransform view_transform(const OpenScene& open);

}  // namespace lucerna::commands
