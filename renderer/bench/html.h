#pragma once
// Texts and numbers of the page, and its style sheet.
#include <string>

namespace lucerna::bench {

/// "0.42 s", "4.12 s", "41.2 s", "2 min 10 s", "3 h 05 min".
std::string seconds_text(double seconds);
/// 0.0523 as "5.23 %", three figures.
std::string percent_text(double share);
/// "1.93×"
std::string ratio_text(double ratio);
/// 12345678 as "12.3 M"
std::string count_text(double count);

/// Colour of the setting of that index, as "#rrggbb": the first off-white, the others distinguishable by
/// lightness and hue with any colour vision; none equals a component's colour.
const char* setting_colour(size_t index);

/// The style sheet.
extern const char* const k_style;

}  // namespace lucerna::bench
