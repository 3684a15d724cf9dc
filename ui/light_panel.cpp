// The panel on the left: the four components of light, and the options of the renderer.
#include <fmt/format.h>

#include <algorithm>

#include "chart.h"
#include "effects_block.h"
#include "layers_block.h"
#include "panel_block.h"
#include "plan/plan.h"
#include "solvers/registry.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

const char* meaning(int component) {
  static const char* texts[] = {
      "Primary: emitters and direct light, also seen in mirrors and through glass.",
      "Secondary: light after one diffuse interreflection.",
      "Tertiary: light after further diffuse interreflections, and caustics seen in it.",
      "Caustic: light focused on diffuse surfaces by mirrors and glass."};
  return texts[component];
}

/// The meaning of a value of a component's setting: a solver's name, two joined by a plus, auto, or off.
std::string solver_help(int component, const std::string& value) {
  if (value == "off")
    return "Off: the component is missing; its paths are traced only where other components need them.";
  if (value == plan::k_auto)
    return "Auto: chosen once for the scene, by what it contains and by the first samples of paths; in the "
           "window for a good picture within half a minute. Edits do not change the choice; choosing another "
           "solver and then auto does.";
  const size_t plus = value.find('+');
  const solvers::SolverInfo* solver = solvers::find(value.substr(0, plus));
  std::string first = solver ? solver->help : "";
  if (component == 0 && solver && !solver->primary_part.empty())
    first += fmt::format(" Of primary light it computes {}{}; paths compute the rest.", solver->primary_part,
                         solver->primary_with_secondary ? ", together with secondary light" : "");
  if (plus == std::string::npos) return first;
  const solvers::SolverInfo* other = solvers::find(value.substr(plus + 1));
  return first + (other ? " " + other->help : std::string());
}

void component_row(Controls& controls, int c, float width) {
  const auto index = static_cast<size_t>(c);
  const std::string name = session::k_component_names[index];
  const std::string key = "components." + name;
  const session::ComponentStatus* status =
      controls.open.snapshot ? &controls.open.snapshot->components[index] : nullptr;
  const bool off = controls.open.setting(key) == "off";
  const bool shown = controls.open.setting_on("show." + name);
  const ImU32 ink =
      off || !shown ? colour::with_alpha(colour::component[index], 0.4f) : colour::component[index];

  ImGui::PushID(c);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  // First line: colour, name, share; toggles at the right end.
  list->AddRectFilled({at.x, at.y + px(6)}, {at.x + px(10), at.y + px(16)}, ink, px(2));
  ImGui::SetCursorScreenPos({at.x, at.y});
  ImGui::InvisibleButton("##name", {px(104), px(22)});
  tooltip(meaning(c));
  std::string title = name;
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  draw_text(list, {at.x + px(18), at.y}, {at.x + px(112), at.y + px(22)}, title,
            off ? colour::text_faint : colour::text, Align::left, theme().fonts.strong);
  ImGui::SetCursorScreenPos({at.x + width - px(48), at.y});
  if (sign_button("##show", Sign::eye, shown)) controls.act("view.show", name, !shown);
  tooltip(
      fmt::format("{} the {} layer in the displayed sum. Keeps all samples; the computation does not change.",
                  shown ? "Hides" : "Shows", name));
  ImGui::SetCursorScreenPos({at.x + width - px(22), at.y});
  if (sign_button("##solo", Sign::solo, controls.open.solo() == c, colour::accent))
    controls.act("view.solo", controls.open.solo() == c ? "none" : name.c_str());
  tooltip(controls.open.solo() == c
              ? "Shows the previous layers again."
              : fmt::format("Shows the {} layer only; press again for the previous layers.", name));

  // Second line: solver, share, device time.
  const float line = at.y + px(26);
  ImGui::SetCursorScreenPos({at.x + px(18), line});
  const OptionInfo* option = plan::find_option(key);
  float solver_width = px(76);
  if (option) {
    // Two joined names are long: they take the place of the time.
    const std::string& chosen_name = controls.open.setting(key);
    const float beside = chosen_name.find('+') == std::string::npos ? px(154) : px(102);
    for (const std::string& solver : option->choices)
      if (solver == chosen_name || solver.find('+') == std::string::npos)
        solver_width = std::max(solver_width, text_width(solver) + px(36));
    // Where the program chooses: what it has chosen, in parentheses if there is no room to say so.
    std::string shown;
    if (chosen_name == plan::k_auto && status && !status->solver.empty()) {
      shown = fmt::format("{}: {}", plan::k_auto, status->solver);
      if (text_width(shown) + px(36) > width - beside) shown = fmt::format("({})", status->solver);
      solver_width = std::max(solver_width, text_width(shown) + px(36));
    }
    solver_width = std::min(solver_width, std::max(px(76), width - beside));
    int chosen = static_cast<int>(
        std::find(option->choices.begin(), option->choices.end(), controls.open.setting(key)) -
        option->choices.begin());
    std::vector<std::string> helps;
    for (const std::string& solver : option->choices) helps.push_back(solver_help(c, solver));
    const std::string help =
        option->help + (static_cast<size_t>(chosen) < helps.size() ? " " + helps[size_t(chosen)] : "");
    if (choice("##solver", "", option->choices, chosen, solver_width, helps, shown))
      controls.act("set", key, option->choices[static_cast<size_t>(chosen)]);
    tooltip(status && !status->reason.empty()
                ? fmt::format("{}\n\nChosen: {}. {}.", help, status->solver, status->reason)
                : help);
  }
  const float right = at.x + width;
  const bool known = status && !off && controls.open.snapshot->samples > 0;
  const double error =
      known && controls.open.snapshot->accuracy ? controls.open.snapshot->accuracy->error()[index + 1] : 0;
  const double noise_share =
      error > 0 ? controls.open.snapshot->accuracy->ledger.entries().back().share(c) : 0;
  // The share is beside the name; error and time beside the solver.
  if (width > px(200))
    draw_text(list, {at.x + px(100), at.y}, {at.x + width - px(56), at.y + px(22)},
              known ? fmt::format("{:.1f} %", 100 * status->share) : "\xE2\x80\x93",
              known ? colour::text : colour::text_faint, Align::right);
  const float figures = at.x + px(24) + solver_width;
  const float time = right - figures > px(120) ? px(66) : 0;
  draw_text(list, {figures, line}, {right - time, line + px(24)},
            error > 0 ? percent_text(error) : "\xE2\x80\x93", error > 0 ? colour::text : colour::text_faint,
            Align::right);
  draw_text(list, {right - time, line}, {right, line + px(24)},
            known ? ms_text(status->ms_per_sample) : "\xE2\x80\x93",
            known ? colour::text_dim : colour::text_faint, Align::right);
  ImGui::SetCursorScreenPos({figures, line});
  ImGui::InvisibleButton("##figures", {std::max(1.0f, right - figures), px(24)});
  tooltip(known ? fmt::format("Estimated noise of this component as seen: root mean square over the pixels, "
                              "each relative to the light around it. It is {:.0f} % of the picture's noise "
                              "(squared). Next to it the device time of its rays per sample of a pixel. Its "
                              "share of the light is {:.1f} %, its mean luminance {:.4g}.",
                              100 * noise_share, 100 * status->share, status->mean_luminance)
                : "Not measured yet, or the component is off.");

  // Third line: the share as a bar.
  ImGui::SetCursorScreenPos({at.x + px(18), at.y + px(54)});
  stacked_bar({{known ? static_cast<float>(status->share) : 0, ink}}, 3, width - px(18));
  ImGui::SetCursorScreenPos({at.x, at.y + px(68)});
  ImGui::PopID();
}

void components(Controls& controls, float width) {
  const std::string &primary = controls.open.setting("components.primary"),
                    &secondary = controls.open.setting("components.secondary"),
                    &tertiary = controls.open.setting("components.tertiary");
  for (const int c : k_components) {
    component_row(controls, c, width);
    if (c == 0 && plan::primary_by_paths(primary, secondary, tertiary)) {
      paragraph(
          fmt::format("Computed by paths: '{}' serves primary light only with secondary light.", primary));
      gap(8);
    }
  }
  // The sum: stacked times of all components.
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  double total = 0, luminance = 0;
  if (controls.open.snapshot && controls.open.snapshot->samples > 0)
    for (const session::ComponentStatus& status : controls.open.snapshot->components)
      total += status.ms_per_sample, luminance += status.mean_luminance;
  draw_text(list, {at.x + px(18), at.y}, {at.x + width, at.y + px(20)}, "Time per sample", colour::text_dim);
  draw_text(list, at, {at.x + width, at.y + px(20)}, total > 0 ? ms_text(total) : "\xE2\x80\x93",
            total > 0 ? colour::text : colour::text_faint, Align::right);
  ImGui::SetCursorScreenPos({at.x + px(18), at.y + px(24)});
  std::vector<Part> parts;
  if (total > 0)
    for (const size_t c : k_components)
      parts.push_back({static_cast<float>(controls.open.snapshot->components[c].ms_per_sample / total),
                       colour::component[c]});
  stacked_bar(parts, 6, width - px(18));
  tooltip(
      "Device time per sample of a pixel, divided among the components: amber primary, teal secondary, "
      "violet tertiary, coral caustic.");
  ImGui::SetCursorScreenPos({at.x, at.y + px(40)});
}

/// True if an option is shown elsewhere in the window, or nowhere: texts that belong to the scene.
bool placed_elsewhere(const OptionInfo& option) {
  for (const char* head : {"components.", "show.", "film.", "overlay."})
    if (option.key.rfind(head, 0) == 0) return true;
  return option.type == OptionType::text || solvers::owner_of(option.key);
}

/// The options of the render, and its buttons.
void render_rows(Controls& controls) {
  for (const OptionInfo& option : plan::options())
    if (!placed_elsewhere(option)) option_control(controls, option.key, option_label(option));
  gap(4);
  const float width = ImGui::CalcItemWidth(), half = std::floor(0.5f * (width - px(8)));
  const bool paused = controls.open.snapshot && controls.open.snapshot->paused;
  ImGui::BeginDisabled(!controls.open.snapshot);
  if (button("##pause", paused ? "Resume" : "Pause", paused, half))
    controls.act(paused ? "render.resume" : "render.pause");
  tooltip("Pauses sampling; Resume continues with the present samples. Space.");
  ImGui::SameLine(0, px(8));
  if (button("##restart", "Restart", false, width - half - px(8))) controls.act("render.restart");
  tooltip("Discards all samples and restarts the picture. R.");
  ImGui::EndDisabled();
}

}  // namespace

void draw_light_panel(Controls& controls, TypedLayer& typed_layer, bool expanded, const Area& area) {
  if (!expanded) {
    begin_panel("##light_folded", area, colour::panel, false);
    if (folded_strip("Light", area.lo, area.hi, true)) controls.act("window.fold", "left", false);
    ImGui::End();
    return;
  }
  begin_panel("##light", area, colour::panel, true);
  std::string note;
  if (controls.open.solo() >= 0)
    note = fmt::format("solo {}", session::k_component_names[static_cast<size_t>(controls.open.solo())]);
  panel_block(controls, "Light", true, note, 4, [&] { components(controls, ImGui::CalcItemWidth()); });
  if (controls.open.scene)
    panel_block(controls, "Light mix", false, controls.open.setting("relight.mix").empty() ? "" : "mixed", 10,
                [&] {
                  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(8), px(2)});
                  draw_mix(controls.actions, controls.open);
                  ImGui::PopStyleVar();
                });
  if (controls.open.scene)
    panel_block(controls, "Effects", false,
                controls.open.setting("effects.off").empty() ? "" : "some are off", 8,
                [&] { draw_effects(controls); });
  if (controls.open.scene)
    panel_block(controls, "Layers", false, layer_count(controls), 10,
                [&] { draw_layers(controls, typed_layer); });
  panel_block(controls, "Render", true, "", 12, [&] { render_rows(controls); });
  hairline();
  ImGui::End();
}

}  // namespace lucerna::ui
