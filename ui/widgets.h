#pragma once
// The controls of the window. Sizes are design pixels; controls fill the remaining width of their column
// unless a width is given. Ids follow ImGui's rules ("##name").
#include <string>
#include <vector>

#include "base/figures.h"
#include "base/math.h"
#include "solvers/report.h"
#include "theme.h"

namespace lucerna::ui {

enum class Align { left, centre, right };

ImU32 ink(const vec3& encoded);      ///< sRGB, 0..1
ImU32 tone_ink(solvers::Tone tone);  ///< of text

/// Text in a font and colour; elided with an ellipsis at `max_width` window pixels (0: not).
void label(const std::string& text, ImU32 colour = colour::text, ImFont* font = nullptr, float max_width = 0);
/// The longest beginning of `text` that fits, with an ellipsis if cut. `middle` cuts the middle (paths: the
/// file name stays).
std::string elided(const std::string& text, float max_width, ImFont* font = nullptr, bool middle = false);
/// Lines of `text` that fit, broken at spaces; a word that does not fit is cut like elided().
std::vector<std::string> wrapped(const std::string& text, float max_width, ImFont* font = nullptr);
/// Draws text in a box of the window (window pixels) without moving the cursor.
void draw_text(ImDrawList* list, const ImVec2& lo, const ImVec2& hi, const std::string& text, ImU32 colour,
               Align align = Align::left, ImFont* font = nullptr);
float text_width(const std::string& text, ImFont* font = nullptr);

/// Text wrapped at the width of items.
void paragraph(const std::string& text, ImU32 colour = colour::text_dim);

/// Shows `text` after the last item, disabled or not, was hovered for a moment.
void tooltip(const std::string& text);

/// Heading of a foldable section: capitals, a chevron, a hairline above. Returns whether it is open.
bool section(const char* title, bool& open, const std::string& right = "");
/// Margins of a panel's content; begin returns the content width in window pixels.
float begin_padded(float design = 12);
void end_padded(float design = 12);
void gap(float design);
void hairline();

/// "name .......... value" on one line.
void value_row(const std::string& name, const std::string& value, const std::string& help = "",
               ImU32 value_colour = colour::text);

/// A card over the picture: background and outline. Draw its content to the returned list.
ImDrawList* card(const ImVec2& lo, const ImVec2& hi, float alpha = 0.95f);

/// A flat button; `on` shows it pressed. Width 0: that of its text.
bool button(const char* id, const std::string& text, bool on = false, float width = 0, ImU32 mark = 0);
/// A small square toggle with a drawn sign: 'eye', 'S' and the like.
enum class Sign { eye, solo, power, close, chevron_left, chevron_right, chevron_down, chevron_up, tick };
bool sign_button(const char* id, Sign sign, bool on, ImU32 on_colour = colour::text, float size = 22);
void draw_sign(ImDrawList* list, const ImVec2& centre, float size, Sign sign, bool on, ImU32 colour);

/// A number with its name in a bar that shows its position in the range. Drag; Shift is ten times finer, Ctrl
/// ten times coarser; double-click to type. `log`: logarithmic range (lo > 0). Returns whether it changed.
struct Slider {
  float lo = 0, hi = 1;
  bool log = false;
  int decimals = 2;
  std::string unit;
  bool bar = true;    ///< show the filled part
  bool sign = false;  ///< show + for positive values
  float step = 0;     ///< values are multiples of it, when > 0
  float travel = 1;   ///< share of the range that a drag across the control covers
  /// Range for typed values, if larger than that of dragging (typed_lo < typed_hi).
  float typed_lo = 0, typed_hi = 0;
  std::string at_zero{};  ///< text for 0, which is then the left end; `log` starts beside it with 1
};
bool slider(const char* id, const std::string& name, float& value, const Slider& how, float width = 0);

/// Three numbers with one name in a row of fields, each dragged separately; `how` applies to each. Returns
/// the changed one (0, 1, 2), or -1.
int slider_row(const char* id, const std::string& name, vec3& value, const Slider& how);

/// A linear colour in display values.
ImU32 display_colour(const vec3& linear);
/// A field with a name and a colour; pressed, it opens a picker. `note` is shown beside the name. The colour
/// is linear, 0..1 in each channel. Returns whether it changed.
bool colour_field(const char* id, const std::string& name, vec3& linear, const std::string& note = "");

/// A drop-down; `index` < 0 shows no choice. `helps`: tooltips of the entries, in their order. `shown`: text
/// for the choice instead of its entry.
bool choice(const char* id, const std::string& name, const std::vector<std::string>& entries, int& index,
            float width = 0, const std::vector<std::string>& helps = {}, const std::string& shown = "");

/// A thin bar of several parts (fractions of the width).
struct Part {
  float fraction;
  ImU32 colour;
};
void stacked_bar(const std::vector<Part>& parts, float height, float width = 0);

/// A folded side panel: its title upwards and an arrow. Returns whether it was pressed.
bool folded_strip(const char* title, const ImVec2& lo, const ImVec2& hi, bool opens_right);

/// A splitter: a strip that drags `value` (design pixels) along x or y; `direction` -1 if the panel grows the
/// other way. Returns whether it is in use.
bool splitter(const char* id, const ImVec2& lo, const ImVec2& hi, bool along_x, float direction,
              float& value);

/// Pads with figure spaces on the left to `width` digits, so that a changing number stays in place.
std::string padded(const std::string& text, size_t width);

}  // namespace lucerna::ui
