#include "effects_block.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "commands/text.h"
#include "plan/facts.h"
#include "session/effect_costs.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// Those of the setting effects.off; none if it is invalid.
std::vector<std::string> effects_off(const Controls& controls) {
  try {
    return plan::parse_effects(controls.open.setting("effects.off"), "effects.off");
  } catch (const Error&) {
    return {};
  }
}

using Costs = session::EffectCosts;

/// Null if the effect was not measured.
const session::EffectCost* cost_of(const Costs* costs, std::string_view key) {
  if (!costs) return nullptr;
  const auto at = std::find_if(costs->effects.begin(), costs->effects.end(),
                               [&](const session::EffectCost& cost) { return cost.key == key; });
  return at == costs->effects.end() ? nullptr : &*at;
}

/// "38 ms", or "-2.1 ms"; with a sign of approximation if it is uncertain.
std::string cost_text(const session::EffectCost& cost) {
  const bool certain = std::abs(cost.ms) > 2 * cost.ms_error;
  return fmt::format("{}{:.{}f} ms", certain ? "" : "\xE2\x89\x88 ", cost.ms,
                     std::abs(cost.ms) < 9.95 ? 1 : 0);
}

std::string part_text(const session::EffectCost& cost, double sample_ms) {
  return fmt::format(
      "\nCosts {:.1f} ± {:.1f} ms per sample, {:.0f} % of it.\nBrings {:.1f} % of the light; without it the "
      "picture changes by {:.1f} %.\n{:.0f} % of the noise of paths is here.",
      cost.ms, cost.ms_error, sample_ms > 0 ? 100 * cost.ms / sample_ms : 0, 100 * cost.part.light,
      100 * cost.part.seen, 100 * cost.part.noise);
}

/// Command that selects an object which proves an effect; "" if it is none that can be selected.
std::string selection_of(const scene::Scene& scene, const plan::Evidence& evidence) {
  using Kind = plan::Evidence::Kind;
  switch (evidence.kind) {
    case Kind::material:
      return commands::line("select material", evidence.index + 1);
    case Kind::lamp:
      return commands::line("select light", evidence.index + 1);
    case Kind::mesh:
      for (size_t i = 0; i < scene.instances.size(); ++i)
        if (scene.instances[i].mesh == evidence.index) return commands::line("select object", i + 1);
      return "";
    default:
      return "";
  }
}

/// Selects the next of the objects that prove an effect, after the one that a click selected last.
void select_evidence(Controls& controls, const plan::Effect& effect) {
  int* next = ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("##next"), 0);
  for (size_t tried = 0; tried < effect.evidence.size(); ++tried) {
    const plan::Evidence& evidence = effect.evidence[size_t((*next)++) % effect.evidence.size()];
    const std::string line = selection_of(*controls.open.scene, evidence);
    if (line.empty()) continue;
    controls.actions.act_line(line);
    return;
  }
}

bool is_selectable(const plan::Effect& effect) {
  using Kind = plan::Evidence::Kind;
  return std::any_of(effect.evidence.begin(), effect.evidence.end(), [](const plan::Evidence& e) {
    return e.kind == Kind::material || e.kind == Kind::lamp || e.kind == Kind::mesh;
  });
}

/// A row: the effect with its cost and, at the right end, its switch; below it the objects that call for it.
void effect_row(Controls& controls, const plan::Effect& effect, std::vector<std::string> off,
                const Costs* costs, float width) {
  const std::string key(effect.key);
  const auto at_off = std::find(off.begin(), off.end(), key);
  const bool on = at_off == off.end();
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushID(key.c_str());
  if (effect.can_be_off) {
    ImGui::SetCursorScreenPos({at.x + width - px(22), at.y});
    if (sign_button("##on", Sign::power, on)) {
      if (on)
        off.push_back(key);
      else
        off.erase(at_off);
      controls.act("set", std::string("effects.off"), fmt::format("{}", fmt::join(off, ", ")));
    }
    tooltip(fmt::format("{} this effect everywhere in the scene (effects.off). The picture starts again.",
                        on ? "Leaves out" : "Restores"));
  }
  ImGui::SetCursorScreenPos(at);
  const session::EffectCost* cost = cost_of(costs, effect.key);
  if (ImGui::InvisibleButton("##effect", {width - px(26), px(36)})) select_evidence(controls, effect);
  tooltip(fmt::format(
      "{}\nSwitches on: {}.\nCalled for by {}.{}{}", effect.label, effect.switches,
      plan::evidence_text(effect, 12), cost ? part_text(*cost, costs->sample_ms) : "",
      is_selectable(effect) ? "\nA click selects the first of them; further clicks the next." : ""));
  const std::string ms = cost && on ? cost_text(*cost) : "";
  const float room = width - px(26) - (ms.empty() ? 0 : text_width(ms) + px(8));
  draw_text(list, at, {at.x + width - px(26), at.y + px(20)}, elided(std::string(effect.label), room),
            on ? colour::text : colour::text_faint);
  draw_text(list, at, {at.x + width - px(26), at.y + px(20)}, ms, colour::text_dim, Align::right);
  draw_text(list, {at.x, at.y + px(17)}, {at.x + width - px(26), at.y + px(36)},
            on ? elided(plan::evidence_text(effect), width - px(26)) : "off", colour::text_faint);
  ImGui::SetCursorScreenPos({at.x, at.y + px(40)});
  ImGui::PopID();
}

/// The button that measures, and what the result is of.
void measure_row(Controls& controls, bool measures, const Costs* costs) {
  if (button("##measure",
             measures ? "Stop measuring"
             : costs  ? "Measure costs again"
                      : "Measure costs",
             measures))
    controls.act(measures ? "effects.stop" : "effects.measure");
  tooltip(
      "Traces small pictures of this view with and without each effect, for about a minute: what it costs "
      "per "
      "sample, how much light and noise are in it. The picture waits meanwhile.");
  gap(4);
  if (!costs) return;
  paragraph(fmt::format("Cost of a path-traced sample of {}x{}: {:.0f} ms; the parts may overlap.",
                        costs->width, costs->height, costs->sample_ms),
            colour::text_faint);
  gap(4);
}

}  // namespace

void draw_effects(Controls& controls) {
  const plan::SceneFacts* facts = controls.open.facts();
  if (!facts) return;
  const float width = ImGui::CalcItemWidth();
  const std::vector<std::string> off = effects_off(controls);
  std::vector<std::string_view> missing;
  std::vector<const plan::Effect*> rows;
  for (const plan::Effect& effect : facts->effects)
    if (effect.called_for())
      rows.push_back(&effect);
    else
      missing.push_back(effect.label);
  const session::Snapshot* picture = controls.open.snapshot.get();
  const Costs* costs = picture ? picture->effect_costs.get() : nullptr;
  measure_row(controls, picture && picture->measures_effects, costs);
  if (costs)
    std::stable_sort(rows.begin(), rows.end(), [&](const plan::Effect* a, const plan::Effect* b) {
      const session::EffectCost *ca = cost_of(costs, a->key), *cb = cost_of(costs, b->key);
      return ca && cb ? ca->ms > cb->ms : ca && !cb;
    });
  const plan::EffectGroup* last = nullptr;
  for (const plan::Effect* effect : rows) {
    if (!costs && (!last || *last != effect->group)) {
      gap(last ? 4 : 0);
      paragraph(std::string(plan::group_name(effect->group)));
      gap(2);
    }
    last = &effect->group;
    effect_row(controls, *effect, off, costs, width);
  }
  gap(4);
  paragraph(fmt::format("Not called for: {}.", fmt::join(missing, ", ")), colour::text_faint);
}

}  // namespace lucerna::ui
