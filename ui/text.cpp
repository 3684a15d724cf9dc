// Text: its inks, measuring, eliding, padding.
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

ImU32 ink(const vec3& encoded) {
  return IM_COL32(static_cast<int>(255 * encoded.x + 0.5f), static_cast<int>(255 * encoded.y + 0.5f),
                  static_cast<int>(255 * encoded.z + 0.5f), 255);
}

ImU32 tone_ink(solvers::Tone tone) {
  switch (tone) {
    case solvers::Tone::normal:
      return colour::text;
    case solvers::Tone::dim:
      return colour::text_dim;
    case solvers::Tone::faint:
      return colour::text_faint;
    case solvers::Tone::accent:
      return colour::accent;
    case solvers::Tone::warning:
      return colour::warning;
  }
  return colour::text;
}

float text_width(const std::string& text, ImFont* font) {
  if (!font) font = theme().fonts.regular;
  return font->CalcTextSizeA(font->FontSize, 1e9f, 0, text.data(), text.data() + text.size()).x;
}

std::string elided(const std::string& text, float max_width, ImFont* font, bool middle) {
  if (text_width(text, font) <= max_width) return text;
  // Bisection over the number of bytes kept; cuts are moved to a code point's border.
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

std::vector<std::string> wrapped(const std::string& text, float max_width, ImFont* font) {
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size();) {
    size_t end = text.size();
    while (text_width(text.substr(begin, end - begin), font) > max_width) {
      const size_t space = text.rfind(' ', end - 1);
      if (space == std::string::npos || space <= begin) break;
      end = space;
    }
    lines.push_back(elided(text.substr(begin, end - begin), max_width, font));
    begin = end == text.size() ? end : end + 1;
  }
  return lines;
}

std::string padded(const std::string& text, size_t width) {
  std::string result;
  for (size_t n = code_points(text); n < width; ++n) result += k_figure_space;
  return result + text;
}

}  // namespace lucerna::ui
