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

Plan make_plan(const Settings& settings) {
  Plan plan;
  for (int c = 0; c < paths::k_component_count; ++c) {
    const std::string& name = settings.text(std::string("components.") + paths::k_component_names[c]);
    const size_t plus = name.find('+');
    plan.solver[size_t(c)] = solvers::find(name.substr(0, plus));
    if (plus != std::string::npos) plan.rest[size_t(c)] = solvers::find(name.substr(plus + 1));
  }
  return plan;
}

std::vector<std::string> unreachable_light(const Plan& plan, const scene::Scene& scene) {
  // Words that end in SL: no secondary light, which reaches its lamp from a diffuse vertex (...DL).
  constexpr uint32_t k_secondary = 1u << 1;
  if ((plan.enabled() & ~k_secondary) == 0) return {};
  constexpr size_t k_caustic = 3;
  const solvers::SolverInfo *caustics = plan.solver[k_caustic], *rest = plan.rest[k_caustic];
  const bool straight = caustics && caustics->straight_only;
  if (caustics && caustics->finds_points && !straight) return {};
  if (straight && rest && rest->finds_points) return {};
  size_t lamps = 0, solids = 0;
  for (const scene::Light& light : scene.lights) lamps += light.enabled;
  for (const scene::Material& m : scene.materials) solids += m.transmission > 0 && m.thickness > 0;
  if (lamps == 0 || solids == 0) return {};
  if (straight)
    return {fmt::format(
        "{}: light of {} point, spot or directional light{} that comes through solid glass is missing where "
        "it "
        "is itself seen in a mirror or through glass: {} is joined to what the camera sees straight; "
        "components.caustic={}+photons finds it all",
        scene.file, lamps, lamps == 1 ? "" : "s", caustics->title, caustics->name)};
  return {fmt::format(
      "{}: light of {} point, spot or directional light{} does not come through solid glass ({} material{} "
      "with KHR_materials_volume): path tracing cannot aim at a point through a refracting surface, "
      "only find emissive meshes",
      scene.file, lamps, lamps == 1 ? "" : "s", solids, solids == 1 ? "" : "s")};
}

}  // namespace lucerna::plan
