#include "list_rows.h"

#include <algorithm>

namespace lucerna::ui {

bool list_row(const char* id, bool chosen, const std::string& name, const std::string& note, ImU32 mark,
              float inset_right, float height) {
  const float width = ImGui::CalcItemWidth();
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + px(height));
  const bool pressed = ImGui::InvisibleButton(id, {std::max(1.0f, width - px(inset_right)), px(height)});
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (chosen || hovered)
    list->AddRectFilled({lo.x - px(4), lo.y}, {hi.x + px(4), hi.y},
                        chosen ? colour::field_active : colour::field, px(3));
  float x = lo.x;
  if (mark) {
    const float y = 0.5f * (lo.y + hi.y);
    list->AddRectFilled({x, y - px(5)}, {x + px(10), y + px(5)}, mark, px(2));
    list->AddRect({x, y - px(5)}, {x + px(10), y + px(5)}, colour::grey(80), px(2));
    x += px(18);
  }
  const float note_width = note.empty() ? 0 : text_width(note) + px(8);
  const float right = hi.x - px(inset_right);
  draw_text(list, {x, lo.y}, {right, hi.y}, elided(name, std::max(0.0f, right - note_width - x)),
            chosen || hovered ? colour::text : colour::text);
  if (!note.empty()) draw_text(list, {x, lo.y}, {right, hi.y}, note, colour::text_faint, Align::right);
  return pressed;
}

void choose(Actions& actions, SceneView& view, bool chosen, const char* kind, size_t index) {
  view.chosen_in_list = true;
  if (chosen)
    actions.act("select.none");
  else
    actions.act("select", kind, index + 1);
}
void quiet_line(const std::string& text) { label(text, colour::text_faint); }

bool row_sign(const ImVec2& row, const char* id, Sign sign, bool on, const char* help) {
  const float below = ImGui::GetCursorScreenPos().y;
  ImGui::SetCursorScreenPos({row.x + ImGui::CalcItemWidth() - px(22), row.y + px(1)});
  const bool pressed = sign_button(id, sign, on);
  tooltip(help);
  ImGui::SetCursorScreenPos({row.x, below});
  return pressed;
}

void show_row(float y) {
  const ImVec2 window = ImGui::GetWindowPos();
  if (y < window.y || y + px(24) > window.y + ImGui::GetWindowHeight())
    ImGui::SetScrollFromPosY(y - window.y, 0.5f);
}

}  // namespace lucerna::ui
