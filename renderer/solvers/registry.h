#pragma once
// All ways of computing light. Settings, help, window, scripts and benches take what they know of a solver
// from here; a new one is a folder beside this file and a line in registry.cpp.
#include <string_view>
#include <vector>

#include "solvers/info.h"

namespace lucerna::solvers {

struct SolverType;  // solver.h

/// The default of every component first.
const std::vector<const SolverInfo*>& registered();
/// One more, which must live as long as the program. Only before anything has asked for the list (throws
/// std::logic_error): programs that bring solvers of their own call it first.
void add(const SolverType& solver);
/// How one is made that is registered.
const SolverType& type_of(const SolverInfo& solver);
/// Null when there is none of that name.
const SolverInfo* find(std::string_view name);
/// Whether a component's choice names that solver, alone or joined to another by '+'.
bool chooses(std::string_view choice, std::string_view solver);
/// Whose option that is; null: nobody's alone.
const SolverInfo* owner_of(std::string_view key);
/// What a setting that changes spoils of a solver's work. Another solver's settings spoil nothing.
Invalidation invalidated_by_setting(const SolverInfo& solver, std::string_view key);
/// Of several changes at once.
Invalidation invalidated_by(const SolverInfo& solver, const scene::Changes& changes);

}  // namespace lucerna::solvers
