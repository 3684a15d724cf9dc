#include "session/effect_costs.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace lucerna::session {

std::string costs_line(const EffectCosts& costs) {
  std::string text = fmt::format("effects, per path-traced sample of {}x{} ({:.0f} ms):", costs.width,
                                 costs.height, costs.sample_ms);
  for (size_t i = 0; i < std::min<size_t>(costs.effects.size(), 3); ++i)
    text += fmt::format("{} {} {:.0f} ms", i > 0 ? "," : "", costs.effects[i].label, costs.effects[i].ms);
  return text;
}

std::string costs_text(const EffectCosts& costs) {
  std::string text = fmt::format(
      "cost of effects, by leaving each out; a path-traced sample of {}x{} takes {:.0f} ms:\n"
      "    {:<36}{:>17}{:>7}{:>9}{:>8}{:>8}\n",
      costs.width, costs.height, costs.sample_ms, "", "ms a sample", "", "light", "seen", "noise");
  for (const EffectCost& e : costs.effects)
    text += fmt::format("    {:<36}{:>9.1f} ± {:<5.1f}{:>5.0f} %{:>+7.1f} %{:>6.1f} %{:>6.0f} %\n", e.label,
                        e.ms, e.ms_error, costs.sample_ms > 0 ? 100 * e.ms / costs.sample_ms : 0,
                        100 * e.part.light, 100 * e.part.seen, 100 * e.part.noise);
  return text;
}

nlohmann::ordered_json costs_json(const EffectCosts& costs) {
  nlohmann::ordered_json json{
      {"width", costs.width}, {"height", costs.height}, {"ms_a_sample", costs.sample_ms}};
  for (const EffectCost& e : costs.effects)
    json["effects"].push_back({{"effect", e.key},
                               {"ms_a_sample", e.ms},
                               {"ms_error", e.ms_error},
                               {"light", e.part.light},
                               {"seen", e.part.seen},
                               {"noise", e.part.noise}});
  return json;
}

}  // namespace lucerna::session
