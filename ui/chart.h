#pragma once
// Plots: logarithmic axes and their ticks, durations in round words, dashed lines. Everything except drawing
// works without a window.
#include <imgui.h>

#include <string>
#include <vector>

namespace lucerna::ui {

/// A logarithmic axis, 0 < lo < hi, between two places on the screen (window pixels; `to` is above `from` if
/// the axis goes up).
struct LogAxis {
  double lo = 1, hi = 10;
  float from = 0, to = 1;
  float at(double value) const;  ///< values beyond the ends, and 0, are slightly outside
  double value(float place) const;
};

enum class Unit { seconds, relative, milliseconds, count };

struct Tick {
  double value;
  bool labelled;  ///< otherwise a short, unlabelled one
};
/// Ticks at 1-2-5 (seconds: also at whole minutes and hours), increasing. Labels are at least `room` pixels
/// from each other and thinned out evenly otherwise.
std::vector<Tick> ticks(const LogAxis& axis, Unit unit, float room);
/// "0.1 s", "2 min", "0.5 %", "20 ms", "1k": as short as possible.
std::string tick_text(double value, Unit unit);

/// The next 1-2-5 at or below, at or above a value (> 0).
double nice_below(double value);
double nice_above(double value);

/// A duration to about two figures: "4.2 s", "2 min 10 s", "3 h 20 min", "12 days".
std::string about_text(double seconds);
/// A fraction in percent, at least two figures: "1.8 %"; from ten on "> 999 %".
std::string percent_text(double fraction);

/// Rounds a dragged target to two figures, within the setting's range.
double snapped_target(double value);

/// A line through the points in dashes of `on` pixels and gaps of `off`.
void dashed_line(ImDrawList* list, const std::vector<ImVec2>& points, ImU32 colour, float on, float off,
                 float width);

}  // namespace lucerna::ui
