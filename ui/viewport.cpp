// The middle: the view toolbar, the picture, and moving in it.
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

std::string capitalized(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

ImU32 layer_mark(const std::string& layer) {
  for (size_t c = 0; c < session::k_components; ++c)
    if (layer == session::k_component_names[c]) return colour::component[c];
  return 0;
}

std::string layer_help(const std::string& layer) {
  if (layer == "beauty") return "Shows the sum of the components whose eye is open.";
  if (layer_mark(layer)) return fmt::format("Shows the {} component.", layer);
  if (layer == "albedo") return "Shows the reflectance of the first surface.";
  if (layer == "normal") return "Shows the shading normal of the first surface.";
  if (layer == "depth") return "Shows the distance to the first surface.";
  if (layer == "samples") return "Shows the samples taken in each pixel.";
  if (layer == "error") return "Shows the estimated relative error.";
  if (layer == "cost") return "Shows the device time that each pixel's paths took.";
  return fmt::format("Shows the layer {}.", layer);
}

/// Layers as buttons; what does not fit goes into a list.
void layer_buttons(Ui& ui, float room) {
  const OptionInfo* option = plan::find_option("film.layer");
  if (!option) return;
  const std::vector<std::string>& layers = option->choices;
  const std::string& current = ui.setting("film.layer");
  const float between = px(4);
  float list_width = px(96);
  const auto width_of = [&](const std::string& layer) { return text_width(capitalized(layer)) + px(18); };
  const float all =
      std::accumulate(layers.begin(), layers.end(), -between,
                      [&](float sum, const std::string& l) { return sum + width_of(l) + between; });
  size_t fitting = layers.size();
  bool letters = false;
  if (all > room) {
    // Components stay together: beauty and the four, by name or by their first letters, or the list alone.
    constexpr size_t k_together = 1 + session::k_components;
    const auto need = [&](bool short_names) {
      float sum = width_of(layers[0]) + between + (short_names ? px(76) : list_width);
      for (size_t i = 1; i < k_together; ++i) sum += between + (short_names ? px(26) : width_of(layers[i]));
      return sum;
    };
    fitting = need(true) <= room ? k_together : 0;
    letters = need(false) > room;
    if (letters) list_width = px(76);
  }
  for (size_t i = 0; i < fitting; ++i) {
    const bool letter = letters && i > 0;
    const std::string name = capitalized(layers[i]);
    if (button(("##layer" + layers[i]).c_str(), letter ? name.substr(0, 1) : name, layers[i] == current,
               letter ? px(26) : width_of(layers[i]), layer_mark(layers[i])))
      ui.act("set", "film.layer", layers[i]);
    tooltip(layer_help(layers[i]));
    ImGui::SameLine(0, between);
  }
  if (fitting < layers.size()) {
    std::vector<std::string> rest(layers.begin() + static_cast<std::ptrdiff_t>(fitting), layers.end()), names;
    std::transform(rest.begin(), rest.end(), std::back_inserter(names), capitalized);
    int chosen = static_cast<int>(std::find(rest.begin(), rest.end(), current) - rest.begin());
    if (chosen == static_cast<int>(rest.size())) chosen = -1;
    const bool none = chosen < 0;
    if (choice("##layers", none ? "More" : "", names, chosen, list_width))
      ui.act("set", "film.layer", rest[static_cast<size_t>(chosen)]);
    tooltip("Further layers.");
  }
}

constexpr float k_drag = 3;  // design pixels that part a drag from a click

bool dragging() {
  for (int button = 0; button < 3; ++button)
    if (ImGui::GetIO().MouseDown[button] && ImGui::IsMouseDragging(button, px(k_drag))) return true;
  return false;
}

/// A point of the scene in the picture; false behind the eye.
bool project(const scene::Camera& camera, const Area& shown, const vec3& point, ImVec2& at) {
  const vec3 d = point - commands::eye_of(camera);
  const float depth = glm::dot(d, commands::forward_of(camera));
  if (!camera.orthographic && depth <= 1e-6f) return false;
  const float half = camera.orthographic ? camera.ymag : depth * std::tan(0.5f * camera.yfov);
  const float scale = 0.5f * shown.height() / half;
  at = {0.5f * (shown.lo.x + shown.hi.x) + scale * glm::dot(d, commands::right_of(camera)),
        0.5f * (shown.lo.y + shown.hi.y) - scale * glm::dot(d, commands::up_of(camera))};
  return true;
}

struct Mark {
  size_t light;
  ImVec2 at;
};

/// Where lamps stand in the picture on the screen. Suns have no place.
std::vector<Mark> marks(const Ui& ui, const Area& shown) {
  std::vector<Mark> list;
  if (!ui.scene || !ui.snapshot) return list;
  for (size_t i = 0; i < ui.scene->lights.size(); ++i) {
    const scene::Light& light = ui.scene->lights[i];
    ImVec2 at;
    if (light.kind != scene::LightKind::directional &&
        project(ui.snapshot->camera, shown, light.position, at))
      list.push_back({i, at});
  }
  return list;
}

/// The corners of the box around the selected object, as brackets: enough to find it, not so much as to hide
/// it.
void draw_brackets(const Ui& ui, const Area& shown) {
  if (ui.selection.kind != Kind::instance || !ui.scene || !ui.snapshot) return;
  const scene::Instance& instance = ui.scene->instances[ui.selection.index];
  if (instance.mesh >= ui.scene->meshes.size()) return;
  // Bounds in the object's space, kept while the selection lasts.
  static std::pair<std::pair<uint64_t, uint32_t>, Box> known{{0, 0}, {}};
  const scene::Mesh& mesh = ui.scene->meshes[instance.mesh];
  if (const std::pair key{ui.view_scene, ui.selection.index}; known.first != key) {
    known = {key, {}};
    for (const scene::Primitive& p : mesh.primitives)
      for (const vec3& v : p.positions) known.second.grow(v);
  }
  const Box& box = known.second;
  if (box.empty()) return;
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(shown.lo, shown.hi, true);
  const auto corner = [&](int bits) {
    return vec3(bits & 1 ? box.hi.x : box.lo.x, bits & 2 ? box.hi.y : box.lo.y,
                bits & 4 ? box.hi.z : box.lo.z);
  };
  for (int from = 0; from < 8; ++from)
    for (int axis = 1; axis < 8; axis *= 2) {
      const vec3 a = corner(from), b = glm::mix(a, corner(from ^ axis), 0.18f);
      ImVec2 p, q;
      if (!project(ui.snapshot->camera, shown, vec3(instance.to_world * vec4(a, 1)), p) ||
          !project(ui.snapshot->camera, shown, vec3(instance.to_world * vec4(b, 1)), q))
        continue;
      list->AddLine(p, q, IM_COL32(0, 0, 0, 120), px(3));
      list->AddLine(p, q, colour::accent, std::max(1.0f, px(1)));
    }
  list->PopClipRect();
}

void draw_marks(const Ui& ui, const Area& shown) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(shown.lo, shown.hi, true);
  for (const Mark& mark : marks(ui, shown)) {
    const bool chosen = ui.selection == Selection{Kind::light, static_cast<uint32_t>(mark.light)};
    const float r = px(5);
    list->AddCircleFilled(mark.at, r + px(1.5f), IM_COL32(0, 0, 0, 110), 20);
    list->AddCircle(mark.at, r, chosen ? colour::accent : colour::text, 20, px(1.5f));
    if (ui.light(static_cast<uint32_t>(mark.light)).enabled)
      list->AddCircleFilled(mark.at, px(2), chosen ? colour::accent : colour::text, 12);
  }
  list->PopClipRect();
}

/// Keys and mouse over the picture.
void navigate(Ui& ui, bool hovered, bool active) {
  ImGuiIO& io = ImGui::GetIO();
  if (!ui.view) return;
  Viewpoint view = *ui.view;
  const float height = std::max(1.0f, ui.picture.height());
  const vec2 drag(io.MouseDelta.x, io.MouseDelta.y);
  const bool typing = io.WantTextInput ||
                      ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  bool moved = false;

  // Flight: while the pointer is over the picture.
  vec3 wish(0);
  if ((hovered || active) && !typing && !io.KeyCtrl && !io.KeyAlt) {
    const auto down = [&](int key) { return io.KeysDown[key] ? 1.0f : 0.0f; };
    wish = {down(GLFW_KEY_D) - down(GLFW_KEY_A), down(GLFW_KEY_E) - down(GLFW_KEY_Q),
            down(GLFW_KEY_W) - down(GLFW_KEY_S)};
  }
  const bool flying = wish != vec3(0);
  if (flying || ui.flight.moving()) {
    const float seconds = std::min(io.DeltaTime, 0.1f);
    commands::fly(view, advance(ui.flight, wish, ui.speed * (io.KeyShift ? 4.0f : 1.0f), seconds));
    ui.moving = moved = true;
  }
  // A press that hardly moves is a click; it begins to drag after three pixels.
  if (active && (drag.x != 0 || drag.y != 0) && (flying || dragging())) {
    // Half a turn across the height of the picture.
    const vec2 angles = -drag * (k_pi / height);
    if (flying && (io.MouseDown[0] || io.MouseDown[1]))
      commands::look(view, 0.5f * angles);
    else if (io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift))
      commands::pan(view, drag, height);
    else if (io.MouseDown[1])
      commands::dolly(view, 12 * (drag.x - drag.y) / height);
    else if (io.MouseDown[0])
      commands::orbit(view, {angles.x, -angles.y});
    moved = true;
  }
  if (moved) ui.place(view);
  if (hovered && io.MouseWheel != 0) {
    if (flying)
      ui.act("camera.speed", std::clamp(ui.speed * std::pow(1.2f, io.MouseWheel), 0.01f, 1000.0f));
    else
      ui.act("camera.dolly", io.MouseWheel);
  }
}

/// A click selects what is under it: a light where its mark is shown, or else an object.
void click(Ui& ui, const Area& shown) {
  const ImVec2 at = ImGui::GetIO().MousePos;
  if (ui.light_marks)
    for (const Mark& mark : marks(ui, shown))
      if (std::hypot(mark.at.x - at.x, mark.at.y - at.y) <= px(9))
        return ui.act("select", "light", mark.light + 1);
  const float x = (at.x - shown.lo.x) / std::max(1.0f, shown.width());
  const float y = (at.y - shown.lo.y) / std::max(1.0f, shown.height());
  if (x >= 0 && x <= 1 && y >= 0 && y <= 1) ui.act("pick", x, y);
}

constexpr double k_rest = 0.15;  // seconds

/// While a view of a solver that can be asked lies over the picture, a pointer at rest asks what is under it.
/// At rest, because every question interrupts the work on the picture.
void ask(Ui& ui, const Area& shown, bool active) {
  static ImVec2 last;
  static double since = 0;
  const ImVec2 at = ImGui::GetIO().MousePos;
  if (at.x != last.x || at.y != last.y) last = at, since = ui.now;
  const vec2 place((at.x - shown.lo.x) / std::max(1.0f, shown.width()),
                   (at.y - shown.lo.y) / std::max(1.0f, shown.height()));
  const bool inside = place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1;
  const bool still = !(active && dragging()) && !ui.flight.moving();
  if (ui.asks_pointer() && ui.picture_hovered && inside && still) {
    if (active || ui.asked == place || ui.now - since < k_rest) return;
    ui.asked = place;
    ui.act("inspect.at", place.x, place.y);
  } else if (ui.asked) {
    ui.asked.reset();
    ui.act("inspect.none");
  }
}

void empty_state(Ui& ui, const Area& area) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float x = 0.5f * (area.lo.x + area.hi.x), y = std::floor(area.lo.y + 0.42f * area.height());
  draw_text(list, {area.lo.x, y - px(16)}, {area.hi.x, y + px(16)}, "Drop a scene here", colour::text,
            Align::centre, theme().fonts.large);
  draw_text(list, {area.lo.x, y + px(20)}, {area.hi.x, y + px(40)}, "glTF 2.0, as .gltf or .glb",
            colour::text_dim, Align::centre);
  const float w = px(104);
  ImGui::SetCursorScreenPos({std::floor(x - 0.5f * w), y + px(56)});
  if (button("##open", "Open\xE2\x80\xA6", false, w)) ui.act("dialog.open");
  tooltip("Opens a scene by its path. Ctrl+O.");
  if (ui.recent.empty()) return;
  float line = y + px(112);
  const float width = std::min(px(420), area.width() - px(48));
  draw_text(list, {area.lo.x, line - px(20)}, {area.hi.x, line}, "Recent", colour::text_faint, Align::centre,
            theme().fonts.small);
  const std::vector<std::string> files(
      ui.recent.begin(),
      ui.recent.begin() + std::min<std::ptrdiff_t>(5, static_cast<std::ptrdiff_t>(ui.recent.size())));
  for (size_t i = 0; i < files.size() && line + px(24) < area.hi.y; ++i, line += px(24)) {
    ImGui::PushID(static_cast<int>(i));
    const ImVec2 lo(std::floor(x - 0.5f * width), line), hi(lo.x + width, line + px(24));
    ImGui::SetCursorScreenPos(lo);
    if (ImGui::InvisibleButton("##recent", {width, px(24)})) ui.act("scene.open", files[i]);
    if (ImGui::IsItemHovered()) list->AddRectFilled(lo, hi, colour::field, px(3));
    draw_text(list, lo, hi, elided(files[i], width - px(16), nullptr, true),
              ImGui::IsItemHovered() ? colour::text : colour::text_dim, Align::centre);
    ImGui::PopID();
  }
}

/// What is going on, at the lower left, with a way out.
void activity_card(Ui& ui, const Area& area) {
  if (!ui.snapshot || ui.snapshot->activity.empty()) return;
  const bool cancels = ui.loading();
  const float w = std::min(px(360), area.width() - px(24)), h = px(cancels ? 60.0f : 36.0f);
  const bool empty = ui.snapshot->rgba.empty();
  const ImVec2 lo(empty ? std::floor(0.5f * (area.lo.x + area.hi.x - w)) : area.lo.x + px(12),
                  empty ? std::floor(area.lo.y + 0.42f * area.height()) : area.hi.y - h - px(12));
  const ImVec2 hi(lo.x + w, lo.y + h);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(lo, hi, colour::with_alpha(colour::bar, 0.95f), px(3));
  list->AddRect(lo, hi, colour::hairline, px(3));
  const float text_right = hi.x - px(cancels ? 96.0f : 12.0f);
  draw_text(list, {lo.x + px(12), lo.y}, {text_right, lo.y + px(cancels ? 44.0f : 36.0f)},
            elided(ui.snapshot->activity, text_right - lo.x - px(12)), colour::text);
  if (!cancels) return;
  ImGui::SetCursorScreenPos({hi.x - px(84), lo.y + px(10)});
  if (button("##cancel", "Cancel", false, px(72))) ui.act("scene.cancel");
  tooltip("Gives up the load; the scene shown stays. Esc.");
  const float track_lo = lo.x + px(12), track_hi = hi.x - px(12), y = hi.y - px(14);
  list->AddRectFilled({track_lo, y}, {track_hi, y + px(3)}, colour::field, px(1));
  list->AddRectFilled(
      {track_lo, y},
      {track_lo + (track_hi - track_lo) * std::clamp(ui.snapshot->progress, 0.0f, 1.0f), y + px(3)},
      colour::accent, px(1));
}

/// The newest error, over the upper edge of the picture until it is taken away.
void error_strip(Ui& ui, const Area& area) {
  if (ui.errors.empty()) return;
  const std::string message = ui.errors.back();
  ImFont* font = theme().fonts.regular;
  const float pad = px(12), count_width = ui.errors.size() > 1 ? px(44) : 0;
  const float room = std::max(px(80), area.width() - 3 * pad - px(28) - count_width);
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9f, room, message.c_str());
  const float height = std::min(size.y + px(16), area.height() * 0.6f);
  const ImVec2 lo = area.lo, hi(area.hi.x, area.lo.y + height);
  ImGui::SetCursorScreenPos(lo);
  ImGui::BeginChild("##errors", {hi.x - lo.x, hi.y - lo.y}, false, ImGuiWindowFlags_NoScrollbar);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(lo, hi, colour::error_field);
  list->AddRectFilled(lo, {lo.x + px(3), hi.y}, colour::error);
  list->AddText(font, font->FontSize, {lo.x + pad, lo.y + px(8)}, colour::text, message.c_str(), nullptr,
                room);
  if (ui.errors.size() > 1)
    draw_text(list, {hi.x - px(36) - count_width, lo.y}, {hi.x - px(40), lo.y + px(34)},
              fmt::format("1 of {}", ui.errors.size()), colour::text_dim, Align::right, theme().fonts.small);
  ImGui::SetCursorScreenPos({hi.x - px(32), lo.y + px(6)});
  if (sign_button("##dismiss", Sign::close, true, colour::text)) ui.act("dismiss");
  tooltip("Takes the message away; it stays in the log. Esc.");
  ImGui::EndChild();
}

}  // namespace

void draw_toolbar(Ui& ui, const Area& area) {
  begin_panel("##toolbar", area, colour::bar, false);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled({area.lo.x, area.hi.y - 1}, area.hi, colour::hairline);
  const float pad = px(8), y = area.lo.y + px(6);
  const float tone_width = px(88), ev_width = px(92), tiles_width = px(46);
  float right = area.hi.x - pad;
  const OptionInfo* tone = plan::find_option("film.tone_curve");
  if (tone) {
    right -= tone_width;
    ImGui::SetCursorScreenPos({right, y});
    std::vector<std::string> names;
    for (const std::string& name : tone->choices) names.push_back(name == "agx" ? "AgX" : capitalized(name));
    int chosen = static_cast<int>(
        std::find(tone->choices.begin(), tone->choices.end(), ui.setting("film.tone_curve")) -
        tone->choices.begin());
    if (choice("##tone", "", names, chosen, tone_width))
      ui.act("set", "film.tone_curve", tone->choices[static_cast<size_t>(chosen)]);
    tooltip(tone->help);
    right -= px(4);
  }
  if (const OptionInfo* ev = plan::find_option("film.ev")) {
    right -= ev_width;
    ImGui::SetCursorScreenPos({right, y});
    auto value = static_cast<float>(ui.setting_real("film.ev"));
    // The hand wants the range in which pictures lie; typing reaches the rest.
    const Slider how{.lo = std::max(-10.0f, static_cast<float>(ev->lo)),
                     .hi = std::min(10.0f, static_cast<float>(ev->hi)),
                     .decimals = 2,
                     .unit = "EV",
                     .bar = false,
                     .sign = true,
                     .travel = 0.2f,
                     .typed_lo = static_cast<float>(ev->lo),
                     .typed_hi = static_cast<float>(ev->hi)};
    if (slider("##ev", "", value, how, ev_width)) ui.act("set", "film.ev", fmt::format("{:.4g}", value));
    tooltip(ev->help + " Double-click to type.");
    right -= px(4);
  }
  right -= tiles_width;
  ImGui::SetCursorScreenPos({right, y});
  if (button("##tiles", "Tiles", ui.setting_on("overlay.tiles"), tiles_width)) ui.toggle("overlay.tiles");
  tooltip(plan::find_option("overlay.tiles")->help + " T.");
  right -= px(8);
  ImGui::SetCursorScreenPos({area.lo.x + pad, y});
  layer_buttons(ui, right - area.lo.x - pad);
  ImGui::End();
}

void draw_picture(Ui& ui, const Area& area) {
  begin_panel("##picture", area, colour::surround, false);
  ui.picture = area;
  if (area.height() > 0) ui.aspect = area.width() / area.height();
  ImDrawList* list = ImGui::GetWindowDrawList();
  const bool shown = ui.has_picture() && ui.texture != 0;
  Area frame = area;  // of the picture itself
  if (shown) {
    // One picture pixel on one window pixel; while the sizes differ the picture stands in the middle, scaled
    // down if it must be.
    float w = static_cast<float>(ui.texture_width) * static_cast<float>(ui.picture_divisor);
    float h = static_cast<float>(ui.texture_height) * static_cast<float>(ui.picture_divisor);
    if (w > area.width() + static_cast<float>(ui.picture_divisor) ||
        h > area.height() + static_cast<float>(ui.picture_divisor)) {
      const float fit = std::min(area.width() / w, area.height() / h);
      w = std::floor(w * fit), h = std::floor(h * fit);
    }
    const ImVec2 lo(std::floor(area.lo.x + 0.5f * (area.width() - w)),
                    std::floor(area.lo.y + 0.5f * (area.height() - h)));
    list->AddImage(reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(ui.texture)), lo,
                   {lo.x + w, lo.y + h});
    frame = {lo, {lo.x + w, lo.y + h}};
    if (ui.light_marks) draw_marks(ui, frame);
    if (ui.brackets) draw_brackets(ui, frame);
  }
  const bool waiting = ui.snapshot && !ui.snapshot->activity.empty();
  if (!shown && !waiting) empty_state(ui, area);
  draw_legend(ui, frame);
  draw_inspection(ui, frame);
  activity_card(ui, area);
  error_strip(ui, area);

  bool active = false;
  ui.picture_hovered = false;
  if (shown) {
    ImGui::SetCursorScreenPos(area.lo);
    ImGui::InvisibleButton("##view", {std::max(1.0f, area.width()), std::max(1.0f, area.height())},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    ui.picture_hovered = ImGui::IsItemHovered();
    active = ImGui::IsItemActive();
    if (ui.picture_hovered && ImGui::IsMouseReleased(0) && ImGui::IsItemDeactivated() &&
        ImGui::GetIO().MouseDragMaxDistanceSqr[0] < px(k_drag) * px(k_drag))
      click(ui, frame);
  }
  ask(ui, frame, active);
  navigate(ui, ui.picture_hovered, active);
  ImGui::End();
}

}  // namespace lucerna::ui
