// What lies under the pointer in the irradiance cache: the fields of the record in whose disc it rests, and
// which records serve there with which weights. The lines in the picture are drawn by the renderer
// (solvers/irradiance_cache/inspector.h); this is their card.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "shaders/shared/tone.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using irradiance_cache::Inspection;
using irradiance_cache::Irradiance;
using irradiance_cache::Record;

constexpr float k_width = 316, k_row = 17, k_pad = 12;
constexpr float k_figures = 96, k_figure = 39;  // columns of the table of light
constexpr size_t k_weights = 6;                 // shown at most
constexpr ImU32 k_line = IM_COL32(255, 219, 115, 255);

std::string metres(float m) {
  if (!std::isfinite(m)) return "\xE2\x88\x9E";
  if (m < 0.01f) return fmt::format("{:.2f} mm", 1e3 * double{m});
  if (m < 1) return fmt::format("{:.1f} cm", 1e2 * double{m});
  return fmt::format("{:.3f} m", m);
}

std::string vector(const vec3& v, int decimals) {
  return fmt::format("{}  {}  {}", real_text(double{v.x}, decimals), real_text(double{v.y}, decimals),
                     real_text(double{v.z}, decimals));
}

/// In five characters, whatever the size.
std::string figure(float v) {
  const float a = std::abs(v);
  if (v == 0 || (a >= 100 && a < 1e5f)) return fmt::format("{:.0f}", v);
  if (a >= 0.0095f && a < 100) return fmt::format("{:.{}f}", v, a >= 10 ? 1 : a >= 1 ? 2 : 3);
  const int power = static_cast<int>(std::floor(std::log10(a)));
  return fmt::format("{:.0f}e{}", double{v} / std::pow(10.0, power), power);
}

/// A gradient by channel, as the length of its luminance's.
float gradient(const std::array<vec3, 3>& by_channel) {
  return glm::length(0.2126f * by_channel[0] + 0.7152f * by_channel[1] + 0.0722f * by_channel[2]);
}

/// Hue and saturation of light, at full brightness.
ImU32 swatch(const vec3& light) {
  const float most = std::max({light.x, light.y, light.z, 1e-20f});
  const vec3 c = shared::srgb_encode(glm::clamp(light / most, vec3(0), vec3(1)));
  return IM_COL32(static_cast<int>(255 * c.x + 0.5f), static_cast<int>(255 * c.y + 0.5f),
                  static_cast<int>(255 * c.z + 0.5f), 255);
}

/// Writes the card from the top down; first to measure it, then to draw it.
class Card {
 public:
  Card(ImDrawList* list, const ImVec2& lo) : list_(list), lo_(lo), y_(lo.y + px(8)) {}
  float bottom() const { return y_ + px(8); }

  void title(const std::string& left, const std::string& right) {
    text(left, colour::text, Align::left, theme().fonts.strong);
    text(right, colour::text_dim, Align::right);
    y_ += px(k_row + 4);
  }
  void row(const std::string& name, const std::string& value) {
    text(name, colour::text_dim, Align::left);
    text(value, colour::text, Align::right);
    y_ += px(k_row);
  }
  void note(const std::string& what, ImU32 ink = colour::text_dim) {
    text(what, ink, Align::left);
    y_ += px(k_row);
  }
  void space(bool line) {
    y_ += px(5);
    if (list_ && line) list_->AddLine({lo_.x, y_}, {lo_.x + px(k_width), y_}, colour::hairline);
    y_ += px(line ? 6 : 0);
  }

  void light_heading() {
    column(0, 96, "Irradiance", colour::text_dim, Align::left);
    const char* titles[] = {"R", "G", "B", "/rad", "/m"};
    for (int c = 0; c < 5; ++c)
      column(k_figures + k_figure * float(c), k_figures + k_figure * float(c + 1), titles[c],
             colour::text_faint);
    y_ += px(k_row);
  }
  void light(uint32_t part, const Irradiance& e) {
    static constexpr const char* names[] = {"environm.", "secondary", "tertiary", "caustic"};
    const float middle = std::floor(y_ + 0.5f * px(k_row)), x = lo_.x + px(k_pad);
    if (list_) {
      list_->AddRectFilled({x, middle - px(4)}, {x + px(8), middle + px(4)}, colour::component[part], px(2));
      // The light's own colour.
      const float s = x + px(80);
      list_->AddRectFilled({s, middle - px(5)}, {s + px(10), middle + px(5)}, swatch(e.value), px(2));
      list_->AddRect({s, middle - px(5)}, {s + px(10), middle + px(5)}, colour::grey(80), px(2));
    }
    column(14, 80, names[part], colour::text_dim, Align::left);
    const float values[] = {e.value.x, e.value.y, e.value.z, gradient(e.rotation), gradient(e.translation)};
    for (int c = 0; c < 5; ++c)
      column(k_figures + k_figure * float(c), k_figures + k_figure * float(c + 1), figure(values[c]),
             colour::text);
    y_ += px(k_row);
  }
  void weight(const std::string& name, float part, float of) {
    text(name, colour::text_dim, Align::left);
    const float left = lo_.x + px(k_pad + 64), right = lo_.x + px(k_width - k_pad - 56);
    const float middle = std::floor(y_ + 0.5f * px(k_row));
    if (list_)
      list_->AddRectFilled({left, middle - px(3)}, {left + (right - left) * part / of, middle + px(3)},
                           colour::with_alpha(k_line, 0.35f + 0.6f * part / of), px(2));
    text(fmt::format("{:.1f} %", 100 * double{part}), colour::text, Align::right);
    y_ += px(k_row);
  }

 private:
  void text(const std::string& what, ImU32 ink, Align align, ImFont* font = nullptr) {
    if (list_)
      draw_text(list_, {lo_.x + px(k_pad), y_}, {lo_.x + px(k_width - k_pad), y_ + px(k_row)}, what, ink,
                align, font ? font : theme().fonts.small);
  }
  /// From and to: design pixels from the left.
  void column(float from, float to, const std::string& what, ImU32 ink, Align align = Align::right) {
    if (list_)
      draw_text(list_, {lo_.x + px(k_pad + from), y_}, {lo_.x + px(k_pad + to), y_ + px(k_row)}, what, ink,
                align, theme().fonts.small);
  }

  ImDrawList* list_;  // null: measures
  ImVec2 lo_;
  float y_;
};

void fields(Card& card, uint32_t index, const Record& r) {
  card.title(fmt::format("Record {}", count_text(index)),
             fmt::format("pass {} \xC2\xB7 {}", r.pass + 1,
                         irradiance_cache::k_origins[std::min(r.place.origin, 2u)]));
  card.row("Position", vector(r.place.position, 3) + " m");
  card.row("Normal", vector(r.place.normal, 3));
  card.row("Radius", r.lesser_radius < r.radius
                         ? fmt::format("{} x {}", metres(r.lesser_radius), metres(r.radius))
                         : metres(r.radius));
  card.row("Mean distance (harmonic)", metres(r.mean_distance));
  card.row("Least distance", metres(r.least_distance));
  card.row("Rays", count_text(r.rays));
  vec3 sum(0);
  for (const Irradiance& e : r.parts) sum += e.value;
  const float bright = luminance(sum);
  card.row("Standard error",
           bright > 0 ? fmt::format("{} ({:.1f} %)", figure(r.error), 100 * double{r.error / bright})
                      : figure(r.error));
  card.space(false);
  card.light_heading();
  bool any = false;
  for (uint32_t p = 0; p < shared::k_part_count; ++p) {
    if (r.parts[p].value == vec3(0)) continue;
    any = true;
    card.light(p, r.parts[p]);
  }
  if (!any) card.note(r.crowded ? "none: paths gather it here" : "no light", colour::text_faint);
}

void weights(Card& card, const Inspection& found, bool building) {
  if (found.asks == shared::k_asks_nothing) {
    card.note("Nothing diffuse: no record is asked for.", colour::text_dim);
    return;
  }
  if (found.asks == shared::k_asks_in_vain) {
    card.note("The normal map is too steep for records.", colour::warning);
    card.note("It is path traced here.", colour::warning);
    return;
  }
  if (found.gathers) {
    card.note("Too near to something else to interpolate.", colour::text_dim);
    card.note("Paths gather the light here.", colour::text_dim);
    return;
  }
  if (found.count == 0) {
    card.note(building ? "No record serves here yet." : "No record serves here: it is path traced.",
              building ? colour::text_dim : colour::warning);
    return;
  }
  card.note(fmt::format("Served by {} record{}", found.count, found.count == 1 ? "" : "s"));
  const size_t shown = found.serving.size() <= k_weights + 1 ? found.serving.size() : k_weights;
  for (size_t i = 0; i < shown; ++i)
    card.weight(count_text(found.serving[i].record), found.serving[i].weight, found.serving[0].weight);
  if (shown < found.count) {
    float rest = 0;
    for (size_t i = shown; i < found.serving.size(); ++i) rest += found.serving[i].weight;
    card.row(fmt::format("and {} more", found.count - shown), fmt::format("{:.1f} %", 100 * double{rest}));
  }
}

/// Where a card of that size lies in a corner and not over a place; nothing when it does in every one, or has
/// no room.
std::optional<ImVec2> free_corner(const Area& area, const ImVec2& size, float edge, const ImVec2& place) {
  if (size.x + 2 * edge > area.width() || size.y + 2 * edge > area.height()) return std::nullopt;
  const float left = area.lo.x + edge, right = area.hi.x - edge - size.x;
  const float top = area.lo.y + edge, bottom = area.hi.y - edge - size.y, clear = px(40);
  for (const ImVec2& lo : {ImVec2(right, top), ImVec2(left, top), ImVec2(right, bottom)}) {
    const bool over = place.x > lo.x - clear && place.x < lo.x + size.x + clear && place.y > lo.y - clear &&
                      place.y < lo.y + size.y + clear;
    if (!over) return ImVec2(std::floor(lo.x), std::floor(lo.y));
  }
  return std::nullopt;
}

}  // namespace

void draw_inspection(Ui& ui, const Area& area) {
  const session::CacheReport* r = ui.snapshot ? ui.snapshot->cache.get() : nullptr;
  if (!r || !r->looked_at || !r->inspection.solid || !ui.snapshot->activity.empty()) return;
  const Inspection& found = r->inspection;
  bool brief = false;
  const auto write = [&](ImDrawList* list, const ImVec2& lo) {
    Card card(list, lo);
    if (found.record && brief) {
      card.title(fmt::format("Record {}", count_text(*found.under)), metres(found.record->radius));
    } else if (found.record) {
      fields(card, *found.under, *found.record);
      card.space(true);
    }
    weights(card, found, r->status.stop == irradiance_cache::StopReason::building);
    return card.bottom() - lo.y;
  };
  // In the corner that leaves what is looked at free; the upper right one before the others. In a small
  // picture, where none does, the weights alone.
  const ImVec2 at(area.lo.x + r->looked_at->x * area.width(), area.lo.y + r->looked_at->y * area.height());
  const float w = px(k_width), edge = px(12);
  float h = write(nullptr, {0, 0});
  std::optional<ImVec2> lo = free_corner(area, {w, h}, edge, at);
  if (!lo) {
    brief = true;
    h = write(nullptr, {0, 0});
    lo = free_corner(area, {w, h}, edge, at);
  }
  if (!lo) return;
  const ImVec2 hi(lo->x + w, lo->y + h);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(*lo, hi, colour::with_alpha(colour::bar, 0.94f), px(3));
  list->AddRect(*lo, hi, colour::hairline, px(3));
  write(list, *lo);
}

}  // namespace lucerna::ui
