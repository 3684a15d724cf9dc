#include "swatch_popup.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/color.h"
#include "commands/material_words.h"
#include "scene/display_name.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using commands::Swatch;

/// The colour that stands for a swatch: of what it absorbs, emits or reflects.
ImU32 colour_of(const std::string& words) {
  vec3 colour(0.8f);
  for (const char* key : {"absorb_color=", "color="}) {
    const size_t at = words.starts_with(key) ? 0 : words.find(std::string(" ") + key);
    if (at == std::string::npos) continue;
    const size_t begin = words.find('=', at) + 1;
    if (commands::read_vector(std::string_view(words).substr(begin, words.find(' ', begin) - begin), colour))
      break;
  }
  return display_colour(colour);
}

/// A square with a name beside it. True if it was pressed.
bool swatch_row(const Swatch& swatch, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = px(24);
  const bool pressed = ImGui::InvisibleButton("##swatch", {width, height});
  const bool hovered = ImGui::IsItemHovered();
  tooltip(swatch.words.empty() ? "matt, light grey" : swatch.words);
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (hovered) list->AddRectFilled(at, {at.x + width, at.y + height}, colour::field_hover, px(2));
  list->AddRectFilled({at.x + px(5), at.y + px(5)}, {at.x + px(19), at.y + px(19)}, colour_of(swatch.words),
                      px(2));
  list->AddRect({at.x + px(5), at.y + px(5)}, {at.x + px(19), at.y + px(19)}, colour::text_faint, px(2));
  draw_text(list, {at.x + px(26), at.y}, {at.x + width - px(4), at.y + height},
            elided(swatch.name, width - px(30)), colour::text);
  return pressed;
}

/// Rows in two columns; the words of the one that was pressed.
std::optional<std::string> rows(const std::vector<Swatch>& all, SceneView& view, bool own) {
  std::optional<std::string> pressed;
  std::string forgotten;
  const float width = px(168);
  for (size_t i = 0; i < all.size(); ++i) {
    if (i % 2 == 1) ImGui::SameLine(0, px(6));
    ImGui::PushID(int(i) + (own ? 1000 : 0));
    if (swatch_row(all[i], own ? width - px(24) : width)) pressed = all[i].words;
    if (own) {
      ImGui::SameLine(0, px(2));
      if (sign_button("##forget", Sign::close, false)) forgotten = all[i].name;
      tooltip("Forgets this swatch.");
    }
    ImGui::PopID();
  }
  if (!forgotten.empty()) view.swatches.erase(forgotten);
  return pressed;
}

void keep_row(Controls& controls, SceneView& view, uint32_t index) {
  ImGui::SetNextItemWidth(px(250));
  const bool entered = ImGui::InputTextWithHint("##name", "name for this material", &view.swatch_name,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine(0, px(6));
  ImGui::BeginDisabled(view.swatch_name.empty());
  if ((button("##keep", "Keep", false, px(80)) || entered) && !view.swatch_name.empty()) {
    view.swatches[view.swatch_name] = commands::material_words(controls.open.material_state(index));
    view.swatch_name.clear();
  }
  ImGui::EndDisabled();
  tooltip(
      "Keeps the material as a swatch, also for later runs and other scenes. Textures are kept if they came "
      "from files.");
}

}  // namespace

void swatch_popup(Controls& controls, SceneView& view, uint32_t index) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(10), px(10)});
  if (ImGui::BeginPopup(k_swatches)) {
    std::vector<Swatch> own;
    for (const auto& [name, words] : view.swatches) own.push_back({name, words});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(6), 0});
    std::optional<std::string> pressed = rows(commands::swatches(), view, false);
    if (!own.empty()) {
      gap(6);
      label("Own", colour::text_faint, theme().fonts.small);
      if (const auto chosen = rows(own, view, true)) pressed = chosen;
    }
    ImGui::PopStyleVar();
    gap(6);
    keep_row(controls, view, index);
    if (pressed) {
      controls.actions.act_line(commands::line("material.set", index + 1, commands::named("like", "plain")) +
                                (pressed->empty() ? "" : " ") + *pressed);
      ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar();
}

}  // namespace lucerna::ui
