#include "plan/choose.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "paths/automaton.h"
#include "solvers/registry.h"

namespace lucerna::plan {
namespace {

using solvers::Findings, solvers::Prospect, solvers::SolverInfo;

constexpr size_t k_count = shared::k_component_count;
constexpr double k_least_sample = 0.1;  // of the cost of a path-traced sample
constexpr double k_most_samples = 1e7;
constexpr double k_never = std::numeric_limits<double>::max();

/// Share of the picture without data when that share of the preparation is done: solvers begin with what most
/// of the picture needs. (Cached light in five rooms, after a third of building: .37 to .6; after two thirds:
/// .03 to .07.)
double missing_after(double prepared) { return (1 - prepared) * (1 - prepared); }

std::string key_of(size_t component) {
  return std::string("components.") + paths::k_component_names[component];
}

bool is_auto(const Settings& settings, size_t component) {
  return settings.text(key_of(component)) == k_auto;
}

/// Components that are chosen together, and who may compute them; null: paths.
struct Slot {
  uint32_t components = 0;
  std::vector<const SolverInfo*> candidates{nullptr};
};

/// Slots of the undecided components: interreflection, which solvers compute together, and caustics.
std::vector<Slot> slots_of(uint32_t undecided) {
  std::vector<Slot> slots;
  for (const uint32_t group :
       {paths::k_secondary_bit | paths::k_tertiary_bit, paths::k_caustic_bit, paths::k_primary_bit}) {
    Slot slot{.components = undecided & group};
    if (slot.components == 0) continue;
    for (const SolverInfo* solver : solvers::registered()) {
      bool serves = solver->prospect != nullptr && !solver->unbiased;
      for (size_t c = 0; c < k_count; ++c) serves &= (slot.components >> c & 1u) == 0 || solver->serves[c];
      if (serves) slot.candidates.push_back(solver);
    }
    slots.push_back(std::move(slot));
  }
  return slots;
}

/// One solver for each slot, with the prospect of the whole picture.
struct Combination {
  std::vector<const SolverInfo*> solvers;
  Prospect sum{.sample = 1};
  double traced = 0;   ///< variance of paths where data is still to be prepared
  double spent = 0;    ///< of the goal's cost, on the picture so far
  double has = 0;      ///< samples of the picture so far that stay
  bool begun = false;  ///< the solvers of the picture so far

  double sample_cost() const { return std::max(sum.sample, k_least_sample); }
  /// Error as seen with that many samples. `missing`: share of the picture whose data is not prepared, where
  /// paths compute the light.
  double error(double samples, double missing = 0) const {
    return std::hypot(std::sqrt((sum.variance + missing * traced) / samples), prepared_error(sum, samples),
                      sum.floor);
  }
  /// Squared error after the goal's cost, k_never before the first sample.
  double squared_error(const Goal& goal) const {
    const double left = goal.samples - spent;
    const double most = goal.cuts_preparation ? k_most_preparation * left : k_never;
    const double preparation = std::min(sum.preparation, most);
    const double samples = has + (left - preparation) / sample_cost();
    if (!(samples >= 1)) return k_never;
    const double e = error(samples, sum.preparation > most ? missing_after(most / sum.preparation) : 0);
    return e * e;
  }
  /// Cost until the error is reached, k_never if it is not.
  double cost(double target) const {
    double low = 1, high = k_most_samples;
    if (error(high) > target) return k_never;
    // The error falls with the samples.
    while (high > 1.001 * low) {
      const double middle = std::sqrt(low * high);
      (error(middle) > target ? low : high) = middle;
    }
    return sum.preparation + sample_cost() * high;
  }
  double badness(const Goal& goal) const { return goal.error ? cost(*goal.error) : squared_error(goal); }
};

double variance_of(const Findings& findings, uint32_t components) {
  double sum = 0;
  for (size_t c = 0; c < k_count; ++c)
    if ((components >> c & 1u) != 0) sum += findings.components[c].variance;
  return sum;
}

/// What a combination has in common with the solvers of the picture as it was begun.
enum class Shared { none, part, all };
Shared shared_with_begun(const Findings& findings, const std::vector<Slot>& slots,
                         const std::vector<const SolverInfo*>& by) {
  bool any = false, all = true;
  for (size_t s = 0; s < slots.size(); ++s)
    for (size_t c = 0; c < k_count; ++c) {
      if ((slots[s].components >> c & 1u) == 0) continue;
      const bool same = findings.begun->solvers[c] == (by[s] ? by[s]->name : "path");
      all &= same;
      any |= same && by[s];
    }
  return all ? Shared::all : any ? Shared::part : Shared::none;
}

/// Cost of a sample of the picture as it was begun, over the predicted one.
double excess_of_begun(Findings findings, uint32_t decided, const std::vector<Slot>& slots);

/// The combination of these solvers; nullopt if one of them is not suited. `decided`: components whose solver
/// is given: they count as if paths computed them.
std::optional<Combination> combine(const Findings& findings, uint32_t decided, const std::vector<Slot>& slots,
                                   std::vector<const SolverInfo*> by) {
  Combination all{.solvers = std::move(by)};
  all.sum.variance = variance_of(findings, decided);
  for (size_t s = 0; s < slots.size(); ++s) {
    if (!all.solvers[s]) {
      all.sum.variance += variance_of(findings, slots[s].components);
      continue;
    }
    const std::optional<Prospect> p = all.solvers[s]->prospect(findings, slots[s].components);
    if (!p) return std::nullopt;
    all.sum.preparation += findings.waiting * p->preparation;
    if (p->preparation > 0) all.traced += variance_of(findings, slots[s].components);
    all.sum.sample += p->sample;
    all.sum.variance += p->variance;
    if (p->prepared > all.sum.prepared) all.sum.refined = p->refined;
    all.sum.prepared = std::hypot(all.sum.prepared, p->prepared);
    all.sum.floor = std::hypot(all.sum.floor, p->floor);
  }
  if (!findings.begun) return all;
  all.spent = findings.begun->spent;
  const Shared shared = shared_with_begun(findings, slots, all.solvers);
  if (shared == Shared::none) return all;
  // What the solvers cost beyond the prediction they cost in other combinations, too.
  all.sum.sample += std::max(0.0, excess_of_begun(findings, decided, slots));
  if (shared == Shared::part) return all;
  all.begun = true;
  all.has = findings.begun->samples;
  all.sum.sample = findings.begun->sample;
  all.sum.preparation = 0;
  return all;
}

double excess_of_begun(Findings findings, uint32_t decided, const std::vector<Slot>& slots) {
  const Findings::Begun begun = *findings.begun;
  findings.begun.reset();
  std::vector<const SolverInfo*> by;
  for (const Slot& slot : slots) {
    const SolverInfo* solver = solvers::find(begun.solvers[size_t(std::countr_zero(slot.components))]);
    by.push_back(solver && !solver->unbiased ? solver : nullptr);
  }
  const std::optional<Combination> predicted = combine(findings, decided, slots, std::move(by));
  return predicted ? begun.sample - predicted->sum.sample : 0;
}

/// Every combination of candidates, paths alone first.
std::vector<Combination> combinations(const Findings& findings, uint32_t decided,
                                      const std::vector<Slot>& slots) {
  std::vector<Combination> all;
  size_t count = 1;
  for (const Slot& slot : slots) count *= slot.candidates.size();
  for (size_t k = 0; k < count; ++k) {
    std::vector<const SolverInfo*> by;
    size_t rest = k;
    for (const Slot& slot : slots) {
      by.push_back(slot.candidates[rest % slot.candidates.size()]);
      rest /= slot.candidates.size();
    }
    if (std::optional<Combination> c = combine(findings, decided, slots, std::move(by)))
      all.push_back(std::move(*c));
  }
  return all;
}

std::string percent(double x) { return fmt::format("{:.{}f} %", 100 * x, x < 0.0995 ? 1 : 0); }

/// "12 times sooner at 2 %", or the error after equal time.
std::string advantage(const Combination& chosen, const Combination& other, const Goal& goal) {
  if (goal.error) {
    const double a = chosen.cost(*goal.error), b = other.cost(*goal.error);
    if (b == k_never) return fmt::format("{} is not reached otherwise", percent(*goal.error));
    return fmt::format("{:.2g} times sooner at {}", b / a, percent(*goal.error));
  }
  const double a = std::sqrt(chosen.squared_error(goal)), b = std::sqrt(other.squared_error(goal));
  return fmt::format("an error of {} instead of {} in equal time", percent(std::min(a, 1.0)),
                     percent(std::min(b, 1.0)));
}

/// What only facts decide; nullopt: findings decide.
std::optional<Choice> by_facts(const SceneFacts& facts, size_t component) {
  const Effect& effect = facts.effect(paths::k_component_names[component]);
  const Effect& points = facts.effect("point_caustic");
  if (component == paths::k_caustic && points.called_for())
    for (const SolverInfo* solver : solvers::registered())
      if (solver->finds_points && !solver->directly_visible_only && solver->serves[component])
        return Choice{solver->name,
                      fmt::format("paths from the eye cannot find the light of lamps without size by way "
                                  "of {}",
                                  evidence_text(points, 2))};
  if (!effect.called_for()) return Choice{"path", fmt::format("the scene has none: {}", effect.missing)};
  if (component == paths::k_primary)
    return Choice{"path", "direct light is sampled where it arrives (lights.sampling)"};
  return std::nullopt;
}

}  // namespace

Goal goal_of(const Settings& settings, const Findings* findings, std::optional<double> seconds) {
  Goal goal;
  if (seconds && findings && findings->seconds > 0) {
    goal.samples = *seconds / findings->seconds;
    goal.cuts_preparation = true;
  } else if (settings.text("sampling.mode") == "adaptive") {
    goal.error = settings.real("sampling.target_error");
    goal.samples = settings.real("sampling.max_samples");
  } else {
    goal.samples = settings.real("samples");
  }
  return goal;
}

std::array<Choice, 4> choose(const SceneFacts& facts, const Settings& settings, const Findings* findings,
                             const Goal& goal) {
  std::array<Choice, 4> choices;
  uint32_t undecided = 0, decided = 0;
  for (size_t c = 0; c < k_count; ++c) {
    if (!is_auto(settings, c)) {
      choices[c].solver = settings.text(key_of(c));
    } else if (const std::optional<Choice> known = by_facts(facts, c)) {
      choices[c] = *known;
    } else {
      choices[c] = {"path", "to be decided by the first samples"};
      undecided |= 1u << c;
      continue;
    }
    if (choices[c].solver != "off") decided |= 1u << c;
  }
  if (!findings || undecided == 0) return choices;
  Findings own = *findings;
  // The cost of solvers that are given is measured with the others, but not predicted.
  for (size_t c = 0; c < k_count; ++c)
    if ((undecided >> c & 1u) == 0 && choices[c].solver != "path" && choices[c].solver != "off")
      own.begun.reset();
  const std::vector<Slot> slots = slots_of(undecided);
  const std::vector<Combination> all = combinations(own, decided, slots);
  const auto less = [&](const Combination& a, const Combination& b) {
    return a.badness(goal) < b.badness(goal);
  };
  // What a picture was begun with stays unless another combination is clearly ahead.
  const auto begun = std::find_if(all.begin(), all.end(), [](const Combination& c) { return c.begun; });
  const Combination *best = &*std::min_element(all.begin(), all.end(), less),
                    *known = begun != all.end() ? &*begun : &all.front();
  if (best->badness(goal) * k_clearly > known->badness(goal)) best = known;
  const double noise = variance_of(own, decided | undecided);
  for (size_t s = 0; s < slots.size(); ++s) {
    const double share = noise > 0 ? variance_of(own, slots[s].components) / noise : 0;
    const SolverInfo* solver = best->solvers[s];
    // The same choice but for this slot.
    std::vector<const SolverInfo*> without = best->solvers;
    without[s] = nullptr;
    const std::optional<Combination> other = combine(own, decided, slots, without);
    const Choice choice =
        solver ? Choice{solver->name, fmt::format("{}; {} of the noise of paths is here",
                                                  advantage(*best, *other, goal), percent(share))}
               : Choice{"path", fmt::format("no other method is clearly ahead; {} of the noise is here",
                                            percent(share))};
    for (size_t c = 0; c < k_count; ++c)
      if ((slots[s].components >> c & 1u) != 0) choices[c] = choice;
  }
  return choices;
}

std::optional<double> predicted_cost(const Findings& findings, const std::array<Choice, 4>& choices,
                                     double error) {
  uint32_t traced = 0;
  std::vector<Slot> slots;
  std::vector<const SolverInfo*> by;
  for (size_t c = 0; c < k_count; ++c) {
    const SolverInfo* solver = solvers::find(choices[c].solver);
    if (choices[c].solver == "off") continue;
    if (!solver || (!solver->unbiased && !solver->prospect)) return std::nullopt;
    const auto at = std::find(by.begin(), by.end(), solver);
    if (solver->unbiased) {
      traced |= 1u << c;
    } else if (at != by.end()) {
      slots[size_t(at - by.begin())].components |= 1u << c;
    } else {
      slots.push_back({.components = 1u << c});
      by.push_back(solver);
    }
  }
  const std::optional<Combination> all = combine(findings, traced, slots, by);
  const double cost = all ? all->cost(error) : k_never;
  return cost == k_never ? std::nullopt : std::optional(cost);
}

bool decides_solvers(std::string_view key) {
  return key.starts_with("components.") || key.starts_with("relight.");
}

void leave_choice(Settings& settings, const std::string& where) {
  for (const size_t c : {paths::k_secondary, paths::k_tertiary, paths::k_caustic})
    settings.set(key_of(c), k_auto, where);
}

bool undecided(const SceneFacts& facts, const Settings& settings) {
  for (size_t c = 0; c < k_count; ++c)
    if (is_auto(settings, c) && !by_facts(facts, c)) return true;
  return false;
}

}  // namespace lucerna::plan
