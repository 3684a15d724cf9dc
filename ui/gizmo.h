#pragma once
// What a drag at an object's handles does to its place: pure functions of rays, without a window.
#include <array>
#include <optional>

#include "scene/object_place.h"
#include "session/pick.h"

namespace lucerna::ui {

enum class GizmoMode { off, move, turn, size };
/// Names in commands, by GizmoMode.
inline constexpr std::array<const char*, 4> k_gizmo_names{"off", "move", "turn", "size"};

/// A handle: an arrow, ring or arm of an axis, a square between two axes, or the middle, which moves along
/// the picture or sizes along all axes. Rings have no squares and no middle.
enum class GizmoPart { x, y, z, yz, zx, xy, middle };

/// Where the handles are. Arrows and rings have the world's axes, arms those of the object.
struct Gizmo {
  GizmoMode mode = GizmoMode::off;
  vec3 middle{0};
  glm::mat3 axes{1};  ///< unit columns
  float reach = 1;    ///< length of an axis, metres
  glm::mat3 view{1};  ///< the camera's right, up, and backward
};
/// Handles of an object with that box and matrix.
Gizmo make_gizmo(GizmoMode mode, const Box& box, const mat4& to_world, const scene::Camera& camera,
                 float reach);

/// Steps with Ctrl: metres, degrees, factors.
inline constexpr float k_step_metres = 0.1f, k_step_degrees = 15, k_step_factor = 0.1f;

/// The place after a drag of a handle from one ray to another; `start`: before it, with the handles where
/// they were then. `snap`: in whole steps. Rays along a handle's plane or axis, and factors out of range,
/// give the nearest place that they determine.
scene::ObjectPlace dragged_place(const Gizmo& gizmo, GizmoPart part, const scene::ObjectPlace& start,
                                 const session::PickRay& from, const session::PickRay& to, bool snap);

}  // namespace lucerna::ui
