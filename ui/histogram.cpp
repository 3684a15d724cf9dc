#include "histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "widgets.h"

namespace lucerna::ui {
namespace {

constexpr float k_curve_width = 256, k_curve_height = 96, k_card_pad = 10, k_card_edge = 12, k_card_line = 18;
constexpr std::array<ImU32, Histogram::curves> k_curve_inks = {
    IM_COL32(226, 92, 84, 255), IM_COL32(104, 190, 110, 255), IM_COL32(96, 142, 236, 255), colour::text};

/// "0.42 %"; "0 %" means none.
std::string clipped_text(uint32_t part, uint32_t whole) {
  if (part == 0 || whole == 0) return "0 %";
  const double percent = 100.0 * part / whole;
  return percent < 0.01 ? "< 0.01 %" : fmt::format("{:.{}f} %", percent, percent < 10 ? 2 : 1);
}

}  // namespace

Histogram histogram_of(std::span<const uint8_t> rgba) {
  Histogram h;
  for (size_t i = 0; i + 3 < rgba.size(); i += 4) {
    const uint32_t r = rgba[i], g = rgba[i + 1], b = rgba[i + 2];
    ++h.counts[Histogram::red][r], ++h.counts[Histogram::green][g], ++h.counts[Histogram::blue][b];
    // Weights in 1/65536; they sum to one.
    ++h.counts[Histogram::luma][(13933 * r + 46871 * g + 4732 * b + 32768) >> 16];
    h.white += std::max({r, g, b}) == 255;
    h.black += r + g + b == 0;
    ++h.pixels;
  }
  return h;
}

void HistogramView::draw(const session::Snapshot& picture, const Area& frame, const Area& room) {
  if (!on || picture.rgba.empty()) return;
  if (id_ != picture.id) histogram_ = histogram_of(picture.rgba), id_ = picture.id;
  const Histogram& h = histogram_;
  const float w = px(k_curve_width) + 2 * px(k_card_pad),
              height = px(k_curve_height) + 2 * px(k_card_pad) + 2 * px(k_card_line);
  const Area& in =
      frame.width() > w + 2 * px(k_card_edge) && frame.height() > height + 2 * px(k_card_edge) ? frame : room;
  if (in.width() < w + 2 * px(k_card_edge) || in.height() < height + 2 * px(k_card_edge)) return;
  const ImVec2 hi(std::floor(std::min(in.hi.x, room.hi.x) - px(k_card_edge)),
                  std::floor(std::min(in.hi.y, room.hi.y) - px(k_card_edge)));
  const ImVec2 lo(hi.x - w, hi.y - height);
  ImDrawList* list = card(lo, hi, 0.92f);
  const ImVec2 at(lo.x + px(k_card_pad), lo.y + px(k_card_pad)),
      end(at.x + px(k_curve_width), at.y + px(k_curve_height));
  for (int quarter = 1; quarter < 4; ++quarter) {
    const float x = std::floor(at.x + px(k_curve_width) * static_cast<float>(quarter) / 4);
    list->AddLine({x, at.y}, {x, end.y}, colour::hairline);
  }
  list->AddLine({at.x, end.y}, {end.x, end.y}, colour::grey(90));
  // Black and white often have most of the pixels: the scale is that of the others.
  uint32_t most = 1;
  for (const auto& counts : h.counts)
    most = std::max(most, *std::max_element(counts.begin() + 1, counts.end() - 1));
  const auto point = [&](size_t curve, size_t bin) {
    const double share = std::min(1.0, double(h.counts[curve][bin]) / most);
    return ImVec2(at.x + px(k_curve_width) * (static_cast<float>(bin) + 0.5f) / Histogram::k_bins,
                  end.y - px(k_curve_height) * static_cast<float>(std::sqrt(share)));
  };
  for (size_t curve = 0; curve < Histogram::curves; ++curve)
    for (size_t bin = 1; bin < Histogram::k_bins; ++bin)
      list->AddLine(point(curve, bin - 1), point(curve, bin),
                    colour::with_alpha(k_curve_inks[curve], curve == Histogram::luma ? 0.9f : 0.75f), px(1));
  ImFont* font = theme().fonts.small;
  const ImVec2 text(end.x, end.y + px(4) + px(k_card_line));
  draw_text(list, {at.x, end.y + px(4)}, text, "black " + clipped_text(h.black, h.pixels),
            h.black > 0 ? colour::text : colour::text_dim, Align::left, font);
  draw_text(list, {at.x, end.y + px(4)}, text, "clipped " + clipped_text(h.white, h.pixels),
            h.white > 0 ? colour::warning : colour::text_dim, Align::right, font);
  draw_text(list, {at.x, text.y}, {end.x, text.y + px(k_card_line)}, "display value 0 to 255; R G B and luma",
            colour::text_dim, Align::left, font);
}

}  // namespace lucerna::ui
