#pragma once
// The list of all solvers. To add one, add a folder here and a line to registry.cpp.
#include <string_view>
#include <vector>

#include "solvers/info.h"

namespace lucerna::solvers {

struct SolverType;  // solver.h

/// All solvers; the default of every component comes first.
const std::vector<const SolverInfo*>& registered();
/// Registers a solver, which must live as long as the program. Throws std::logic_error after the first call
/// of registered(): call it at program start.
void add(const SolverType& solver);
/// The type of a registered solver.
const SolverType& type_of(const SolverInfo& solver);
/// The solver of that name; null if there is none.
const SolverInfo* find(std::string_view name);
/// True if a component's choice contains the solver, alone or joined to another by '+'.
bool chooses(std::string_view choice, std::string_view solver);
/// The solver that owns an option; null if it belongs to no single solver.
const SolverInfo* owner_of(std::string_view key);
/// What a changed setting invalidates in a solver. Settings of other solvers invalidate nothing.
Invalidation invalidated_by_setting(const SolverInfo& solver, std::string_view key);
/// Union over several changes.
Invalidation invalidated_by(const SolverInfo& solver, const scene::Changes& changes);

}  // namespace lucerna::solvers
