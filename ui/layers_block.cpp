#include "layers_block.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "chart.h"
#include "list_rows.h"
#include "session/layer_status.h"
#include "theme.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// Layers that are often wanted, for the button that offers them.
struct Example {
  const char *name, *expression, *help;
};
constexpr Example k_examples[] = {
    {"direct", "E[SG]*DL", "Direct light on diffuse surfaces, also seen in mirrors."},
    {"mirrored", "E[SG]+.*L", "All that polished surfaces and glass show at the first sight."},
    {"matt", "ED.*L", "All light of surfaces that are seen directly, without their gloss."},
    {"through-glass", "E.*SS.*L", "Light that has passed two mirroring or refracting surfaces in a row."},
    {"indirect", "E.*D.*D.*L", "Light after at least two diffuse events."}};

/// What is known of a layer; null: nothing yet.
const session::LayerStatus* status_of(const session::Snapshot* picture, const std::string& name) {
  if (picture)
    for (const session::LayerStatus& status : picture->layers)
      if (status.name == name) return &status;
  return nullptr;
}

std::string about_layer(const paths::Layer& layer, const session::LayerStatus* status) {
  std::string text = layer.expression +
                     "\nClick to show this layer, again to show the picture. At the right its share of the "
                     "picture's light.";
  if (status && status->error)
    text += fmt::format("\nNoise: {} of the picture's light around each pixel; ACCURACY draws it over time.",
                        percent_text(*status->error));
  if (status && !status->lacks.empty())
    text += "\nPart of its " + status->lacks +
            " light is not known, because its solver stores light of several words together.";
  return text;
}

void layer_row(Controls& controls, const paths::Layer& layer) {
  const bool shown = controls.open.setting("film.layer") == layer.name;
  ImGui::PushID(layer.name.c_str());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const session::LayerStatus* status = status_of(controls.open.snapshot.get(), layer.name);
  const std::string share =
      status ? fmt::format("{:.1f} %{}", 100 * status->share, status->lacks.empty() ? "" : " +") : "";
  if (list_row("##row", shown, layer.name, share, 0, px(24)))
    controls.act("set", "film.layer", shown ? std::string("beauty") : layer.name);
  tooltip(about_layer(layer, status));
  if (row_sign(at, "##remove", Sign::close, false, "Removes the layer. The picture starts again."))
    controls.act("layer.remove", layer.name);
  ImGui::PopID();
}

void example_list(Controls& controls) {
  if (button("##examples", "Examples", false, ImGui::CalcItemWidth())) ImGui::OpenPopup("##example_list");
  tooltip("Adds one of some layers that are often wanted.");
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(8), px(6)});
  if (ImGui::BeginPopup("##example_list")) {
    for (const Example& example : k_examples) {
      if (ImGui::Selectable(fmt::format("{}   {}", example.name, example.expression).c_str()))
        controls.act("layer.add", example.name, example.expression);
      tooltip(example.help);
    }
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar();
}

}  // namespace

std::string layer_count(const Controls& controls) {
  const size_t n = session::layers_in(controls.open.setting("film.layers")).size();
  return n > 0 ? fmt::format("{}", n) : "";
}

void draw_layers(Controls& controls, TypedLayer& typed) {
  const std::vector<paths::Layer> layers = session::layers_in(controls.open.setting("film.layers"));
  // What was typed stays until it has become a layer, for the case that it is refused.
  if (std::find(layers.begin(), layers.end(), paths::Layer{typed.name, typed.expression}) != layers.end())
    typed = {};
  if (layers.empty())
    paragraph("Light of the paths that an expression names, shown and saved beside the components.");
  for (const paths::Layer& layer : layers) layer_row(controls, layer);
  gap(4);
  const float width = ImGui::CalcItemWidth(), half = (width - px(4)) / 2;
  ImGui::SetNextItemWidth(half);
  ImGui::InputTextWithHint("##name", "Name", &typed.name);
  tooltip("Name of a layer: letters, digits, '_' and '-'.");
  ImGui::SameLine(0, px(4));
  ImGui::SetNextItemWidth(half);
  const bool entered = ImGui::InputTextWithHint("##expression", "E[SG]*DL", &typed.expression,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  tooltip(
      "Words of paths: E at the eye, D diffuse, G glossy, S specular, . any of these, L at the light; "
      "[SG] one of several, * any number, + at least one, ? at most one, | or.");
  const bool complete = !typed.name.empty() && !typed.expression.empty();
  ImGui::BeginDisabled(!complete);
  const bool pressed = button("##add", "Add", false, half);
  ImGui::EndDisabled();
  tooltip(
      "Adds the layer, or changes the one of that name. The picture starts again; a click on its row "
      "shows it.");
  if ((pressed || entered) && complete) controls.act("layer.add", typed.name, typed.expression);
  ImGui::SameLine(0, px(4));
  ImGui::PushItemWidth(half);
  example_list(controls);
  ImGui::PopItemWidth();
}

}  // namespace lucerna::ui
