#include "base/figures.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

namespace lucerna {

std::string real_text(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text[0] != '-') return text;
  // Minus nothing is nothing.
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  return (zero ? "" : "\xE2\x88\x92") + text.substr(1);
}

std::string count_text(double n) {
  std::string digits = fmt::format("{:.0f}", n), result;
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0 && digits[i - 1] != '-')
      result += "\xE2\x80\x88";  // punctuation space
    result += digits[i];
  }
  return result;
}

std::string mean_text(double n) { return n < 99.95 ? fmt::format("{:.3g}", n) : count_text(n); }

std::string ms_text(double ms) {
  if (ms < 99.95) return fmt::format("{:.1f} ms", ms);
  if (ms < 9999.5) return fmt::format("{:.0f} ms", ms);
  return fmt::format("{:.1f} s", ms / 1000);
}

std::string seconds_text(double s) {
  if (s < 99.95) return fmt::format("{:.1f} s", s);
  const auto whole = static_cast<int64_t>(std::llround(s));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string megabytes_text(double mb) {
  return mb < 999.5 ? fmt::format("{:.0f} MB", mb) : fmt::format("{:.2f} GB", mb / 1024);
}

std::string amount_text(double n) {
  if (n < 1e5) return count_text(n);
  if (n < 1e8) return fmt::format("{:.2f} M", 1e-6 * n);
  return fmt::format("{:.2f} G", 1e-9 * n);
}

std::string share_text(double part, double of) {
  if (of <= 0) return k_dash;
  const double percent = 100 * part / of;
  return fmt::format("{:.{}f} %", percent, percent > 99.94 ? 0 : percent > 9.994 ? 1 : 2);
}

std::string metres_text(float m) {
  if (!std::isfinite(m)) return "\xE2\x88\x9E";
  if (m < 0.01f) return fmt::format("{:.2f} mm", 1e3 * double{m});
  if (m < 1) return fmt::format("{:.1f} cm", 1e2 * double{m});
  return fmt::format("{:.3f} m", m);
}

}  // namespace lucerna
