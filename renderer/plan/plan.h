#pragma once
// From settings and scene to the plan: the solver of each component, and light that no solver can find.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "paths/automaton.h"
#include "plan/choose.h"
#include "plan/facts.h"
#include "plan/settings.h"
#include "scene/scene.h"
#include "solvers/registry.h"

namespace lucerna::plan {

struct Plan {
  /// By component: the solver's name as in components.X, and why it was chosen if the setting is auto.
  ByComponent<Choice> choices{};
  /// A choice waits for the findings of the first samples; paths compute those components meanwhile.
  bool undecided = false;
  ByComponent<const solvers::SolverInfo*> solver{};  ///< null: off
  /// If `solver` computes only directly visible light (SolverInfo::directly_visible_only): the solver that
  /// looks up the rest; null: eye paths compute it.
  ByComponent<const solvers::SolverInfo*> rest{};
  /// Components that are computed (bit i).
  uint32_t enabled() const;
  /// Components that this one computes (bits), or the rest of.
  uint32_t components_of(const solvers::SolverInfo& info) const;
  /// Those among these for which it computes only the rest.
  uint32_t rests_of(const solvers::SolverInfo& info) const;
  /// Solvers that compute something, in the registry's order.
  std::vector<const solvers::SolverInfo*> at_work() const;
  /// Relative bias of a component's mean: the part of the error that the two halves of the film cannot show.
  /// 0 for unbiased solvers; nullopt if unknown or the component is off.
  std::optional<double> bias(size_t component) const;
};

/// From the settings `components.*`: a solver's name, two joined by '+' (choices_of), off, or auto
/// (choose()). Every component has one solver, two that share its words, or none, so no path is counted
/// twice, and missing light was chosen. `findings`: of a pilot of this scene; null: none yet.
Plan make_plan(const SceneFacts& facts, const Settings& settings, const solvers::Findings* findings = nullptr,
               std::optional<double> seconds = {});

/// Effects in the setting effects.off. Throws Error like parse_effects().
std::vector<std::string> effects_off(const Settings& settings);

/// True if paths compute primary light although another solver is chosen: one that reads its part together
/// with secondary light (SolverInfo::primary_with_secondary), while paths continue for other light. Values of
/// `components.*`.
bool primary_by_paths(std::string_view primary, std::string_view secondary, std::string_view tertiary);

/// Light in the scene that the plan's solvers cannot find, one line each, with advice: caustic and tertiary
/// light of point, spot and directional lights by way of polished surfaces (mirrors, glass, varnish), which
/// eye paths cannot hit. Components that are off are left out.
std::vector<std::string> unreachable_light(const Plan& plan, const scene::Scene& scene);

}  // namespace lucerna::plan
