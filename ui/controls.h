#pragma once
// What panels of controls need: the state that they show, and the commands that change it.
#include <map>
#include <string>

#include "actions.h"
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

}  // namespace lucerna::ui
