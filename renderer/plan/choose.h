#pragma once
// Chooses a solver for the components whose setting is auto, from the scene's facts and the findings of a
// pilot. Pure and deterministic; looks at nothing outside the scene.
//
// Every solver predicts a prospect (solvers/prospect.h): cost of preparation and samples, variance, and error
// that samples do not reduce. Costs and variances of components add up, so the error of every combination
// follows, for a given cost: error^2 = variance / samples + prepared(samples)^2 + floor^2. The choice is the
// combination with the least cost for the goal's error or, without one, with the least error for the goal's
// cost; paths, or what the picture was begun with, unless another combination is clearly ahead (k_clearly).
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "plan/facts.h"
#include "plan/settings.h"
#include "solvers/prospect.h"

namespace lucerna::plan {

/// What the picture is rendered for.
struct Goal {
  double samples = 256;           ///< cost that may be spent, in path-traced samples
  std::optional<double> error{};  ///< error as seen to be reached at the least cost
  /// Preparation ends at k_most_preparation of the cost, as with a limit of time. Where data is missing then,
  /// paths compute the light.
  bool cuts_preparation = false;
};
/// The settings' goal: samples, or the target error of adaptive sampling. `seconds`: limit of time, if any;
/// counts once the findings have a duration.
Goal goal_of(const Settings& settings, const solvers::Findings* findings, std::optional<double> seconds = {});

struct Choice {
  /// A value of components.X other than auto: a solver's name, two joined by '+', or off.
  std::string solver;
  std::string reason;  ///< a sentence; "" if the setting chose the solver
};

/// Value of components.X that leaves the choice to choose().
inline constexpr const char* k_auto = "auto";

/// Share of a limit of time after which preparation ends if its data are usable, and if they are not.
inline constexpr double k_most_preparation = 0.5, k_latest_preparation = 0.75;

/// Factor of cost, or of squared error, by which another combination must be ahead of paths, or of what the
/// picture was begun with.
inline constexpr double k_clearly = 1.1;

/// `findings`: null before the pilot: only facts decide, and undecided components are traced by paths.
std::array<Choice, 4> choose(const SceneFacts& facts, const Settings& settings,
                             const solvers::Findings* findings, const Goal& goal);

/// Cost until the error as seen is reached, in path-traced samples, with these choices (of choose());
/// nullopt: it is not reached, or a solver states no prospect.
std::optional<double> predicted_cost(const solvers::Findings& findings, const std::array<Choice, 4>& choices,
                                     double error);

/// True for settings that say who computes which light: with one of them, a scene leaves no choice.
bool decides_solvers(std::string_view key);

/// Leaves the choice of all solvers but that of direct light to choose(). `where`: for messages.
void leave_choice(Settings& settings, const std::string& where);

/// True if a component's choice waits for findings.
bool undecided(const SceneFacts& facts, const Settings& settings);

}  // namespace lucerna::plan
