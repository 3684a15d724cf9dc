#pragma once
// What the scene panel remembers from frame to frame, and shares with the picture.
#include <string>
#include <utility>

#include "commands/navigation.h"

namespace lucerna::ui {

struct SceneView {
  bool to_top = false;  ///< another scene: the panel is not scrolled
  /// A visible row was pressed; an emissive material has two.
  bool chosen_in_list = false;
  commands::Selection revealed;
  scene::Id named_light = scene::k_none;  ///< light whose name is being typed
  std::string light_name;                 ///< as typed so far
  bool focusing = false;                  ///< the next click in the picture sets the plane of focus

  /// True if the selection is new since the last call and was not made in the list: its row must be scrolled
  /// into view.
  bool reveals(const commands::Selection& selection) {
    if (std::exchange(revealed, selection) == selection) return false;
    return !std::exchange(chosen_in_list, false);
  }
};

}  // namespace lucerna::ui
