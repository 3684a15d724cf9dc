#pragma once
// The few controls that the window is made of. All take design pixels where they take sizes; all fill the
// width left in their column unless told otherwise. Ids follow ImGui's rules ("##name").
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
/// The longest head of `text` that fits, with an ellipsis when something was left out. `middle` leaves out
/// the middle (paths: the file name stays).
std::string elided(const std::string& text, float max_width, ImFont* font = nullptr, bool middle = false);
/// Draws text in a box of the window (window pixels) without moving the cursor.
void draw_text(ImDrawList* list, const ImVec2& lo, const ImVec2& hi, const std::string& text, ImU32 colour,
               Align align = Align::left, ImFont* font = nullptr);
float text_width(const std::string& text, ImFont* font = nullptr);

/// Shows `text` when the last item has been hovered for a moment. Disabled items too.
void tooltip(const std::string& text);

/// Heading of a foldable section: capitals, a chevron, a hairline above. Returns whether it is open.
bool section(const char* title, bool& open, const std::string& right = "");
/// Room at the sides of a panel's content; begin returns the content width in window pixels.
float begin_padded(float design = 12);
void end_padded(float design = 12);
void gap(float design);
void hairline();

/// "name .......... value" on one line; the value may be dim.
void value_row(const std::string& name, const std::string& value, const std::string& help = "",
               ImU32 value_colour = colour::text);

/// A panel that lies over the picture: background and outline; what is drawn goes to the list that is
/// returned.
ImDrawList* card(const ImVec2& lo, const ImVec2& hi, float alpha = 0.95f);

/// A flat button; `on` shows it pressed. Width 0: that of its text.
bool button(const char* id, const std::string& text, bool on = false, float width = 0, ImU32 mark = 0);
/// A small square toggle with a drawn sign: 'eye', 'S' and the like.
enum class Sign { eye, solo, power, close, chevron_left, chevron_right, chevron_down, chevron_up, tick };
bool sign_button(const char* id, Sign sign, bool on, ImU32 on_colour = colour::text, float size = 22);
void draw_sign(ImDrawList* list, const ImVec2& centre, float size, Sign sign, bool on, ImU32 colour);

/// A number with its name inside a bar that shows where in its range it stands. Drag; Shift is ten times
/// finer; Ctrl is ten times coarser; double-click to type. `log`: the range is even in factors (lo > 0).
/// Returns whether it changed.
struct Slider {
  float lo = 0, hi = 1;
  bool log = false;
  int decimals = 2;
  std::string unit;
  bool bar = true;    ///< show the filled part
  bool sign = false;  ///< show + for positive values
  float step = 0;     ///< values are multiples of it, when > 0
  float travel = 1;   ///< share of the range that a drag across the control goes through
  /// What may be typed, when that is more than a drag reaches (typed_lo < typed_hi).
  float typed_lo = 0, typed_hi = 0;
  std::string at_zero{};  ///< shown for 0, which then is the left end, and `log` begins beside it with 1
};
bool slider(const char* id, const std::string& name, float& value, const Slider& how, float width = 0);

/// Three numbers with one name in a row of fields, each dragged by itself; `how` is that of each. Returns
/// which one changed (0, 1, 2), or -1.
int slider_row(const char* id, const std::string& name, vec3& value, const Slider& how);

/// Linear colours as bytes of the display.
ImU32 display_colour(const vec3& linear);
/// A field with a name and a colour; pressed, it opens a picker. `note` stands beside the name. The colour is
/// linear, 0..1 in each channel. Returns whether it changed.
bool colour_field(const char* id, const std::string& name, vec3& linear, const std::string& note = "");

/// A drop-down; `index` < 0 shows nothing chosen. `helps`: tooltips of the entries, in their order.
bool choice(const char* id, const std::string& name, const std::vector<std::string>& entries, int& index,
            float width = 0, const std::vector<std::string>& helps = {});

/// A thin bar of several parts (fractions of the width).
struct Part {
  float fraction;
  ImU32 colour;
};
void stacked_bar(const std::vector<Part>& parts, float height, float width = 0);

/// What is left of a folded side panel: its title upwards and an arrow. Returns whether it was pressed.
bool folded_strip(const char* title, const ImVec2& lo, const ImVec2& hi, bool opens_right);

/// A splitter: a strip that drags `value` (design pixels) by the mouse along x or y; `direction` -1 when the
/// panel grows the other way. Returns whether it is in use.
bool splitter(const char* id, const ImVec2& lo, const ImVec2& hi, bool along_x, float direction,
              float& value);

/// Pads with figure spaces on the left to `width` digits, so that a changing number keeps its place.
std::string padded(const std::string& text, size_t width);

}  // namespace lucerna::ui
