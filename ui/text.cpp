// Text: measuring, eliding, and numbers as text.
#include <fmt/format.h>
#include <cmath>

#include "widgets.h"

namespace lucerna::ui {
namespace {

constexpr const char* k_figure_space = "\xE2\x80\x87";
constexpr const char* k_ellipsis = "\xE2\x80\xA6";

bool continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

size_t code_points(const std::string& text) {
  size_t n = 0;
  for (char c : text) n += !continuation(c);
  return n;
}

}  // namespace

float text_width(const std::string& text, ImFont* font) {
  if (!font) font = theme().fonts.regular;
  return font->CalcTextSizeA(font->FontSize, 1e9f, 0, text.data(), text.data() + text.size()).x;
}

std::string elided(const std::string& text, float max_width, ImFont* font, bool middle) {
  if (text_width(text, font) <= max_width) return text;
  // Bisection over the bytes kept; cuts are moved to the edge of a code point.
  const auto made = [&](size_t kept) {
    if (!middle) {
      while (kept > 0 && kept < text.size() && continuation(text[kept])) --kept;
      return text.substr(0, kept) + k_ellipsis;
    }
    size_t head = kept / 3, tail = text.size() - (kept - kept / 3);
    while (head > 0 && continuation(text[head])) --head;
    while (tail < text.size() && continuation(text[tail])) ++tail;
    return text.substr(0, head) + k_ellipsis + text.substr(tail);
  };
  size_t lo = 0, hi = text.size();
  while (lo < hi) {
    const size_t mid = (lo + hi + 1) / 2;
    if (text_width(made(mid), font) <= max_width)
      lo = mid;
    else
      hi = mid - 1;
  }
  return made(lo);
}

std::string padded(const std::string& text, size_t width) {
  std::string result;
  for (size_t n = code_points(text); n < width; ++n) result += k_figure_space;
  return result + text;
}

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

}  // namespace lucerna::ui
