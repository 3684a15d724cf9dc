#include "solvers/info.h"

namespace lucerna::solvers {

const CommandInfo* find_command(const SolverInfo& solver, std::string_view name) {
  for (const CommandInfo& command : solver.commands)
    if (command.name == name) return &command;
  return nullptr;
}

Invalidation invalidated_by(const SolverInfo& solver, scene::Change edit) {
  for (const ChangeRow& row : solver.changes)
    if (const auto* what = std::get_if<scene::Change>(&row.change); what && *what == edit)
      return row.invalidates;
  return k_invalidates_all;
}

Invalidation invalidated_by(const SolverInfo& solver, std::string_view key) {
  const ChangeRow* best = nullptr;
  size_t length = 0;
  for (const ChangeRow& row : solver.changes)
    if (const auto* head = std::get_if<std::string_view>(&row.change);
        head && key.starts_with(*head) && (!best || head->size() > length))
      best = &row, length = head->size();
  return best ? best->invalidates : k_invalidates_all;
}

}  // namespace lucerna::solvers
