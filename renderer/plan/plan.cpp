#include "plan/plan.h"

namespace lucerna::plan {

uint32_t Plan::enabled() const {
  uint32_t bits = 0;
  for (size_t c = 0; c < solver.size(); ++c)
    if (solver[c]) bits |= 1u << c;
  return bits;
}

uint32_t Plan::components_of(const solvers::SolverInfo& info) const {
  uint32_t bits = 0;
  for (size_t c = 0; c < solver.size(); ++c)
    if (solver[c] == &info || rest[c] == &info) bits |= 1u << c;
  return bits;
}

uint32_t Plan::rests_of(const solvers::SolverInfo& info) const {
  uint32_t bits = 0;
  for (size_t c = 0; c < rest.size(); ++c)
    if (rest[c] == &info) bits |= 1u << c;
  return bits;
}

std::vector<const solvers::SolverInfo*> Plan::at_work() const {
  std::vector<const solvers::SolverInfo*> all;
  for (const solvers::SolverInfo* info : solvers::registered())
    if (components_of(*info) != 0) all.push_back(info);
  return all;
}

std::optional<double> Plan::bias(size_t component) const {
  const solvers::SolverInfo *first = solver[component], *second = rest[component];
  return first && first->unbiased && (!second || second->unbiased) ? std::optional(0.0) : std::nullopt;
}

Plan make_plan(const SceneFacts& facts, const Settings& settings, const solvers::Findings* findings,
               std::optional<double> seconds) {
  Plan plan;
  plan.choices = choose(facts, settings, findings, goal_of(settings, findings, seconds));
  plan.undecided = !findings && undecided(facts, settings);
  for (size_t c = 0; c < plan.choices.size(); ++c) {
    const std::string& name = plan.choices[c].solver;
    const size_t plus = name.find('+');
    plan.solver[c] = solvers::find(name.substr(0, plus));
    if (plus != std::string::npos) plan.rest[c] = solvers::find(name.substr(plus + 1));
  }
  if (primary_by_paths(plan.choices[0].solver, plan.choices[1].solver, plan.choices[2].solver))
    plan.solver[0] = solvers::find("path");
  return plan;
}

std::vector<std::string> effects_off(const Settings& settings) {
  return parse_effects(settings.text("effects.off"), "effects.off");
}

bool primary_by_paths(std::string_view primary, std::string_view secondary, std::string_view tertiary) {
  const solvers::SolverInfo* solver = solvers::find(primary);
  if (!solver || !solver->primary_with_secondary || secondary == primary) return false;
  return secondary != "off" || (tertiary != "off" && tertiary != primary);
}

namespace {

/// Names of the polished materials that surfaces have.
std::vector<std::string> polished_materials(const scene::Scene& scene) {
  std::vector<bool> used(scene.materials.size(), false);
  for (const scene::Instance& instance : scene.instances)
    for (const scene::Primitive& p : scene::shown_parts(scene, instance)) used[p.material] = true;
  std::vector<std::string> names;
  for (size_t i = 0; i < used.size(); ++i)
    if (used[i] && polished(scene.materials[i])) names.push_back(scene.materials[i].name);
  return names;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : between) + word;
  return all;
}

}  // namespace

std::vector<std::string> unreachable_light(const Plan& plan, const scene::Scene& scene) {
  // Words that end in D[DGS]*SL: of primary light lamps without size have none, and secondary light reaches
  // its lamp from a diffuse vertex.
  size_t lamps = 0;
  for (const scene::Light& light : scene.lights)
    lamps += light.enabled && light.intensity != vec3(0) && !(scene::has_shape(light.kind) && light.visible);
  const std::vector<std::string> materials = polished_materials(scene);
  if (lamps == 0 || materials.empty()) return {};
  std::vector<std::string> missing, settings, lines;
  for (const size_t c : {paths::k_tertiary, paths::k_caustic}) {
    const solvers::SolverInfo *solver = plan.solver[c], *rest = plan.rest[c];
    if (!solver || (rest && rest->finds_points) || (solver->finds_points && !solver->directly_visible_only))
      continue;
    const std::string name = paths::k_component_names[c];
    if (solver->directly_visible_only) {
      lines.push_back(fmt::format(
          "{}: {} light of point, spot and directional lights is missing where it is seen in a mirror or "
          "through glass: {} connects to directly visible surfaces only; set components.{}={}+photons to "
          "compute all of it",
          scene.file, name, solver->title, name, solver->name));
      continue;
    }
    missing.push_back(name);
    settings.push_back(fmt::format("components.{}=photons", name));
  }
  if (missing.empty()) return lines;
  const std::string &material = materials.front(), others = std::to_string(materials.size() - 1);
  lines.insert(
      lines.begin(),
      fmt::format(
          "{}: {} light is incomplete: paths from the eye cannot find the light of {} lamp{} that they "
          "cannot hit (point, spot, sun, invisible) by way of polished surfaces (material '{}'{}); set "
          "{} to compute it",
          scene.file, joined(missing, " and "), lamps, lamps == 1 ? "" : "s", material,
          materials.size() > 1 ? " and " + others + " more" : "", joined(settings, " and ")));
  return lines;
}

}  // namespace lucerna::plan
