#include "controls.h"

#include <fmt/format.h>

#include <algorithm>

#include "chart.h"
#include "plan/settings.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// As many as in the default value, at least two.
int decimals_of(const OptionInfo& option) {
  const size_t point = option.fallback.find('.');
  return point == std::string::npos ? 2 : std::max(2, int(option.fallback.size() - point) - 1);
}

/// True if the name contains the unit: "Samples 256", not "Samples 256 samples".
bool named_by_unit(std::string name, const std::string& unit) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return !unit.empty() && (" " + name + " ").find(" " + unit + " ") != std::string::npos;
}

}  // namespace

bool Controls::view_on(const solvers::ViewInfo& view) const {
  const std::string& value = open.setting(view.option);
  return value != "false" && value != "off";
}

void Controls::turn_view(const solvers::ViewInfo& view) {
  const OptionInfo* option = plan::find_option(view.option);
  if (!option) return;
  if (option->type != OptionType::choice) return actions.toggle(view.option);
  const std::vector<std::string>& ring = view.ring.empty() ? option->choices : view.ring;
  // A value outside the ring counts as on: off is next.
  const auto at = std::find(ring.begin(), ring.end(), open.setting(view.option));
  act("set", view.option, at == ring.end() || at + 1 == ring.end() ? ring.front() : *(at + 1));
}

bool panel_section(Controls& controls, const char* title, bool fallback, const std::string& note) {
  const auto found = controls.sections.find(title);
  const bool open = found == controls.sections.end() ? fallback : found->second;
  bool wanted = open;
  section(title, wanted, note);
  if (wanted != open) controls.act("window.section", title, wanted);
  return open;
}

void option_control(Controls& controls, const std::string& key, const std::string& name) {
  const OptionInfo* option = plan::find_option(key);
  if (!option) return;
  ImGui::PushID(key.c_str());
  std::string help = option->help;
  if (option->type == OptionType::integer || option->type == OptionType::real)
    help += fmt::format(" From {:.12g} to {:.12g}{}{}.", option->lo, option->hi,
                        option->unit.empty() ? "" : " ", option->unit);
  if (option->restarts) help += " A change restarts the picture.";
  switch (option->type) {
    case OptionType::choice: {
      int chosen = static_cast<int>(
          std::find(option->choices.begin(), option->choices.end(), controls.open.setting(key)) -
          option->choices.begin());
      if (choice("##choice", name, option->choices, chosen))
        controls.act("set", key, option->choices[static_cast<size_t>(chosen)]);
      break;
    }
    case OptionType::boolean:
      if (button("##boolean", name, controls.open.setting_on(key), ImGui::CalcItemWidth()))
        controls.actions.toggle(key);
      break;
    case OptionType::integer:
    case OptionType::real: {
      const bool whole = option->type == OptionType::integer;
      auto value = static_cast<float>(controls.open.setting_real(key));
      Slider how{.lo = static_cast<float>(option->lo),
                 .hi = static_cast<float>(option->hi),
                 .decimals = whole ? 0 : decimals_of(*option),
                 .unit = option->unit,
                 .at_zero = option->at_zero};
      how.log = option->lo > 0 ? option->hi / option->lo > 100 : !option->at_zero.empty() && option->hi > 100;
      if (named_by_unit(name, option->unit)) how.unit.clear();
      if (whole) how.step = 1;
      if (option->hi > 4e9)
        how.hi = 65535, how.bar = false, how.travel = 0.01f,
        how.typed_hi = 16777215;  // seeds: a range that can be dragged
      if (slider("##number", name, value, how))
        controls.act("set", key,
                     whole ? fmt::format("{:.0f}", std::clamp<double>(value, option->lo, option->hi))
                           : fmt::format("{:.6g}", value));
      if (option->hi > 4e9)
        help = option->help + " Double-click to type; drag up to 65535. A change restarts the picture.";
      break;
    }
    case OptionType::text:
      break;
  }
  tooltip(help);
  ImGui::PopID();
}

bool position_row(const Box& core, vec3& position) {
  const vec3 middle = core.empty() ? vec3(0) : core.centre();
  const float radius = std::max(core.empty() ? 1.0f : core.radius(), 1e-2f);
  const float reach = 4 * radius + glm::length(middle);
  return slider_row("##position", "Position", position,
                    {.lo = -reach,
                     .hi = reach,
                     .decimals = radius < 1 ? 3 : 2,
                     .bar = false,
                     .travel = 0.25f * radius / reach,
                     .typed_lo = -1e6f,
                     .typed_hi = 1e6f}) >= 0;
}

const ChoiceButton* choice_buttons(const std::string& prefix, std::span<const ChoiceButton> buttons,
                                   size_t on) {
  const auto count = static_cast<float>(buttons.size());
  const float width = (ImGui::CalcItemWidth() - (count - 1) * px(4)) / count;
  const ChoiceButton* pressed = nullptr;
  for (size_t i = 0; i < buttons.size(); ++i) {
    if (i > 0) ImGui::SameLine(0, px(4));
    const ChoiceButton& b = buttons[i];
    if (button(fmt::format("##{}_{}", prefix, b.name).c_str(), b.title, i == on, width)) pressed = &b;
    tooltip(b.help);
  }
  return pressed;
}

}  // namespace lucerna::ui
