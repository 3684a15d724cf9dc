#pragma once
// Settings and scene -> what is to be done: which solver computes which component, and what cannot be
// reached.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "paths/automaton.h"
#include "plan/settings.h"
#include "scene/scene.h"
#include "solvers/registry.h"

namespace lucerna::plan {

struct Plan {
  std::array<const solvers::SolverInfo*, paths::k_component_count> solver{};  ///< null: off
  /// Where that brings only what the camera sees straight (SolverInfo::directly_visible_only): who looks the
  /// rest up; null: paths from the eye bring it.
  std::array<const solvers::SolverInfo*, paths::k_component_count> rest{};
  /// Components that are computed (bit i).
  uint32_t enabled() const;
  /// Components that this one computes (bits), or the rest of.
  uint32_t components_of(const solvers::SolverInfo& info) const;
  /// Of these, those of which it computes the rest alone.
  uint32_t rests_of(const solvers::SolverInfo& info) const;
  /// Those that compute something, in the registry's order.
  std::vector<const solvers::SolverInfo*> at_work() const;
  /// What a component's mean is off by, relative to its luminance: the part of the error that the two halves
  /// of the film cannot see. 0 where the solver is unbiased; nothing where it cannot tell, or where the
  /// component is off.
  std::optional<double> bias(size_t component) const;
};

/// From the settings `components.*`: a solver's name, two joined by '+' (choices_of), or off. Every component
/// has one solver, or two that share its words, or is off, so no path is counted twice, and what is lost was
/// declared.
Plan make_plan(const Settings& settings);

/// Light that the scene has and the plan's solvers cannot find, one line each, with what to do about it:
/// caustic and tertiary light that point, spot and directional lights send by way of polished surfaces
/// (mirrors, glass, varnish), which paths from the eye cannot hit. Components that are off are left out.
std::vector<std::string> unreachable_light(const Plan& plan, const scene::Scene& scene);

}  // namespace lucerna::plan
