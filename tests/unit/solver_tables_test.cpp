// links: plan
// The solvers' tables are consistent with each other and with the settings: panels, keys, menus, commands and
// files are generated from them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "plan/settings.h"
#include "plan/views.h"
#include "solvers/registry.h"

namespace solver_tables_tests {

using namespace lucerna;

TEST_CASE("every setting of the picture has a row in each solver's table of changes") {
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    if (solver->changes.empty()) continue;
    for (const OptionInfo& option : plan::options()) {
      const solvers::SolverInfo* owner = solvers::owner_of(option.key);
      if (owner && owner != solver) continue;
      INFO(solver->name << ": " << option.key);
      const std::vector<solvers::ChangeRow> rows = solvers::changes_of(*solver);
      CHECK(std::any_of(rows.begin(), rows.end(), [&](const solvers::ChangeRow& row) {
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

TEST_CASE(
    "changes that mean the same to all solvers are in one table, and a solver's own row counts instead") {
  solvers::SolverInfo solver{.name = "some"};
  const auto invalidated = [&](const char* key) { return solvers::invalidated_by(solver, key); };
  CHECK(invalidated("film.ev") == solvers::k_invalidates_nothing);
  CHECK(invalidated("preview.filter") == solvers::k_invalidates_nothing);
  CHECK(invalidated("relight.mix") == solvers::k_invalidates_light);
  CHECK(invalidated("relight.layers") == solvers::k_invalidates_nothing);
  CHECK(solvers::invalidated_by(solver, scene::Change::lamp) == solvers::k_invalidates_light);
  CHECK(solvers::invalidated_by(solver, scene::Change::camera) == solvers::k_invalidates_all);
  CHECK(invalidated("unheard.of") == solvers::k_invalidates_all);
  solver.changes = {{"film.", solvers::k_invalidates_coverage, "as a test"},
                    {"film.ev", solvers::k_invalidates_light, "as a test"},
                    {scene::Change::lamp, solvers::k_invalidates_nothing, "as a test"}};
  CHECK(invalidated("film.layer") == solvers::k_invalidates_coverage);
  CHECK(invalidated("film.ev") == solvers::k_invalidates_light);
  CHECK(solvers::invalidated_by(solver, scene::Change::lamp) == solvers::k_invalidates_nothing);
  CHECK(invalidated("preview.filter") == solvers::k_invalidates_nothing);

  // A row that says what the default says is a copy of it.
  for (const solvers::SolverInfo* own : solvers::registered())
    for (const solvers::ChangeRow& row : own->changes)
      for (const solvers::ChangeRow& general : solvers::default_changes()) {
        INFO(own->name << ": " << row.why);
        CHECK_FALSE((row.change == general.change && row.invalidates == general.invalidates));
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

TEST_CASE("views that belong to no solver are settings that turn them on, without a restart") {
  for (const solvers::ViewInfo& view : plan::views()) {
    INFO(view.option);
    const OptionInfo* option = plan::find_option(view.option);
    REQUIRE(option);
    CHECK(solvers::owner_of(view.option) == nullptr);
    CHECK(option->type == OptionType::boolean);
    CHECK_FALSE(option->restarts);
    CHECK(option->label == view.label);
  }
}

}  // namespace solver_tables_tests
