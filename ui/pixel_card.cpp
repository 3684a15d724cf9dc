#include "pixel_card.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "widgets.h"

namespace lucerna::ui {
namespace {

constexpr double k_hold = 0.5;  // seconds
constexpr float k_still = 4;    // design pixels that the pointer may move
constexpr float k_line = 16, k_pad = 10, k_edge = 12, k_gap = 12;

struct Cell {
  std::string text;
  ImU32 colour = colour::text;
};

/// Rows of a name and numbers below each other, or of a name and one text.
struct Table {
  static constexpr size_t k_columns = 5;
  struct Row {
    Cell name;
    std::array<Cell, k_columns> numbers;
    Cell text;  ///< instead of numbers
  };
  std::vector<Row> rows;

  static float wide(const std::string& text) { return text_width(text, theme().fonts.small); }
  /// Width of the names, and of each column of numbers with its gap.
  float names() const {
    float most = 0;
    for (const Row& row : rows) most = std::max(most, wide(row.name.text));
    return most + px(k_gap);
  }
  float column(size_t c) const {
    float most = 0;
    for (const Row& row : rows) most = std::max(most, wide(row.numbers[c].text));
    return most > 0 ? most + px(k_gap) : 0;
  }
  float width() const {
    float numbers = 0, text = 0;
    for (size_t c = 0; c < k_columns; ++c) numbers += column(c);
    for (const Row& row : rows) text = std::max(text, wide(row.text.text));
    return names() + std::max(numbers, text);
  }
  void draw(ImDrawList* list, const ImVec2& lo, const ImVec2& hi) const;
};

void Table::draw(ImDrawList* list, const ImVec2& lo, const ImVec2& hi) const {
  ImFont* const font = theme().fonts.small;
  std::array<float, k_columns> columns;
  for (size_t c = 0; c < k_columns; ++c) columns[c] = column(c);
  const float after_names = lo.x + names();
  float y = lo.y;
  for (const Row& row : rows) {
    const float bottom = y + px(k_line);
    if (bottom > hi.y) break;
    draw_text(list, {lo.x, y}, {hi.x, bottom}, elided(row.name.text, hi.x - lo.x, font), row.name.colour,
              Align::left, font);
    draw_text(list, {after_names, y}, {hi.x, bottom}, elided(row.text.text, hi.x - after_names, font),
              row.text.colour, Align::left, font);
    float x = after_names;
    for (size_t c = 0; c < k_columns; ++c) {
      x += columns[c];
      if (x <= hi.x + 1)
        draw_text(list, {x - columns[c], y}, {x - px(k_gap), bottom}, row.numbers[c].text,
                  row.numbers[c].colour, Align::right, font);
    }
    y = bottom;
  }
}

Table::Row layer_row(const commands::PixelLayer& layer) {
  Table::Row row{.name = {layer.name == "rgb" ? "sum" : layer.name}, .numbers = {}, .text = {}};
  for (size_t c = 0; c < session::k_component_names.size(); ++c)
    if (layer.name == session::k_component_names[c]) row.name.colour = colour::component[c];
  for (size_t c = 0; c < std::min<size_t>(layer.value.size(), 3); ++c)
    row.numbers[c].text = fmt::format("{:.4g}", layer.value[c]);
  const auto error = [](const std::optional<double>& e) {
    return Cell{e ? fmt::format("\xC2\xB1 {:.2g}", *e) : "", colour::text_dim};
  };
  row.numbers[3] = error(layer.noise), row.numbers[4] = error(layer.tile_noise);
  return row;
}

Table table_of(const commands::PixelInquiry& pixel) {
  const auto text_row = [](std::string name, std::string text) {
    return Table::Row{.name = {std::move(name), colour::text_dim}, .numbers = {}, .text = {std::move(text)}};
  };
  Table table;
  const commands::PixelReport& report = pixel.report;
  if (report.layers.empty()) {
    for (const std::string& line : pixel.lines) table.rows.push_back(text_row("", line));
    return table;
  }
  table.rows.push_back(text_row(fmt::format("Pixel {} {}", report.x, report.y),
                                fmt::format("{} sample{}", report.samples, report.samples == 1 ? "" : "s")));
  table.rows.push_back({});
  constexpr const char* k_heads[] = {"red", "green", "blue", "noise", "in its tile"};
  for (size_t c = 0; c < Table::k_columns; ++c) table.rows.back().numbers[c] = {k_heads[c], colour::text_dim};
  for (const commands::PixelLayer& layer : report.layers) table.rows.push_back(layer_row(layer));
  if (report.lookup_noise)
    table.rows.push_back(text_row("records", fmt::format("noise {:.2g} in its tile", *report.lookup_noise)));
  if (report.lookup_bias)
    table.rows.push_back(text_row("lookups", fmt::format("bias {:.2g} in its tile", *report.lookup_bias)));
  table.rows.push_back({});
  for (const std::string& line : pixel.surface) {
    const size_t colon = line.find(": ");
    table.rows.push_back(colon == std::string::npos
                             ? text_row("", line)
                             : text_row(line.substr(0, colon), line.substr(colon + 2)));
  }
  table.rows.push_back({.name = {"I: trace its paths", colour::text_faint}, .numbers = {}, .text = {}});
  return table;
}

}  // namespace

bool inspect_while_held(Viewport& view, const Area& picture, bool active) {
  const ImGuiIO& io = ImGui::GetIO();
  HeldPixel& held = view.held_pixel;
  const bool pressed =
      active && io.MouseDown[0] && !view.click_taken() && !view.drag.lamp && !view.drag.object;
  if (!pressed) {
    held.since.reset();
    if (!std::exchange(held.reported, false)) return false;
    view.controls.act("inspect.none");
    return true;
  }
  if (!held.since) held.since = view.work.now;
  const bool still = io.MouseDragMaxDistanceSqr[0] < px(k_still) * px(k_still);
  if (held.reported || !still || view.work.open.loading() || !view.has_picture()) return false;
  view.controls.actions.wake(2);
  if (view.work.now - *held.since < k_hold) return false;
  if (!picture.contains(io.MousePos)) return false;
  const vec2 place = picture.place_of(io.MousePos);
  held.reported = true;
  view.controls.act("inspect.pixel", place.x, place.y);
  return false;
}

void draw_pixel_card(const commands::Workspace& work, const Area& picture) {
  if (!work.pixel || work.pixel->lines.empty()) return;
  const Table table = table_of(*work.pixel);
  const float width = std::min(table.width() + 2 * px(k_pad), picture.width() - 2 * px(k_edge));
  const float height = std::min(px(k_line) * static_cast<float>(table.rows.size()) + 2 * px(k_pad),
                                picture.height() - 2 * px(k_edge));
  if (width < px(80) || height < px(40)) return;
  // On the side of the picture that the pixel is not on.
  const bool right = work.pixel->at.x < 0.5f;
  const ImVec2 lo(std::floor(right ? picture.hi.x - width - px(k_edge) : picture.lo.x + px(k_edge)),
                  std::floor(picture.lo.y + px(k_edge)));
  ImDrawList* list = card(lo, {lo.x + width, lo.y + height});
  const ImVec2 at(picture.lo.x + work.pixel->at.x * picture.width(),
                  picture.lo.y + work.pixel->at.y * picture.height());
  list->AddCircle(at, px(5), colour::accent, 0, px(1));
  table.draw(list, {lo.x + px(k_pad), lo.y + px(k_pad)}, {lo.x + width - px(k_pad), lo.y + height});
}

}  // namespace lucerna::ui
