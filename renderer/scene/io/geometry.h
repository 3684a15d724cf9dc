#pragma once
// Triangles of a glTF document.
#include "scene/io/document.h"
#include "scene/io/materials.h"
#include "scene/range.h"

namespace lucerna::scene {

/// Builds the scene's mesh of glTF mesh `index`. Primitives without triangles are left out.
Mesh load_mesh(Document& document, uint32_t index, MaterialLoader& materials);

}  // namespace lucerna::scene
