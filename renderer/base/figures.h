#pragma once
// Numbers as text for people, of constant width within a unit: no field that shows them jitters.
#include <string>

namespace lucerna {

std::string real_text(double value, int decimals);  ///< with a true minus sign
std::string count_text(double n);                   ///< 1 234 567 with thin grouping
std::string ms_text(double ms);                     ///< "12.3 ms", "340 ms", "12.4 s"
std::string seconds_text(double s);                 ///< "4.2 s", "2 min 05 s", "1 h 02 min"
std::string megabytes_text(double mb);              ///< "312 MB", "1.42 GB"
/// Counts that may be large, in no more than five figures: "1 234", "2.81 M".
std::string amount_text(double n);
/// "1.82 %" of a whole, in three figures; a dash where there is no whole.
std::string share_text(double part, double of);
/// "0.42 mm", "31.0 cm", "1.030 m".
std::string metres_text(float m);

inline constexpr const char* k_dash = "\xE2\x80\x93";  ///< stands where nothing is known

}  // namespace lucerna
