// The light mix: every light group with its strength, colour, mute and solo, and named presets.
#include <fmt/format.h>

#include <cmath>

#include "base/blackbody.h"
#include "base/color.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

std::string members(const scene::LightGroup& group) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  const auto count = [&](uint32_t n, const char* what) {
    if (n > 0) add(fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"));
  };
  if (group.sky) add("the environment's sky");
  if (group.sun) add("the environment's sun");
  count(group.lamps, "lamp"), count(group.surfaces, "surface");
  return text.empty() ? "no light" : text;
}

void group_row(Actions& actions, const scene::LightGroup& group, const scene::GroupMix& mix, bool silent) {
  const float width = ImGui::CalcItemWidth();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  const vec3 tint = tint_of(mix.color);
  list->AddRectFilled({at.x, at.y + px(6)}, {at.x + px(10), at.y + px(16)},
                      colour::with_alpha(display_colour(tint), silent ? 0.3f : 1.0f), px(2));
  list->AddRect({at.x, at.y + px(6)}, {at.x + px(10), at.y + px(16)}, colour::grey(80), px(2));
  ImGui::InvisibleButton("##name", {std::max(1.0f, width - px(52)), px(22)});
  tooltip(fmt::format("{}: {}.", group.name, members(group)));
  draw_text(list, {at.x + px(18), at.y}, {at.x + width - px(52), at.y + px(22)},
            elided(group.name, width - px(70)), silent ? colour::text_faint : colour::text);
  ImGui::SetCursorScreenPos({at.x + width - px(48), at.y});
  if (sign_button("##mute", Sign::power, !mix.mute))
    actions.act("mix.set", group.name, named("mute", !mix.mute));
  tooltip(mix.mute ? "Switches the group's light on again."
                   : "Mutes the group: removes its light from the picture.");
  ImGui::SetCursorScreenPos({at.x + width - px(22), at.y});
  if (sign_button("##solo", Sign::solo, mix.solo, colour::accent))
    actions.act("mix.set", group.name, named("solo", !mix.solo));
  tooltip(mix.solo ? "Shows all groups again." : "Solo: shows the light of this group only.");
  ImGui::SetCursorScreenPos({at.x, at.y + px(24)});
  float ev = mix.ev;
  ImGui::BeginDisabled(mix.mute);
  if (slider("##ev", fmt::format("\xC3\x97 {:.3g}", std::exp2(mix.ev)), ev,
             {.lo = -8,
              .hi = 8,
              .decimals = 2,
              .unit = "EV",
              .sign = true,
              .travel = 0.5f,
              .typed_lo = -scene::k_most_ev,
              .typed_hi = scene::k_most_ev}))
    actions.act("mix.set", group.name, named("ev", ev));
  tooltip("Strength of the group in exposure values: a factor of 2 to this power.");
  vec3 picked = tint;
  const float half = std::floor(0.5f * (width - px(6)));
  ImGui::PushItemWidth(half);
  const float line = ImGui::GetCursorScreenPos().y;
  if (colour_field("##tint", "Tint", picked) && strength_of(picked) > 0)
    actions.act("mix.set", group.name, named("color", tint_of(picked)));
  ImGui::PopItemWidth();
  tooltip("Multiplies the colour of the group's lights; white keeps it. Press to choose a colour.");
  const NearestKelvin nearest = nearest_kelvin(tint);
  float kelvin = nearest.kelvin;
  ImGui::SetCursorScreenPos({at.x + half + px(6), line});
  if (slider("##kelvin", "", kelvin,
             {.lo = k_coolest_kelvin,
              .hi = k_hottest_kelvin,
              .log = true,
              .decimals = 0,
              .unit = "K",
              .bar = nearest.off < 0.02f,
              .step = 10,
              .travel = 0.5f},
             width - half - px(6)))
    actions.act("mix.set", group.name, named("kelvin", kelvin));
  tooltip("Tints by the colour of a black body of this temperature; 6500 K is nearly white.");
  ImGui::EndDisabled();
  ImGui::SetCursorScreenPos({at.x, ImGui::GetCursorScreenPos().y});
}

/// Named mixes, and a slider between two of them.
void preset_rows(Actions& actions, const commands::OpenScene& open) {
  const scene::MixPresets presets = open.mix_presets();
  std::vector<std::string> names;
  for (const auto& [name, mix] : presets) names.push_back(name);
  const float width = ImGui::CalcItemWidth();
  std::string forgotten;
  int row = 0;
  for (const auto& [name, mix] : presets) {
    ImGui::PushID(row++);
    const bool chosen = scene::mix_text(mix) == scene::mix_text(open.light_mix());
    if (button("##preset", elided(name, width - px(52)), chosen, width - px(28)))
      actions.act("mix.preset.load", name);
    tooltip(fmt::format("{}: loads this mix.", name));
    ImGui::SameLine(0, px(6));
    if (sign_button("##forget", Sign::close, false)) forgotten = name;
    tooltip("Deletes this preset.");
    ImGui::PopID();
  }
  if (!forgotten.empty()) actions.act("mix.preset.delete", forgotten);
  if (names.size() >= 2) {
    static int from = 0, to = 1;
    static float amount = 0;
    from = std::min(from, static_cast<int>(names.size()) - 1),
    to = std::min(to, static_cast<int>(names.size()) - 1);
    const float half = std::floor(0.5f * (width - px(6)));
    bool moved = choice("##from", "", names, from, half);
    tooltip("The mix at the slider's left end.");
    ImGui::SameLine(0, px(6));
    moved = choice("##to", "", names, to, width - half - px(6)) || moved;
    tooltip("The mix at its right end.");
    moved = slider("##blend", "Blend", amount, {.lo = 0, .hi = 1, .decimals = 2}) || moved;
    tooltip("A mix between the two, linearly in light.");
    if (moved)
      actions.act("mix.preset.blend", names[static_cast<size_t>(from)], names[static_cast<size_t>(to)],
                  amount);
  }
  const float half = std::floor(0.5f * (width - px(6)));
  if (button("##save", "Save preset", false, half)) {
    std::string name;
    for (int n = 1; name.empty() || presets.contains(name); ++n) name = fmt::format("mix {}", n);
    actions.act("mix.preset.save", name);
  }
  tooltip("Saves this mix as a preset; mix.preset.save NAME in the console sets the name.");
  ImGui::SameLine(0, px(6));
  if (button("##reset", "Reset", false, width - half - px(6))) actions.act("mix.reset");
  tooltip("Resets all groups to the scene's light.");
  if (button("##apply", "Apply to lights", false, width)) actions.act("mix.apply");
  tooltip(
      "Sets strength and colour of the lights to the mix. The picture's light stays the same. Can be "
      "undone.");
}

}  // namespace

void draw_mix(Actions& actions, commands::OpenScene& open) {
  const scene::LightGroups& groups = open.light_groups();
  const scene::LightMix mix = open.light_mix();
  const std::vector<vec3> weights = scene::mix_weights(mix, groups);
  const std::string how = open.setting("relight.enabled");
  const bool keeps = how != "off", by_component = how == "on";
  const float both = ImGui::CalcItemWidth() - px(6), first = std::floor(0.56f * both);
  if (button("##apart", "Track light groups", keeps, first))
    actions.act("set", "relight.enabled", keeps ? "off" : "auto");
  tooltip(
      "Stores the light of each group separately, so a mix traces no ray. Takes 16 bytes per pixel and "
      "group. A change restarts the picture.");
  ImGui::SameLine(0, px(6));
  if (button("##components", "By component", by_component, both - first))
    actions.act("set", "relight.enabled", by_component ? "auto" : "on");
  tooltip(
      "Stores each group's light by component. Takes 200 bytes per pixel and group, and more time. Without "
      "it the picture of a mix is exact, but its components are estimates. A change restarts the picture.");
  const std::string why = open.snapshot ? open.snapshot->lights_together : "";
  if (!why.empty()) {
    label("A new mix restarts the picture", colour::text_faint, nullptr, ImGui::CalcItemWidth());
    tooltip("Light groups are not tracked: " + why + ".");
  }
  for (size_t g = 0; g < groups.groups.size(); ++g) {
    const auto found = mix.find(groups.groups[g].name);
    ImGui::PushID(static_cast<int>(g));
    group_row(actions, groups.groups[g], found == mix.end() ? scene::GroupMix() : found->second,
              weights[g] == vec3(0));
    ImGui::PopID();
    gap(6);
  }
  preset_rows(actions, open);
}

}  // namespace lucerna::ui
