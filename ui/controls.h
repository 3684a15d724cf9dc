#pragma once
// What panels of controls need: the state that they show, and the commands that change it.
#include <map>
#include <span>
#include <string>

#include "actions.h"
#include "base/math.h"
#include "commands/open_scene.h"
#include "solvers/info.h"

namespace lucerna::ui {

struct Controls {
  Actions& actions;
  commands::OpenScene& open;
  std::map<std::string, bool>& sections;  ///< open or not, by title

  template <class... A>
  void act(const std::string& command, const A&... words) {
    actions.act(command, words...);
  }
  bool view_on(const solvers::ViewInfo& view) const;
  /// Toggles a view; a choice advances in its ring.
  void turn_view(const solvers::ViewInfo& view);
};

/// A section of a panel, folded by a command; `fallback`: its initial state.
bool panel_section(Controls& controls, const char* title, bool fallback, const std::string& note = "");
/// A control for an option of the settings table, by its type; the tooltip is its help.
void option_control(Controls& controls, const std::string& key, const std::string& name);
/// A row of numbers for a place in the scene, whose core gives their range and precision. True if it has
/// changed.
bool position_row(const Box& core, vec3& position);

struct ChoiceButton {
  const char *name, *title, *help;
};
/// Buttons of equal width in a row, "##PREFIX_NAME" each; `on`: the one that is chosen, or none beyond their
/// number. The one that is pressed, or null.
const ChoiceButton* choice_buttons(const std::string& prefix, std::span<const ChoiceButton> buttons,
                                   size_t on);

}  // namespace lucerna::ui
