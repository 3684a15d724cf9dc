#pragma once
// What the scene panel remembers from frame to frame, and shares with the picture.
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "commands/navigation.h"
#include "gizmo.h"

namespace lucerna::ui {

/// An object's place while one of its numbers is dragged or typed. It is sent when the control rests or is
/// let go, all of one control as one step.
struct TypedPlace {
  uint32_t object = 0;
  scene::ObjectPlace place;
  std::string line;       ///< the command that gives it; "": it was sent
  unsigned control = 0;   ///< id of the control
  uint64_t gesture = 0;   ///< Actions::new_gesture
  double changed_at = 0;  ///< set when the line is noticed; 0: not yet
};

struct SceneView {
  bool to_top = false;  ///< another scene: the panel is not scrolled
  /// A visible row was pressed; an emissive material has two.
  bool chosen_in_list = false;
  commands::Selection revealed;
  scene::Id named_light = scene::k_none;  ///< light whose name is being typed
  std::string light_name;                 ///< as typed so far
  GizmoMode gizmo = GizmoMode::move;      ///< handles of the selected object
  std::optional<TypedPlace> typed;
  std::optional<uint32_t> copied_material;      ///< for Paste
  std::map<std::string, std::string> swatches;  ///< the user's own: words of material.set, by name
  std::string swatch_name;                      ///< of one to keep, as typed so far
  bool focusing = false;                        ///< the next click in the picture sets the plane of focus
  bool highlighting = false;  ///< the next click in the picture places the selected light's highlight

  /// True if the selection is new since the last call and was not made in the list: its row must be scrolled
  /// into view.
  bool reveals(const commands::Selection& selection) {
    if (std::exchange(revealed, selection) == selection) return false;
    return !std::exchange(chosen_in_list, false);
  }
};

}  // namespace lucerna::ui
