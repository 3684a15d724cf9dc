#include "effects_block.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "plan/facts.h"
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

/// A row: the effect and, at the right end, its switch; below it the objects that call for it.
void effect_row(Controls& controls, const plan::Effect& effect, std::vector<std::string> off, float width) {
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
  ImGui::InvisibleButton("##effect", {width - px(26), px(36)});
  tooltip(fmt::format("{}\nSwitches on: {}.\nCalled for by {}.", effect.label, effect.switches,
                      plan::evidence_text(effect, 12)));
  draw_text(list, at, {at.x + width - px(26), at.y + px(20)},
            elided(std::string(effect.label), width - px(26)), on ? colour::text : colour::text_faint);
  draw_text(list, {at.x, at.y + px(17)}, {at.x + width - px(26), at.y + px(36)},
            on ? elided(plan::evidence_text(effect), width - px(26)) : "off", colour::text_faint);
  ImGui::SetCursorScreenPos({at.x, at.y + px(40)});
  ImGui::PopID();
}

}  // namespace

void draw_effects(Controls& controls) {
  const plan::SceneFacts* facts = controls.open.facts();
  if (!facts) return;
  const float width = ImGui::CalcItemWidth();
  const std::vector<std::string> off = effects_off(controls);
  std::vector<std::string_view> missing;
  const plan::EffectGroup* last = nullptr;
  for (const plan::Effect& effect : facts->effects) {
    if (!effect.called_for()) {
      missing.push_back(effect.label);
      continue;
    }
    if (!last || *last != effect.group) {
      gap(last ? 4 : 0);
      paragraph(std::string(plan::group_name(effect.group)));
      gap(2);
    }
    last = &effect.group;
    effect_row(controls, effect, off, width);
  }
  gap(4);
  paragraph(fmt::format("Not called for: {}.", fmt::join(missing, ", ")), colour::text_faint);
}

}  // namespace lucerna::ui
