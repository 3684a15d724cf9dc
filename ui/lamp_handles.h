#pragma once
// Marks of lights in the picture: for selecting them, dragging lamps, and aiming spots.
#include <functional>
#include <optional>
#include <vector>

#include "actions.h"
#include "layout.h"
#include "scene/scene.h"
#include "session/pick.h"

namespace lucerna::ui {

/// The scene and the view in which its lights are marked.
struct MarkedScene {
  const commands::OpenScene& open;
  commands::Navigation& camera;
  bool all = false;  ///< all lights are marked, not only the selected one
};

struct LampHandle {
  enum class Part {
    place,   ///< where the lamp is
    aim,     ///< what the axis of a selected lamp meets that can be aimed
    size,    ///< on the outline of a selected lamp: its size, or the angle of its cone
    surface  ///< the middle of a surface that emits; it is selected alone, not dragged
  };
  uint32_t light = 0;  ///< the lamp's number, or the surface's material
  Part part = Part::place;
  vec3 point{0};  ///< in the scene
  ImVec2 at;      ///< on the screen
  ImVec2 mark;    ///< middle of its mark: `at`, or beside it where another mark lies
};

/// Projects a point of the scene to the screen; false if it is behind the eye.
bool project(const scene::Camera& camera, const Area& shown, const vec3& point, ImVec2& at);

/// The ray through a point of the screen, in the view; with direction 0 if it passes no section plane.
session::PickRay ray_through(const commands::Navigation& camera, const Area& shown, const ImVec2& at);
/// The nearest surface on that ray; passes through those for which `wanted` is false. Nothing while the rays
/// are not ready (Navigation::probe()).
std::optional<session::Picked> surface_at(commands::Navigation& camera, const Area& shown, const ImVec2& at,
                                          const std::function<bool(const session::Picked&)>& wanted = {});

/// What a drag snaps to: steps with Ctrl, surfaces under the pointer with Ctrl and Shift.
enum class DragSnap { none, steps, surface };
DragSnap drag_snap();

/// The visible handles: of all lights if they are marked, of the selected lamp always. Suns have none.
std::vector<LampHandle> lamp_handles(const MarkedScene& marked, const Area& shown);
/// The handle whose mark is the nearest to a point of the screen, if close enough.
std::optional<LampHandle> lamp_handle_at(const MarkedScene& marked, const Area& shown, const ImVec2& at);
/// `hot`: under the pointer, or dragged.
void draw_lamp_handles(const MarkedScene& marked, const Area& shown, const std::optional<LampHandle>& hot);
/// Moves a dragged handle with the pointer: a lamp along the picture, with Shift vertically, with Ctrl and
/// Shift to just before the surface under the pointer; its aim to that surface; its size.
void drag_lamp(Actions& actions, const MarkedScene& marked, const LampHandle& handle, const Area& shown);

}  // namespace lucerna::ui
