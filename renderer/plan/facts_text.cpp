#include "plan/facts_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace lucerna::plan {
namespace {

bool is_off(const Effect& effect, const std::vector<std::string>& off) {
  return std::find(off.begin(), off.end(), effect.key) != off.end();
}

}  // namespace

std::string effects_text(const SceneFacts& facts, const std::vector<std::string>& off) {
  std::string text = "effects that the scene calls for, and what proves it:\n";
  const EffectGroup* last = nullptr;
  for (const Effect& e : facts.effects) {
    if (!e.called_for()) continue;
    if (!last || *last != e.group) text += fmt::format("  {}\n", group_name(e.group));
    last = &e.group;
    text += fmt::format("    {:<36}{}{}\n", e.label, evidence_text(e), is_off(e, off) ? "  (off)" : "");
  }
  text += "not called for:\n";
  for (const Effect& e : facts.effects)
    if (!e.called_for()) text += fmt::format("    {:<36}{}\n", e.label, e.missing);
  return text;
}

nlohmann::ordered_json effects_json(const SceneFacts& facts, const std::vector<std::string>& off) {
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const Effect& e : facts.effects) {
    nlohmann::ordered_json evidence = nlohmann::ordered_json::array();
    for (const Evidence& object : e.evidence)
      evidence.push_back({{std::string(kind_name(object.kind)), object.name}});
    nlohmann::ordered_json& item = all[std::string(e.key)];
    item = {{"label", e.label}, {"called_for", e.called_for()}, {"switches", e.switches}};
    if (e.called_for())
      item["evidence"] = evidence;
    else
      item["missing"] = e.missing;
    if (e.can_be_off) item["off"] = is_off(e, off);
  }
  return all;
}

}  // namespace lucerna::plan
