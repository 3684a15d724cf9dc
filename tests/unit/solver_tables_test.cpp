// links: plan
// The solvers' tables are consistent with each other and with the settings: panels, keys, menus, commands and
// files are generated from them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "plan/settings.h"
#include "solvers/registry.h"

using namespace lucerna;

TEST_CASE("every setting of the picture has a row in each solver's table of changes") {
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    if (solver->changes.empty()) continue;
    for (const OptionInfo& option : plan::options()) {
      const solvers::SolverInfo* owner = solvers::owner_of(option.key);
      if (owner && owner != solver) continue;
      INFO(solver->name << ": " << option.key);
      CHECK(std::any_of(solver->changes.begin(), solver->changes.end(), [&](const solvers::ChangeRow& row) {
        const auto* head = std::get_if<std::string_view>(&row.change);
        return head && option.key.starts_with(*head);
      }));
    }
    // A mix without tracked groups is an edit of all lights: surfaces do not change.
    scene::Changes relit(scene::Change::lamp);
    relit.edits.insert({scene::Change::environment, scene::Change::colour});
    relit.settings = {"relight.mix"};
    INFO(solver->name);
    CHECK(solvers::invalidated_by(*solver, relit).light);
    CHECK_FALSE(solvers::invalidated_by(*solver, relit).places);
  }
}

TEST_CASE("views, commands and files of every solver are valid for window and scripts") {
  const std::string windows = "ADEFKLQRSTW";  // keys that the window uses itself
  std::set<std::string> names, extensions;
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    INFO(solver->name);
    CHECK(names.insert(solver->name).second);
    CHECK_FALSE((solver->label.empty() || solver->title.empty() || solver->help.empty()));
    CHECK(std::find(solver->serves.begin(), solver->serves.end(), true) != solver->serves.end());
    std::set<char> keys;
    const auto check_key = [&](char key) {
      if (!key) return;
      INFO(key);
      CHECK((key >= 'A' && key <= 'Z'));
      CHECK(windows.find(key) == std::string::npos);
      CHECK(keys.insert(key).second);
    };
    const auto own = [&](const std::string& key) -> const OptionInfo* {
      INFO(key);
      CHECK(solvers::owner_of(key) == solver);
      CHECK(plan::find_option(key) != nullptr);
      return plan::find_option(key);
    };
    for (const solvers::ViewInfo& view : solver->views) {
      INFO(view.option);
      check_key(view.shortcut);
      CHECK_FALSE(view.label.empty());
      const OptionInfo* option = own(view.option);
      REQUIRE(option);
      CHECK_FALSE(option->restarts);
      if (option->type == OptionType::choice)
        CHECK(option->choices[0] == "off");
      else
        CHECK((option->type == OptionType::boolean && view.ring.empty()));
      for (const std::string& value : view.ring)
        CHECK(std::find(option->choices.begin(), option->choices.end(), value) != option->choices.end());
      for (const std::string& key : view.refined_by) {
        const OptionInfo* by = own(key);
        CHECK((by && by->type == OptionType::choice));
      }
    }
    std::set<std::string> commands{"save", "load"};
    for (const solvers::CommandInfo& command : solver->commands) {
      check_key(command.shortcut);
      CHECK(commands.insert(command.name).second);
      CHECK(solvers::find_command(*solver, command.name) == &command);
      CHECK_FALSE((command.label.empty() || command.help.empty()));
    }
    CHECK(solvers::find_command(*solver, "no such command") == nullptr);
    if (solver->file) {
      CHECK(solver->file->extension.starts_with("."));
      CHECK(extensions.insert(solver->file->extension).second);
      CHECK_FALSE((solver->file->content.empty() || solver->file->fits.empty()));
    }
    for (const auto* list : {&solver->against_noise, &solver->against_bias})
      for (const std::string& key : *list) own(key);
  }
}
