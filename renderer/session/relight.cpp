#include "session/relight.h"

#include <algorithm>
#include <iterator>

#include "plan/traced_scene.h"
#include "scene/light_factor.h"
#include "solvers/solver.h"

namespace lucerna::session {
namespace {

/// Fraction of device memory that group sums may take unless explicitly enabled.
constexpr uint64_t k_share = 8;

/// Why groups are not separate, independent of solvers and memory; "": no reason.
std::string obstacle(const plan::Settings& settings, bool interactive) {
  const std::string& enabled = settings.text("relight.enabled");
  if (enabled == "off") return "relight.enabled is off";
  if (enabled == "auto" && !interactive) return "relight.enabled is auto, which is off in batch renders";
  return "";
}

/// ... because of the component's solver, if there are several groups.
std::string obstacle(const plan::Plan& plan, const plan::Settings& settings) {
  for (const solvers::SolverInfo* info : plan.at_work()) {
    if (!solvers::type_of(*info).make) continue;
    if (!info->by_groups) return fmt::format("{} cannot separate its light by groups", info->title);
    if (settings.text("relight.enabled") == "on")
      return fmt::format("{} separates groups only without components; use relight.enabled=compact",
                         info->title);
  }
  return "";
}

/// ... because of their number.
std::string obstacle(const plan::Settings& settings, const scene::LightGroups& groups, uint64_t pixels,
                     uint64_t memory) {
  const uint64_t bytes =
      pixels * film::sum_bytes(uint32_t(groups.groups.size()), film::GroupStorage::compact);
  if (settings.text("relight.enabled") == "auto" && bytes > memory / k_share)
    return fmt::format("{} groups would take {} MiB; relight.enabled=compact takes them",
                       groups.groups.size(), bytes >> 20);
  return "";
}

std::string unknown_group(const std::string& name, const scene::LightGroups& groups) {
  std::vector<std::string> names;
  for (const scene::LightGroup& group : groups.groups) names.push_back(group.name);
  return fmt::format("relight.mix: the scene has no light group '{}'; there are: {}", name,
                     fmt::join(names, ", "));
}

}  // namespace

Relight make_relight(const plan::Plan& plan, const plan::Settings& settings,
                     std::shared_ptr<const scene::Scene> scene, bool interactive, uint64_t pixels,
                     uint64_t memory, const Relight& before) {
  Relight r;
  scene = plan::traced_scene(std::move(scene), settings);
  r.traced = plan::traced_scene_key(settings);
  const std::string& rules_text = settings.text("relight.groups");
  const std::vector<scene::LightGroupRule> rules = scene::parse_group_rules(rules_text);
  const scene::LightMix mix = scene::parse_mix(settings.text("relight.mix"));
  scene::parse_presets(settings.text("relight.presets"));
  r.lit = scene;
  r.why_not = obstacle(settings, interactive);
  if (!r.why_not.empty() && mix.empty()) return r;
  r.scene = scene;
  r.groups = std::make_shared<const scene::LightGroups>(
      before.groups ? scene::group_lights(*scene, rules, *before.scene, *before.groups)
                    : scene::group_lights(*scene, rules));
  r.messages = r.groups->messages;
  for (const std::string& name : scene::unknown_groups(mix, *r.groups))
    r.messages.push_back(unknown_group(name, *r.groups));
  // With one group, light is scaled by the group's strength.
  const bool one = r.groups->groups.size() == 1;
  if (r.why_not.empty() && !one) r.why_not = obstacle(plan, settings);
  if (r.why_not.empty() && !one) r.why_not = obstacle(settings, *r.groups, pixels, memory);
  r.separate = r.why_not.empty();
  if (settings.text("relight.enabled") == "on") r.kept = film::GroupStorage::by_component;
  if (r.separate) {
    r.weights = scene::mix_weights(mix, *r.groups);
  } else if (!scene::is_neutral(mix, *r.groups)) {
    r.lit = std::make_shared<const scene::Scene>(scene::mixed_scene(*scene, *r.groups, mix, &r.messages));
    r.baked = rules_text + "\n" + scene::mix_text(mix);
  }
  return r;
}

namespace {

void weigh(Relight& relight, const scene::LightMix& mix) {
  relight.weights = scene::mix_weights(mix, *relight.groups);
  for (size_t g = 0; g < relight.written.size(); ++g) relight.weights[g] *= relight.written[g];
}

}  // namespace

bool write_mix(Relight& relight, std::shared_ptr<const scene::Scene> scene, const scene::Scene& lit,
               const plan::Settings& settings, const std::string& text) {
  if (!relight.separate || !relight.groups) return false;
  const scene::LightGroups groups = scene::group_lights(
      *scene, scene::parse_group_rules(settings.text("relight.groups")), *relight.scene, *relight.groups);
  if (groups != *relight.groups) return false;
  const std::vector<vec3> weights = scene::mix_weights(scene::parse_mix(text), groups);
  std::vector<vec3> factors(weights.size(), vec3(1));
  for (size_t g = 0; g < weights.size(); ++g)
    for (int k = 0; k < 3; ++k) {
      if (weights[g][k] > 0)
        factors[g][k] = relight.weights[g][k] / weights[g][k];
      else if (relight.weights[g][k] > 0)
        return false;
    }
  if (!scene::is_multiplied(lit, *scene, groups, factors)) return false;
  relight.scene = std::move(scene);
  const bool same = std::all_of(factors.begin(), factors.end(), [](const vec3& f) { return f == vec3(1); });
  relight.written = same ? std::vector<vec3>() : std::move(factors);
  relight.baked = same ? "" : "lights";
  return true;
}

void keep_written(Relight& relight, const Relight& before) {
  if (before.written.empty() || !relight.separate || relight.scene != before.scene ||
      *relight.groups != *before.groups)
    return;
  relight.written = before.written, relight.baked = before.baked, relight.lit = before.lit;
  for (size_t g = 0; g < relight.written.size(); ++g) relight.weights[g] *= relight.written[g];
}

void remix(Relight& relight, const std::string& text) {
  const scene::LightMix mix = scene::parse_mix(text);
  relight.messages = relight.groups->messages;
  for (const std::string& name : scene::unknown_groups(mix, *relight.groups))
    relight.messages.push_back(unknown_group(name, *relight.groups));
  weigh(relight, mix);
}

std::vector<std::string> new_messages(const Relight& relight, const Relight& before) {
  std::vector<std::string> all;
  std::copy_if(relight.messages.begin(), relight.messages.end(), std::back_inserter(all),
               [&](const std::string& message) {
                 return std::find(before.messages.begin(), before.messages.end(), message) ==
                        before.messages.end();
               });
  return all;
}

}  // namespace lucerna::session
