#pragma once
// Where a dragged lamp or object is put on a surface: pure functions.
#include "scene/object_place.h"

namespace lucerna::ui {

/// A point of a surface. `normal`: unit, to the side on which things are put.
struct SurfacePoint {
  vec3 position{0}, normal{0, 1, 0};
};

/// Moves an object so that the middle of its box is in front of the point, along the normal, and its lowest
/// vertex along the normal lies on the surface. `loaded`: its matrix in its file; `box`: of its mesh. A mesh
/// without vertices keeps its place.
scene::ObjectPlace put_on_surface(const scene::Mesh& mesh, const Box& box, const mat4& loaded,
                                  const scene::ObjectPlace& place, const SurfacePoint& surface);

/// Position of a lamp whose shape, if it has one, is that far off the surface [m].
vec3 lamp_on_surface(const scene::Light& lamp, const SurfacePoint& surface, float gap);

}  // namespace lucerna::ui
