#include "solvers/info.h"

#include <algorithm>

namespace lucerna::solvers {

const CommandInfo* find_command(const SolverInfo& solver, std::string_view name) {
  for (const CommandInfo& command : solver.commands)
    if (command.name == name) return &command;
  return nullptr;
}

std::span<const ChangeRow> default_changes() {
  using scene::Change;
  static const ChangeRow all[] = {
      {Change::lamp, k_invalidates_light, "other light on the same surfaces"},
      {Change::environment, k_invalidates_light, "other light on the same surfaces"},
      {Change::colour, k_invalidates_light,
       "of a material, or its emission: other light on the same surfaces"},
      {Change::material, k_invalidates_light, "other light on the same surfaces"},
      {Change::place, k_invalidates_all, "other surfaces"},
      {Change::shape, k_invalidates_all, "other surfaces"},
      {Change::shaders, k_invalidates_all, "whatever they compute"},
      {Change::restart, k_invalidates_all, "the user asks for everything from scratch"},
      {"effects.", k_invalidates_all, "other surfaces and lights"},
      {"scene.", k_invalidates_all, "other materials"},
      {"samples", k_invalidates_nothing, "of the picture alone"},
      {"sampling.", k_invalidates_nothing, "of the picture alone"},
      {"film.", k_invalidates_nothing, "how it is shown"},
      {"show.", k_invalidates_nothing, "how it is shown"},
      {"preview.", k_invalidates_nothing, "how it is shown"},
      {"overlay.", k_invalidates_nothing, "how it is shown"},
      {"about", k_invalidates_nothing, "words"},
      {"relight.", k_invalidates_light,
       "groups of the lights, and their light where groups are not separate"},
      {"relight.presets", k_invalidates_nothing, "names of mixes"},
      {"relight.layers", k_invalidates_nothing, "what is written into files"},
      {"tracer", k_invalidates_nothing, "all tracers find the same surfaces"},
      {"path.batch", k_invalidates_nothing, "how work is cut"},
      {"path.classes", k_invalidates_nothing, "by which kernels hits are shaded"},
      {"path.", k_invalidates_light, "how far paths go"},
      {"lights.", k_invalidates_nothing, "paths from the eye alone"},
      {"seed", k_invalidates_light, "other paths, as good as these"},
  };
  return all;
}

std::vector<ChangeRow> changes_of(const SolverInfo& solver) {
  std::vector<ChangeRow> all = solver.changes;
  for (const ChangeRow& row : default_changes())
    if (std::none_of(solver.changes.begin(), solver.changes.end(),
                     [&](const ChangeRow& own) { return own.change == row.change; }))
      all.push_back(row);
  return all;
}

Invalidation invalidated_by(const SolverInfo& solver, scene::Change edit) {
  for (const ChangeRow& row : changes_of(solver))
    if (const auto* what = std::get_if<scene::Change>(&row.change); what && *what == edit)
      return row.invalidates;
  return k_invalidates_all;
}

Invalidation invalidated_by(const SolverInfo& solver, std::string_view key) {
  Invalidation invalidation = k_invalidates_all;
  size_t length = 0;
  for (const ChangeRow& row : changes_of(solver))
    if (const auto* head = std::get_if<std::string_view>(&row.change);
        head && key.starts_with(*head) && head->size() > length)
      invalidation = row.invalidates, length = head->size();
  return invalidation;
}

}  // namespace lucerna::solvers
