// The verb info: contents of a scene, its effects, and the pilot's findings.
#include <cstdio>

#include "app/size.h"
#include "app/verbs.h"
#include "base/json_text.h"
#include "base/log.h"
#include "plan/facts_text.h"
#include "scene/io/load.h"
#include "session/effect_measurement.h"
#include "session/renderer.h"

namespace lucerna::app {
namespace {

using Json = nlohmann::ordered_json;
constexpr double k_targets[] = {0.05, 0.02, 0.01};

/// The pilot's result for a picture.
struct Piloted {
  solvers::Findings findings;
  ByComponent<plan::Choice> choices;
  uint32_t width = 0, height = 0;
};

/// Loads the scene for the picture of the arguments; `changes`: settings before those of --set.
void load_picture(session::Renderer& r, const InfoArguments& a, std::vector<session::SettingChange> changes) {
  const auto [width, height] = parse_size(a.size);
  r.set_size(width, height);
  for (const std::string& change : a.set) {
    const auto [key, value] = split_change(change, "--set");
    changes.push_back({key, value, "--set"});
  }
  r.load(a.scene, {}, changes);
  if (!a.camera.empty()) r.choose_camera(a.camera);
}

session::EffectCosts measure_costs(const InfoArguments& a) {
  const session::RendererOptions options{.device = a.device, .scenes = a.scenes};
  session::Renderer r(options);
  load_picture(r, a, {});
  session::EffectMeasurement measurement(r, options);
  std::string activity;
  while (!measurement.done()) {
    if (measurement.activity() != std::exchange(activity, measurement.activity()))
      log::info("{} ({:.0f} %)", activity, 100 * measurement.progress());
    measurement.step({});
  }
  return measurement.take();
}

Piloted run_pilot(const InfoArguments& a) {
  Piloted result;
  std::tie(result.width, result.height) = parse_size(a.size);
  session::Renderer r({.device = a.device, .scenes = a.scenes});
  std::vector<session::SettingChange> changes;
  for (const char* name : paths::k_component_names)
    changes.push_back({std::string("components.") + name, plan::k_auto, "info"});
  load_picture(r, a, std::move(changes));
  while (r.choosing() && r.step()) {
  }
  if (r.findings()) result.findings = *r.findings();
  result.choices = r.choices();
  return result;
}

/// Share of the noise of paths, 0..1.
double noise_share(const solvers::Findings& findings, size_t component) {
  double sum = 0;
  for (const auto& c : findings.components) sum += c.variance;
  return sum > 0 ? findings.components[component].variance / sum : 0;
}

std::string pilot_text(const Piloted& p) {
  const bool measured = p.findings.pixels > 0;
  std::string text =
      fmt::format("solvers that auto chooses for a picture of {}x{}:\n    {:<11}{:>7}{:>7}  solver\n",
                  p.width, p.height, "", "light", "noise");
  for (size_t c = 0; c < p.choices.size(); ++c) {
    const auto figure = [&](double share) {
      return measured ? fmt::format("{:.1f} %", 100 * share) : std::string("-");
    };
    text += fmt::format("    {:<11}{:>7}{:>7}  {}{}\n", paths::k_component_names[c],
                        figure(p.findings.components[c].energy), figure(noise_share(p.findings, c)),
                        p.choices[c].solver, p.choices[c].reason.empty() ? "" : ": " + p.choices[c].reason);
  }
  if (!measured) return text + "    no pilot was needed\n";
  text += fmt::format("    a path-traced sample of all pixels: about {:.2g} s\n", p.findings.seconds);
  for (const double error : k_targets)
    if (const auto cost = plan::predicted_cost(p.findings, p.choices, error))
      text += fmt::format("    error of {:g} %: about {:.2g} s\n", 100 * error, *cost * p.findings.seconds);
    else
      text += fmt::format("    error of {:g} %: not with these solvers\n", 100 * error);
  return text;
}

Json pilot_json(const Piloted& p) {
  Json json{{"width", p.width}, {"height", p.height}, {"seconds_a_sample", p.findings.seconds}};
  for (size_t c = 0; c < p.choices.size(); ++c)
    json["components"][paths::k_component_names[c]] = {{"light", p.findings.components[c].energy},
                                                       {"variance", p.findings.components[c].variance},
                                                       {"solver", p.choices[c].solver},
                                                       {"reason", p.choices[c].reason}};
  for (const double error : k_targets) {
    const auto cost = plan::predicted_cost(p.findings, p.choices, error);
    json["forecast"].push_back(
        {{"error", error}, {"seconds", cost ? Json(*cost * p.findings.seconds) : Json(nullptr)}});
  }
  return json;
}

}  // namespace

int info(const InfoArguments& a) {
  const scene::Scene scene = scene::load(a.scene, a.scenes);
  const plan::SceneFacts facts = plan::facts_of(scene);
  std::optional<Piloted> pilot;
  if (a.pilot) pilot = run_pilot(a);
  std::optional<session::EffectCosts> costs;
  if (a.cost) costs = measure_costs(a);
  if (a.json) {
    Json all = scene::describe(scene);
    all["effects"] = plan::effects_json(facts);
    if (pilot) all["pilot"] = pilot_json(*pilot);
    if (costs) all["costs"] = session::costs_json(*costs);
    std::printf("%s\n", json_text(all, 2).c_str());
  } else {
    std::printf("%s%s%s%s", scene::describe_text(scene).c_str(), plan::effects_text(facts).c_str(),
                costs ? session::costs_text(*costs).c_str() : "", pilot ? pilot_text(*pilot).c_str() : "");
  }
  return 0;
}

}  // namespace lucerna::app
