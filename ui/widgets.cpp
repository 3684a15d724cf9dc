#include "widgets.h"

#include "shown_lines.h"

#include <imgui_internal.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "base/color.h"
#include "shaders/shared/tone.h"

namespace lucerna::ui {
namespace {

float row_height() { return px(24); }
float full_width(float width) { return width > 0 ? width : ImGui::GetContentRegionAvail().x; }

std::string upper(const char* text) {
  std::string result;
  for (const char* c = text; *c; ++c)
    result += static_cast<char>(std::toupper(static_cast<unsigned char>(*c)));
  return result;
}

/// Draws capitals with one pixel between the letters.
void draw_caps(ImDrawList* list, ImVec2 at, const std::string& text, ImU32 colour) {
  ImFont* font = theme().fonts.caps;
  ShownLines::instance().note(text);
  for (const char& c : text) {
    list->AddText(font, font->FontSize, at, colour, &c, &c + 1);
    at.x += font->GetCharAdvance(static_cast<unsigned char>(c)) + px(0.6f);
  }
}

/// Share of the control's width for 0, if 0 has a separate meaning on a logarithmic scale.
constexpr float k_zero_share = 0.04f;

bool log_with_zero(const Slider& how) { return how.log && !how.at_zero.empty(); }

std::string number_text(float value, const Slider& how) {
  if (value == 0 && !how.at_zero.empty()) return how.at_zero;
  std::string text = how.decimals == 0 && value >= 1e4f ? count_text(value) : real_text(value, how.decimals);
  if (how.sign && value >= 0) text = (value > 0 ? "+" : "\xE2\x80\x87") + text;
  return how.unit.empty() ? text : text + (how.unit[0] == '\xC2' ? "" : " ") + how.unit;
}

float to_fraction(float value, const Slider& how) {
  if (how.hi <= how.lo) return 0;
  const float v = std::clamp(value, how.lo, how.hi);
  if (log_with_zero(how)) return v < 1 ? 0 : std::lerp(k_zero_share, 1.0f, std::log(v) / std::log(how.hi));
  return how.log ? std::log(v / how.lo) / std::log(how.hi / how.lo) : (v - how.lo) / (how.hi - how.lo);
}

float from_fraction(float f, const Slider& how) {
  f = std::clamp(f, 0.0f, 1.0f);
  if (log_with_zero(how))
    return f < k_zero_share ? 0 : std::pow(how.hi, (f - k_zero_share) / (1 - k_zero_share));
  return how.log ? how.lo * std::pow(how.hi / how.lo, f) : how.lo + f * (how.hi - how.lo);
}

}  // namespace

void draw_text(ImDrawList* list, const ImVec2& lo, const ImVec2& hi, const std::string& text, ImU32 colour,
               Align align, ImFont* font) {
  if (!font) font = theme().fonts.regular;
  ShownLines::instance().note(text);
  const float width = text_width(text, font);
  float x = lo.x;
  if (align == Align::centre) x = 0.5f * (lo.x + hi.x - width);
  if (align == Align::right) x = hi.x - width;
  const float y = 0.5f * (lo.y + hi.y - font->FontSize);
  const ImVec4 clip(lo.x, lo.y, hi.x, hi.y);
  list->AddText(font, font->FontSize, {std::floor(x), std::floor(y)}, colour, text.data(),
                text.data() + text.size(), 0, &clip);
}

void label(const std::string& text, ImU32 colour, ImFont* font, float max_width) {
  if (!font) font = theme().fonts.regular;
  const std::string shown = max_width > 0 ? elided(text, max_width, font) : text;
  ShownLines::instance().note(text);
  ImGui::PushFont(font);
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(shown.data(), shown.data() + shown.size());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void tooltip(const std::string& text) {
  if (text.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  if (ImGui::GetIO().MouseDown[0] || ImGui::GetIO().MouseDown[1] || ImGui::GetIO().MouseDown[2]) return;
  // The pointer has to rest for a moment; IO time replaces ids for items without one.
  static ImGuiID last = 0;
  static double since = 0;
  const ImRect& rect = GImGui->LastItemData.Rect;
  const ImGuiID key = ImHashData(&rect, sizeof(rect), GImGui->LastItemData.ID);
  const double now = ImGui::GetTime();
  // Shown as long as it is hovered in every frame, whatever the frame rate.
  static int seen = 0;
  const int frame = ImGui::GetFrameCount();
  if (key != last || frame > seen + 1) last = key, since = now;
  seen = frame;
  if (now - since < 0.45) return;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(10), px(7)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(3));
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(px(320));
  label(text, colour::text, theme().fonts.small);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
  ImGui::PopStyleVar(2);
}

void paragraph(const std::string& text, ImU32 colour) {
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + ImGui::CalcItemWidth());
  label(text, colour);
  ImGui::PopTextWrapPos();
}

void gap(float design) { ImGui::SetCursorPosY(ImGui::GetCursorPosY() + px(design)); }

void hairline() {
  ImGuiWindow* window = ImGui::GetCurrentWindow();
  const float y = std::floor(window->DC.CursorPos.y);
  window->DrawList->AddLine({window->Pos.x, y}, {window->Pos.x + window->Size.x, y}, colour::hairline);
}

bool section(const char* title, bool& open, const std::string& right) {
  ImGuiWindow* window = ImGui::GetCurrentWindow();
  const float width = window->Size.x - window->ScrollbarSizes.x;
  const ImVec2 lo(window->Pos.x, window->DC.CursorPos.y), hi(lo.x + width, lo.y + px(32));
  ImGui::SetCursorScreenPos(lo);
  ImGui::PushID(title);
  if (ImGui::InvisibleButton("##section", {width, px(32)})) open = !open;
  const bool hovered = ImGui::IsItemHovered();
  ImGui::PopID();
  ImDrawList* list = window->DrawList;
  if (lo.y > window->Pos.y + 1) list->AddLine({lo.x, lo.y}, {hi.x, lo.y}, colour::hairline);
  draw_caps(list, {lo.x + px(12), std::floor(lo.y + 0.5f * (hi.y - lo.y - theme().fonts.caps->FontSize))},
            upper(title), hovered ? colour::text : colour::text_dim);
  draw_sign(list, {hi.x - px(18), 0.5f * (lo.y + hi.y)}, px(8),
            open ? Sign::chevron_down : Sign::chevron_right, true,
            hovered ? colour::text : colour::text_faint);
  if (!right.empty())
    draw_text(list, {lo.x + px(96), lo.y}, {hi.x - px(32), hi.y}, right, colour::text_faint, Align::right,
              theme().fonts.small);
  ImGui::SetCursorScreenPos({lo.x, hi.y});
  return open;
}

float begin_padded(float design) {
  ImGui::Indent(px(design));
  const float width = ImGui::GetContentRegionAvail().x - px(design);
  ImGui::PushItemWidth(width);
  return width;
}

void end_padded(float design) {
  ImGui::PopItemWidth();
  ImGui::Unindent(px(design));
}

void value_row(const std::string& name, const std::string& value, const std::string& help,
               ImU32 value_colour) {
  const float width = ImGui::CalcItemWidth();
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + px(20));
  ImGui::Dummy({width, px(20)});
  tooltip(help);
  ImDrawList* list = ImGui::GetWindowDrawList();
  // The value matters most: the name is cut first, down to a third of the row.
  const float gap = px(8);
  const float name_room =
      std::min(text_width(name), std::max(std::floor(width / 3), width - gap - text_width(value)));
  const float room = width - gap - name_room;
  draw_text(list, lo, hi, elided(name, name_room), colour::text_dim);
  draw_text(list, {lo.x + name_room + gap, lo.y}, hi, elided(value, room, nullptr, true), value_colour,
            Align::right);
  ImGui::SetCursorScreenPos({lo.x, hi.y});
}

bool button(const char* id, const std::string& text, bool on, float width, ImU32 mark) {
  const float w = width > 0 ? width : text_width(text) + px(20);
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + w, lo.y + row_height());
  const bool pressed = ImGui::InvisibleButton(id, {w, row_height()});
  const bool disabled = (GImGui->CurrentItemFlags & ImGuiItemFlags_Disabled) != 0;
  const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive();
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImU32 back = on ? colour::field_active : colour::field;
  if (hovered) back = on ? colour::fill : colour::field_hover;
  if (held) back = colour::fill;
  list->AddRectFilled(lo, hi, disabled ? colour::panel : back, px(3));
  if (mark)
    list->AddRectFilled({lo.x + px(6), hi.y - px(3)}, {hi.x - px(6), hi.y - px(1)},
                        on ? mark : colour::with_alpha(mark, 0.45f), px(1));
  const ImU32 ink = disabled  ? colour::text_faint
                    : on      ? colour::text
                    : hovered ? colour::text
                              : colour::text_dim;
  draw_text(list, lo, hi, elided(text, w - px(8)), ink, Align::centre);
  return pressed;
}

void draw_sign(ImDrawList* list, const ImVec2& c, float size, Sign sign, bool on, ImU32 ink) {
  const float r = 0.5f * size, line = std::max(1.0f, theme().scale * 1.4f);
  switch (sign) {
    case Sign::eye: {
      const float w = 0.85f * r * 1.15f, h = 0.52f * r;
      list->PathClear();
      list->PathLineTo({c.x - w, c.y});
      list->PathBezierQuadraticCurveTo({c.x, c.y - 2 * h}, {c.x + w, c.y});
      list->PathBezierQuadraticCurveTo({c.x, c.y + 2 * h}, {c.x - w, c.y});
      list->PathStroke(ink, 0, line);
      if (on)
        list->AddCircleFilled(c, 0.3f * r, ink, 12);
      else
        list->AddLine({c.x - 0.7f * r, c.y + 0.7f * r}, {c.x + 0.7f * r, c.y - 0.7f * r}, ink, line);
      break;
    }
    case Sign::solo:
      draw_text(list, {c.x - r, c.y - r}, {c.x + r, c.y + r}, "S", ink, Align::centre, theme().fonts.strong);
      break;
    case Sign::power:
      if (on)
        list->AddCircleFilled(c, 0.42f * r, ink, 16);
      else
        list->AddCircle(c, 0.42f * r, ink, 16, line);
      break;
    case Sign::close:
      list->AddLine({c.x - 0.5f * r, c.y - 0.5f * r}, {c.x + 0.5f * r, c.y + 0.5f * r}, ink, line);
      list->AddLine({c.x - 0.5f * r, c.y + 0.5f * r}, {c.x + 0.5f * r, c.y - 0.5f * r}, ink, line);
      break;
    case Sign::tick: {
      const ImVec2 points[3] = {c + ImVec2(-r, 0), c + ImVec2(-0.3f * r, 0.7f * r), c + ImVec2(r, -0.7f * r)};
      list->AddPolyline(points, 3, ink, 0, line);
      break;
    }
    default: {
      const float a = 0.5f * r, b = r;
      ImVec2 d(0, 0), e(0, 0), f(0, 0);
      if (sign == Sign::chevron_down) d = {-b, -a}, e = {0, a}, f = {b, -a};
      if (sign == Sign::chevron_up) d = {-b, a}, e = {0, -a}, f = {b, a};
      if (sign == Sign::chevron_right) d = {-a, -b}, e = {a, 0}, f = {-a, b};
      if (sign == Sign::chevron_left) d = {a, -b}, e = {-a, 0}, f = {a, b};
      const ImVec2 points[3] = {c + d, c + e, c + f};
      list->AddPolyline(points, 3, ink, 0, line);
    }
  }
}

ImDrawList* card(const ImVec2& lo, const ImVec2& hi, float alpha) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(lo, hi, colour::with_alpha(colour::bar, alpha), px(3));
  list->AddRect(lo, hi, colour::hairline, px(3));
  return list;
}

bool sign_button(const char* id, Sign sign, bool on, ImU32 on_colour, float size) {
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + px(size), lo.y + px(size));
  const bool pressed = ImGui::InvisibleButton(id, {px(size), px(size)});
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (hovered || ImGui::IsItemActive())
    list->AddRectFilled(lo, hi, ImGui::IsItemActive() ? colour::field_active : colour::field_hover, px(3));
  const bool arrow = sign >= Sign::close;
  const ImU32 ink = on ? on_colour : hovered ? colour::text_dim : colour::text_faint;
  draw_sign(list, {0.5f * (lo.x + hi.x), 0.5f * (lo.y + hi.y)},
            px(arrow ? (sign == Sign::close ? 16.0f : 8.0f) : 16.0f), sign, on, ink);
  return pressed;
}

bool slider(const char* id, const std::string& name, float& value, const Slider& how, float width) {
  ImGuiWindow* window = ImGui::GetCurrentWindow();
  const float w = full_width(width > 0 ? width : ImGui::CalcItemWidth());
  const ImVec2 lo = window->DC.CursorPos, hi(lo.x + w, lo.y + row_height());
  const ImRect box(lo, hi);
  const ImGuiID key = window->GetID(id);
  const bool typing = ImGui::TempInputIsActive(key);
  if (typing) {
    float typed = value;
    const bool further = how.typed_lo < how.typed_hi;
    const float least = further ? how.typed_lo : how.lo, most = further ? how.typed_hi : how.hi;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {px(8), 0.5f * (row_height() - ImGui::GetFontSize())});
    const bool changed = ImGui::TempInputScalar(box, key, id, ImGuiDataType_Float, &typed,
                                                fmt::format("%.{}f", how.decimals).c_str(), &least, &most);
    ImGui::PopStyleVar();
    if (changed && std::isfinite(typed)) value = std::clamp(typed, least, most);
    return changed;
  }
  ImGui::InvisibleButton(id, box.GetSize());
  const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
  bool changed = false;
  static float start_fraction = 0, travelled = 0;
  if (ImGui::IsItemActivated()) start_fraction = to_fraction(value, how), travelled = 0;
  if (hovered && ImGui::IsMouseDoubleClicked(0)) {
    ImGui::ClearActiveID();
    float typed = value;
    ImGui::TempInputScalar(box, key, id, ImGuiDataType_Float, &typed,
                           fmt::format("%.{}f", how.decimals).c_str());
    return false;
  }
  if (active && ImGui::GetIO().MouseDelta.x != 0) {
    const ImGuiIO& io = ImGui::GetIO();
    const float rate = io.KeyShift ? 0.1f : io.KeyCtrl ? 10.0f : 1.0f;
    travelled += rate * how.travel * io.MouseDelta.x / w;
    float next = from_fraction(start_fraction + travelled, how);
    if (how.step > 0) next = std::round(next / how.step) * how.step;
    if (!io.KeyShift && !how.log && how.step == 0) {
      // Values are rounded to the displayed digits, so equal readings are equal.
      const float grain = std::pow(10.0f, static_cast<float>(-how.decimals));
      next = std::round(next / grain) * grain;
    }
    next = std::clamp(next, how.lo, how.hi);
    changed = next != value;
    value = next;
  }
  if (hovered || active) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  const bool disabled = (GImGui->CurrentItemFlags & ImGuiItemFlags_Disabled) != 0;
  ImDrawList* list = window->DrawList;
  list->AddRectFilled(lo, hi,
                      active    ? colour::field_active
                      : hovered ? colour::field_hover
                                : colour::field,
                      px(3));
  if (how.bar) {
    // From zero if the range spans it, otherwise from the left end.
    const float zero = how.lo < 0 && how.hi > 0 && !how.log ? to_fraction(0, how) : 0;
    const float at = to_fraction(value, how);
    const float a = lo.x + w * std::min(zero, at), b = lo.x + w * std::max(zero, at);
    if (b > a)
      list->AddRectFilled({std::floor(a), hi.y - px(2)}, {std::ceil(b), hi.y},
                          active ? colour::accent : colour::grey(112), px(1));
  }
  const std::string number = number_text(value, how);
  const float number_width = text_width(number);
  const ImU32 name_ink = disabled ? colour::text_faint : colour::text_dim;
  draw_text(list, {lo.x + px(8), lo.y}, {hi.x - px(8), hi.y},
            elided(name, std::max(0.0f, w - number_width - px(24))), name_ink);
  draw_text(list, {lo.x + px(8), lo.y}, {hi.x - px(8), hi.y}, number,
            disabled ? colour::text_faint : colour::text, Align::right);
  return changed;
}

int slider_row(const char* id, const std::string& name, vec3& value, const Slider& how) {
  static const char* axes[] = {"x", "y", "z"};
  const float all = ImGui::CalcItemWidth(), between = px(4);
  const float name_width = px(64), width = std::floor((all - name_width - 2 * between) / 3);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  draw_text(ImGui::GetWindowDrawList(), at, {at.x + name_width, at.y + row_height()},
            elided(name, name_width - px(4)), colour::text_dim);
  ImGui::PushID(id);
  int changed = -1;
  for (int i = 0; i < 3; ++i) {
    ImGui::SetCursorScreenPos({at.x + name_width + static_cast<float>(i) * (width + between), at.y});
    if (slider(axes[i], "", value[i], how, width)) changed = i;
  }
  ImGui::PopID();
  // The next item and a tooltip belong to the row.
  ImGui::SetCursorScreenPos(at);
  ImGui::Dummy({all, row_height()});
  return changed;
}

namespace {

float encoded(float v) { return shared::srgb_encode(std::clamp(v, 0.0f, 1.0f)); }

}  // namespace

ImU32 display_colour(const vec3& linear) {
  const auto byte = [](float v) { return static_cast<int>(encoded(v) * 255 + 0.5f); };
  return IM_COL32(byte(linear.x), byte(linear.y), byte(linear.z), 255);
}

bool colour_field(const char* id, const std::string& name, vec3& linear, const std::string& note) {
  const float w = ImGui::CalcItemWidth();
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + w, lo.y + row_height());
  ImGui::PushID(id);
  if (ImGui::InvisibleButton("##open", {w, row_height()})) ImGui::OpenPopup("##picker");
  const ImGuiLastItemData item = GImGui->LastItemData;
  const bool hovered = ImGui::IsItemHovered(), open = ImGui::IsPopupOpen("##picker");
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(lo, hi,
                      open      ? colour::field_active
                      : hovered ? colour::field_hover
                                : colour::field,
                      px(3));
  const ImVec2 inner(hi.x - px(52), lo.y + px(5));
  list->AddRectFilled(inner, {hi.x - px(8), hi.y - px(5)}, display_colour(linear), px(2));
  list->AddRect(inner, {hi.x - px(8), hi.y - px(5)}, colour::grey(80), px(2));
  draw_text(list, {lo.x + px(8), lo.y}, {inner.x - px(8), hi.y}, name, colour::text_dim);
  if (!note.empty())
    draw_text(list, {lo.x + px(8), lo.y}, {inner.x - px(8), hi.y}, note, colour::text_faint, Align::right);
  bool changed = false;
  // Below the field, or as low as the window allows. Before it is drawn, its height is estimated.
  static float height = 0;
  if (height <= 0) height = px(24 + 190 + 18) + 3 * (row_height() + px(6)) + ImGui::GetFontSize();
  const float lowest = ImGui::GetIO().DisplaySize.y - height - px(4);
  ImGui::SetNextWindowPos({hi.x, std::max(0.0f, std::min(hi.y + px(2), lowest))}, 0, {1, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(12), px(12)});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(8), px(6)});
  if (ImGui::BeginPopup("##picker", ImGuiWindowFlags_NoMove)) {
    // The square keeps its hue where a colour has none: ImGui's own copy stores it.
    static vec3 shown, sent;
    if (sent != linear) {
      shown = {encoded(linear.x), encoded(linear.y), encoded(linear.z)};
      sent = linear;
    }
    ImGui::SetNextItemWidth(px(216));
    if (ImGui::ColorPicker3("##square", &shown.x,
                            ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_NoInputs |
                                ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoSmallPreview |
                                ImGuiColorEditFlags_NoOptions | ImGuiColorEditFlags_NoTooltip))
      changed = true;
    vec3 typed(linear_from_srgb(shown.x), linear_from_srgb(shown.y), linear_from_srgb(shown.z));
    if (changed) sent = linear = typed;
    static const char* names[] = {"Red", "Green", "Blue"};
    for (int i = 0; i < 3; ++i)
      if (slider(names[i], names[i], typed[i], {.decimals = 3}, px(216))) {
        linear = sent = typed, changed = true;
        shown = {encoded(linear.x), encoded(linear.y), encoded(linear.z)};
      }
    label("Linear Rec.709; double-click to type", colour::text_faint, theme().fonts.small);
    height = ImGui::GetWindowHeight();
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar(2);
  ImGui::PopID();
  GImGui->LastItemData = item;
  return changed;
}

bool choice(const char* id, const std::string& name, const std::vector<std::string>& entries, int& index,
            float width, const std::vector<std::string>& helps, const std::string& shown) {
  const float w = full_width(width > 0 ? width : ImGui::CalcItemWidth());
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + w, lo.y + row_height());
  ImGui::PushID(id);
  const bool pressed = ImGui::InvisibleButton("##open", {w, row_height()});
  const ImGuiLastItemData item = GImGui->LastItemData;
  const bool hovered = ImGui::IsItemHovered();
  const bool open = ImGui::IsPopupOpen("##entries");
  if (pressed) ImGui::OpenPopup("##entries");
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(lo, hi,
                      open      ? colour::field_active
                      : hovered ? colour::field_hover
                                : colour::field,
                      px(3));
  draw_sign(list, {hi.x - px(12), 0.5f * (lo.y + hi.y) + 1}, px(7), Sign::chevron_down, true,
            colour::text_dim);
  const bool chosen = index >= 0 && index < static_cast<int>(entries.size());
  const std::string& text = !shown.empty() ? shown : chosen ? entries[static_cast<size_t>(index)] : "";
  const ImVec2 inner_lo(lo.x + px(8), lo.y), inner_hi(hi.x - px(22), hi.y);
  const float name_width = name.empty() ? 0 : text_width(name) + px(8);
  if (!name.empty()) draw_text(list, inner_lo, inner_hi, name, colour::text_dim);
  draw_text(list, {inner_lo.x + name_width, lo.y}, inner_hi,
            elided(text, inner_hi.x - inner_lo.x - name_width), colour::text,
            name.empty() ? Align::left : Align::right);
  bool changed = false;
  ImGui::SetNextWindowPos({lo.x, hi.y + px(2)});
  ImGui::SetNextWindowSizeConstraints({w, 0}, {std::max(w, px(280)), px(400)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(4), px(4)});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
  if (ImGui::BeginPopup("##entries", ImGuiWindowFlags_NoMove)) {
    for (int i = 0; i < static_cast<int>(entries.size()); ++i) {
      ImGui::PushID(i);
      ImGui::PushStyleColor(ImGuiCol_Text, i == index ? colour::text : colour::text_dim);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float entry_width = std::max(w - px(8), text_width(entries[static_cast<size_t>(i)]) + px(24));
      if (ImGui::Selectable("##entry", i == index, 0, {entry_width, px(24)})) changed = i != index, index = i;
      if (static_cast<size_t>(i) < helps.size()) tooltip(helps[static_cast<size_t>(i)]);
      draw_text(ImGui::GetWindowDrawList(), {at.x + px(4), at.y}, {at.x + entry_width, at.y + px(24)},
                entries[static_cast<size_t>(i)], i == index ? colour::text : colour::text_dim);
      ImGui::PopStyleColor();
      ImGui::PopID();
    }
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar(2);
  ImGui::PopID();
  GImGui->LastItemData = item;  // so that a tooltip belongs to the closed field
  return changed;
}

void stacked_bar(const std::vector<Part>& parts, float height, float width) {
  const float w = full_width(width > 0 ? width : ImGui::CalcItemWidth());
  const ImVec2 lo = ImGui::GetCursorScreenPos();
  const float h = px(height);
  ImGui::Dummy({w, h});
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(lo, {lo.x + w, lo.y + h}, colour::field, px(1));
  float at = 0;
  for (const Part& part : parts) {
    const float a = std::floor(lo.x + w * std::clamp(at, 0.0f, 1.0f));
    at += part.fraction;
    const float b = std::floor(lo.x + w * std::clamp(at, 0.0f, 1.0f));
    if (b > a) list->AddRectFilled({a, lo.y}, {b, lo.y + h}, part.colour, 0);
  }
}

bool folded_strip(const char* title, const ImVec2& lo, const ImVec2& hi, bool opens_right) {
  ImGui::SetCursorScreenPos(lo);
  const bool pressed = ImGui::InvisibleButton("##unfold", {hi.x - lo.x, hi.y - lo.y});
  const bool hovered = ImGui::IsItemHovered();
  tooltip("Unfolds the panel.");
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (hovered) list->AddRectFilled(lo, hi, colour::field);
  const ImU32 ink = hovered ? colour::text : colour::text_dim;
  const float x = 0.5f * (lo.x + hi.x);
  draw_sign(list, {x, lo.y + px(16)}, px(8), opens_right ? Sign::chevron_right : Sign::chevron_left, true,
            ink);
  // The title is drawn in the corner of the window, then its vertices are rotated by a quarter turn and
  // moved.
  list->PushClipRectFullScreen();
  const int first = list->VtxBuffer.Size;
  const ImVec2 at(std::floor(x + 0.5f * theme().fonts.caps->FontSize), std::floor(lo.y + px(36)));
  draw_caps(list, {0, 0}, upper(title), ink);
  for (int i = first; i < list->VtxBuffer.Size; ++i) {
    const ImVec2 p = list->VtxBuffer[i].pos;
    list->VtxBuffer[i].pos = {at.x - p.y, at.y + p.x};
  }
  list->PopClipRect();
  return pressed;
}

bool splitter(const char* id, const ImVec2& lo, const ImVec2& hi, bool along_x, float direction,
              float& value) {
  ImGui::SetCursorScreenPos(lo);
  ImGui::InvisibleButton(id, {hi.x - lo.x, hi.y - lo.y});
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  if (hovered || active)
    ImGui::SetMouseCursor(along_x ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  if (active)
    value +=
        direction * (along_x ? ImGui::GetIO().MouseDelta.x : ImGui::GetIO().MouseDelta.y) / theme().scale;
  const float middle = std::floor(along_x ? 0.5f * (lo.x + hi.x) : 0.5f * (lo.y + hi.y));
  const ImU32 ink = active ? colour::accent : hovered ? colour::grey(96) : colour::hairline;
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (along_x)
    list->AddLine({middle, lo.y}, {middle, hi.y}, ink);
  else
    list->AddLine({lo.x, middle}, {hi.x, middle}, ink);
  return hovered && ImGui::IsMouseDoubleClicked(0);
}

}  // namespace lucerna::ui
