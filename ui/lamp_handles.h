#pragma once
// Lights in the picture: marks by which they are selected, lamps by which they are dragged, and what spots
// are aimed at.
#include <optional>
#include <vector>

#include "layout.h"
#include "scene/scene.h"

namespace lucerna::ui {

struct Ui;

struct LampHandle {
  enum class Part {
    place,   ///< where the lamp is
    aim,     ///< what the axis of a selected spot meets
    surface  ///< the middle of a surface that emits; it is selected alone, not dragged
  };
  uint32_t light = 0;  ///< the lamp's number, or the surface's material
  Part part = Part::place;
  vec3 point{0};  ///< in the scene
  ImVec2 at;      ///< on the screen
};

/// A point of the scene in the picture, which is shown there; false behind the eye.
bool project(const scene::Camera& camera, const Area& shown, const vec3& point, ImVec2& at);

/// Those that are shown: of all lights where they are marked, of the selected lamp always. Suns have no
/// place.
std::vector<LampHandle> lamp_handles(Ui& ui, const Area& shown);
/// The nearest to a point of the screen, close enough to be meant.
std::optional<LampHandle> lamp_handle_at(Ui& ui, const Area& shown, const ImVec2& at);
/// `hot`: under the pointer, or dragged.
void draw_lamp_handles(Ui& ui, const Area& shown, const std::optional<LampHandle>& hot);
/// Moves what a drag began on with the pointer: a lamp along the picture, with Shift straight up and down; a
/// spot's aim to the surface under the pointer.
void drag_lamp(Ui& ui, const Area& shown);

}  // namespace lucerna::ui
