#pragma once
// Triangles of a glTF document.
#include "scene/io/document.h"
#include "scene/io/materials.h"

namespace lucerna::scene {

/// Coordinates beyond this (metres) are refused: a squared area of such a size still fits a float's range.
inline constexpr float k_max_coordinate = 1e9f;

/// Builds the scene's mesh of glTF mesh `index`. Primitives without triangles are left out.
Mesh load_mesh(Document& document, uint32_t index, MaterialLoader& materials);

}  // namespace lucerna::scene
