#pragma once
// Triangles of a glTF document.
#include "scene/io/deform.h"
#include "scene/io/document.h"
#include "scene/io/materials.h"
#include "scene/range.h"

namespace lucerna::scene {

/// Builds the scene's mesh of glTF mesh `index` in a pose. Primitives without triangles are left out. Where
/// the pose places the vertices, they are relative to `origin`, a point near them in the world in multiples
/// of 64 m (so 0 in most scenes): what is far away keeps its shape in single precision.
Mesh load_mesh(Document& document, uint32_t index, MaterialLoader& materials, const Pose& pose,
               glm::dvec3& origin);

}  // namespace lucerna::scene
