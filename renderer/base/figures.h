#pragma once
// Numbers as text for display. Width is constant within a unit, so that fields do not jitter.
#include <string>

namespace lucerna {

std::string real_text(double value, int decimals);  ///< with a true minus sign
std::string count_text(double n);                   ///< 1 234 567 with thin grouping
std::string ms_text(double ms);                     ///< "12.3 ms", "340 ms", "12.4 s"
std::string seconds_text(double s);                 ///< "4.2 s", "2 min 05 s", "1 h 02 min"
std::string mean_text(double n);                    ///< a mean count: "12.3", "1 234"
std::string megabytes_text(double mb);              ///< "312 MB", "1.42 GB"
/// A large count in at most five figures: "1 234", "2.81 M".
std::string amount_text(double n);
/// `part` of `of` in percent, three figures: "1.82 %"; a dash if `of` is 0.
std::string share_text(double part, double of);
/// "0.42 mm", "31.0 cm", "1.030 m".
std::string metres_text(float m);

inline constexpr const char* k_dash = "\xE2\x80\x93";  ///< shown for an unknown value

}  // namespace lucerna
