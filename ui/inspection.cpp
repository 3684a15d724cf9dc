// Solvers' data at the inspected point, in a card over the picture (solvers::Card). The renderer draws lines
// in the picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "shaders/shared/tone.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using solvers::Card;

constexpr float k_width = 316, k_row = 17, k_pad = 12;
constexpr float k_figures = 96, k_figure = 39;  // columns of figures
constexpr ImU32 k_line = IM_COL32(255, 219, 115, 255);

/// Hue and saturation of light, at full brightness.
ImU32 swatch(const vec3& light) {
  const float most = std::max({light.x, light.y, light.z, 1e-20f});
  return ink(shared::srgb_encode(glm::clamp(light / most, vec3(0), vec3(1))));
}

/// Writes a card from the top down; first to measure it, then to draw it.
class Writer {
 public:
  Writer(ImDrawList* list, const ImVec2& lo) : list_(list), lo_(lo), y_(lo.y + px(8)) {}
  float bottom() const { return y_ + px(8); }

  void operator()(const Card::Title& title) {
    text(title.left, colour::text, Align::left, theme().fonts.strong);
    text(title.right, colour::text_dim, Align::right);
    y_ += px(k_row + 4);
  }
  void operator()(const Card::Row& row) {
    text(row.name, colour::text_dim, Align::left);
    text(row.value, colour::text, Align::right);
    y_ += px(k_row);
  }
  void operator()(const Card::Note& note) {
    text(note.text, tone_ink(note.tone), Align::left);
    y_ += px(k_row);
  }
  void operator()(const Card::Rule& rule) {
    y_ += px(5);
    if (list_ && rule.line) list_->AddLine({lo_.x, y_}, {lo_.x + px(k_width), y_}, colour::hairline);
    y_ += px(rule.line ? 6 : 0);
  }
  void operator()(const Card::FigureHeads& heads) {
    column(0, k_figures, heads.name, colour::text_dim, Align::left);
    figures(heads.columns, colour::text_faint);
    y_ += px(k_row);
  }
  void operator()(const Card::Figures& row) {
    const float middle = std::floor(y_ + 0.5f * px(k_row)), x = lo_.x + px(k_pad);
    if (list_) {
      const auto component =
          static_cast<size_t>(std::clamp(row.component, 0, static_cast<int>(colour::component.size()) - 1));
      list_->AddRectFilled({x, middle - px(4)}, {x + px(8), middle + px(4)}, colour::component[component],
                           px(2));
      // The light's colour.
      const float s = x + px(80);
      list_->AddRectFilled({s, middle - px(5)}, {s + px(10), middle + px(5)}, swatch(row.light), px(2));
      list_->AddRect({s, middle - px(5)}, {s + px(10), middle + px(5)}, colour::grey(80), px(2));
    }
    column(14, 80, row.name, colour::text_dim, Align::left);
    figures(row.figures, colour::text);
    y_ += px(k_row);
  }
  void operator()(const Card::Weight& weight) {
    text(weight.name, colour::text_dim, Align::left);
    const float left = lo_.x + px(k_pad + 64), right = lo_.x + px(k_width - k_pad - 56);
    const float middle = std::floor(y_ + 0.5f * px(k_row)), length = weight.part / weight.of;
    if (list_)
      list_->AddRectFilled({left, middle - px(3)}, {left + (right - left) * length, middle + px(3)},
                           colour::with_alpha(k_line, 0.35f + 0.6f * length), px(2));
    text(fmt::format("{:.1f} %", 100 * double{weight.part}), colour::text, Align::right);
    y_ += px(k_row);
  }

 private:
  void text(const std::string& what, ImU32 colour, Align align, ImFont* font = nullptr) {
    if (list_)
      draw_text(list_, {lo_.x + px(k_pad), y_}, {lo_.x + px(k_width - k_pad), y_ + px(k_row)}, what, colour,
                align, font ? font : theme().fonts.small);
  }
  /// From and to: design pixels from the left.
  void column(float from, float to, const std::string& what, ImU32 colour, Align align = Align::right) {
    if (list_)
      draw_text(list_, {lo_.x + px(k_pad + from), y_}, {lo_.x + px(k_pad + to), y_ + px(k_row)}, what, colour,
                align, theme().fonts.small);
  }
  void figures(const std::vector<std::string>& texts, ImU32 colour) {
    float from = k_figures;
    for (const std::string& figure : texts) column(from, from + k_figure, figure, colour), from += k_figure;
  }

  ImDrawList* list_;  // null: measures only
  ImVec2 lo_;
  float y_;
};

/// Where a card of that size lies in a corner, neither over a place nor over `taken`; nothing if no corner is
/// free, or if it has no room.
std::optional<ImVec2> free_corner(const Area& area, const ImVec2& size, float edge, const ImVec2& place,
                                  const Area& taken) {
  if (size.x + 2 * edge > area.width() || size.y + 2 * edge > area.height()) return std::nullopt;
  const float left = area.lo.x + edge, right = area.hi.x - edge - size.x;
  const float top = area.lo.y + edge, bottom = area.hi.y - edge - size.y, clear = px(40);
  for (const ImVec2& lo : {ImVec2(right, top), ImVec2(left, top), ImVec2(right, bottom)}) {
    const bool over = place.x > lo.x - clear && place.x < lo.x + size.x + clear && place.y > lo.y - clear &&
                      place.y < lo.y + size.y + clear;
    const bool covers =
        lo.x < taken.hi.x && lo.x + size.x > taken.lo.x && lo.y < taken.hi.y && lo.y + size.y > taken.lo.y;
    if (!over && !covers) return ImVec2(std::floor(lo.x), std::floor(lo.y));
  }
  return std::nullopt;
}

}  // namespace

void draw_inspection(const session::Snapshot& picture, const Area& area, const Area& legend) {
  if (!picture.activity.empty()) return;
  // The cards of all solvers with data there, one below the other on a common background.
  std::vector<const Card*> cards;
  std::optional<vec2> place;
  for (const auto& report : picture.reports)
    if (report->card && report->looked_at) cards.push_back(&*report->card), place = report->looked_at;
  if (cards.empty()) return;
  Card::Room room = Card::Room::much;
  const auto write = [&](ImDrawList* list, const ImVec2& lo) {
    Writer writer(list, lo);
    for (const Card* card : cards) {
      if (card != cards.front()) writer(Card::Rule{.line = true});
      for (const Card::Line& line : card->lines)
        if (line.room == Card::Room::any || line.room == room) std::visit(writer, line.what);
    }
    return writer.bottom() - lo.y;
  };
  // In a corner that keeps the inspected point visible, the upper right one first. In a small picture, where
  // no corner does, shortened.
  const ImVec2 at(area.lo.x + place->x * area.width(), area.lo.y + place->y * area.height());
  const float w = px(k_width), edge = px(12);
  float h = write(nullptr, {0, 0});
  std::optional<ImVec2> lo = free_corner(area, {w, h}, edge, at, legend);
  if (!lo) {
    room = Card::Room::little;
    h = write(nullptr, {0, 0});
    lo = free_corner(area, {w, h}, edge, at, legend);
  }
  if (!lo) return;
  const ImVec2 hi(lo->x + w, lo->y + h);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(*lo, hi, colour::with_alpha(colour::bar, 0.94f), px(3));
  list->AddRect(*lo, hi, colour::hairline, px(3));
  write(list, *lo);
}

}  // namespace lucerna::ui
