#pragma once
// Triangles of a glTF document.
#include "scene/io/deform.h"
#include "scene/io/document.h"
#include "scene/io/materials.h"
#include "scene/range.h"

namespace lucerna::scene {

/// Converts glTF mesh `index` in a pose. Primitives without triangles are skipped. If the pose places the
/// vertices, they are relative to `origin`, a nearby point in the world in multiples of 64 m (0 in most
/// scenes), so that distant geometry keeps its shape in single precision.
Mesh load_mesh(Document& document, uint32_t index, MaterialLoader& materials, const Pose& pose,
               glm::dvec3& origin);

}  // namespace lucerna::scene
