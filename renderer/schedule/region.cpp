#include "schedule/region.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "shaders/shared/film.h"

namespace lucerna::schedule {
namespace {

/// The number before the next comma or the end, which are removed too. False: there is none.
bool take_number(std::string_view& text, double& value) {
  const size_t comma = text.find(',');
  std::string_view word = text.substr(0, comma);
  text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
  while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
}

}  // namespace

std::optional<Region> parse_region(const std::string& text, const std::string& where) {
  if (text.find_first_not_of(' ') == std::string::npos) return std::nullopt;
  std::string_view rest = text;
  Region r;
  bool read = std::count(text.begin(), text.end(), ',') == 3;
  for (double* value : {&r.left, &r.top, &r.width, &r.height}) read = read && take_number(rest, *value);
  if (!read)
    throw_error(where,
                "'{}': expected LEFT,TOP,WIDTH,HEIGHT in fractions of the picture, such as 0.25,0.25,0.5,0.5",
                text);
  const double right = std::min(r.left + r.width, 1.0), bottom = std::min(r.top + r.height, 1.0);
  r.left = std::max(r.left, 0.0), r.top = std::max(r.top, 0.0);
  r.width = right - r.left, r.height = bottom - r.top;
  if (!(r.width > 0 && r.height > 0)) throw_error(where, "'{}': nothing of it is in the picture", text);
  return r;
}

std::string region_text(const Region& r) {
  return fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}", r.left, r.top, r.width, r.height);
}

Rectangle pixels_of(const Region& region, uint32_t width, uint32_t height) {
  const auto edge = [](double at, uint32_t size) {
    return static_cast<uint32_t>(std::clamp(std::round(at * size), 0.0, double(size)));
  };
  const uint32_t left = std::min(edge(region.left, width), width - 1),
                 top = std::min(edge(region.top, height), height - 1);
  return {left, top, std::max(left + 1, edge(region.left + region.width, width)),
          std::max(top + 1, edge(region.top + region.height, height))};
}

Rectangle blocks_of(const Rectangle& pixels) {
  constexpr uint32_t k_side = shared::k_block;
  const auto above = [](uint32_t n) { return n / k_side + (n % k_side != 0); };
  return {pixels.left / k_side, pixels.top / k_side, above(pixels.right), above(pixels.bottom)};
}

std::vector<uint32_t> indices_of(const Rectangle& blocks, uint32_t blocks_across, uint32_t blocks_down) {
  std::vector<uint32_t> indices;
  for (uint32_t y = blocks.top; y < std::min(blocks.bottom, blocks_down); ++y)
    for (uint32_t x = blocks.left; x < std::min(blocks.right, blocks_across); ++x)
      indices.push_back(y * blocks_across + x);
  return indices;
}

}  // namespace lucerna::schedule
