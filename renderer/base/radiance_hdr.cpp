#include "base/radiance_hdr.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

namespace lucerna {
namespace {

/// The numbers that the text begins with; nothing unless all are positive.
template <size_t N>
std::optional<std::array<double, N>> numbers(std::string_view text) {
  const std::string copy(text);
  const char* at = copy.c_str();
  std::array<double, N> values{};
  for (double& value : values) {
    char* end = nullptr;
    value = std::strtod(at, &end);
    if (end == at || !(value > 0) || !std::isfinite(value)) return std::nullopt;
    at = end;
  }
  return values;
}

struct Axis {
  char sign = 0, name = 0;
  uint32_t count = 0;
};

/// "-Y 512 " off the text's front.
std::optional<Axis> take_axis(std::string_view& text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  if (text.size() < 4) return std::nullopt;
  Axis axis{text[0], text[1]};
  if ((axis.sign != '-' && axis.sign != '+') || (axis.name != 'X' && axis.name != 'Y')) return std::nullopt;
  text.remove_prefix(2);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), axis.count);
  if (error != std::errc() || axis.count == 0 || axis.count > 0x7fffffff) return std::nullopt;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return axis;
}

}  // namespace

std::optional<RadianceHeader> read_radiance_header(const std::vector<uint8_t>& file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (!text.starts_with("#?")) return std::nullopt;
  size_t at = 0;
  const auto line = [&]() -> std::optional<std::string_view> {
    const size_t end = text.find('\n', at);
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view found = text.substr(at, end - at);
    at = end + 1;
    if (!found.empty() && found.back() == '\r') found.remove_suffix(1);
    return found;
  };
  RadianceHeader header;
  std::array<double, 3> factor{1, 1, 1};
  for (;;) {
    const auto found = line();
    if (!found) return std::nullopt;
    if (found->empty()) break;
    const auto value = [&](std::string_view key) {
      return found->starts_with(key) ? std::optional(found->substr(key.size())) : std::nullopt;
    };
    // Lines after a tab describe source pictures of this one.
    if (const auto exposure = value("EXPOSURE=")) {
      if (const auto v = numbers<1>(*exposure))
        for (double& f : factor) f *= (*v)[0];
    } else if (const auto correction = value("COLORCORR=")) {
      if (const auto v = numbers<3>(*correction))
        for (size_t k = 0; k < 3; ++k) factor[k] *= (*v)[k];
    } else if (const auto primaries = value("PRIMARIES=")) {
      if (const auto v = numbers<8>(*primaries)) {
        constexpr double k_own[8] = {0.64, 0.33, 0.29, 0.6, 0.15, 0.06, 1.0 / 3, 1.0 / 3};
        Chromaticities given;
        bool own = true;
        for (size_t k = 0; k < 8; ++k) {
          given[k] = static_cast<float>((*v)[k]);
          own = own && std::abs((*v)[k] - k_own[k]) < 0.001;
        }
        header.primaries = own ? std::nullopt : std::optional(given);
      }
    } else if (const auto format = value("FORMAT=")) {
      header.xyz = format->find("xyze") != std::string_view::npos;
    }
  }
  auto resolution = line();
  if (!resolution) return std::nullopt;
  const auto slow = take_axis(*resolution), fast = take_axis(*resolution);
  if (!slow || !fast || slow->name == fast->name) return std::nullopt;
  header.end = at;
  header.lines = slow->count, header.length = fast->count;
  header.columns = slow->name == 'X';
  const Axis &x = header.columns ? *slow : *fast, &y = header.columns ? *fast : *slow;
  header.rows_up = y.sign == '+';
  header.columns_left = x.sign == '-';
  for (size_t k = 0; k < 3; ++k) {
    header.scale[k] = static_cast<float>(1 / factor[k]);
    if (!std::isnormal(header.scale[k])) return std::nullopt;
  }
  return header;
}

std::vector<uint8_t> without_radiance_header(const std::vector<uint8_t>& file, const RadianceHeader& header) {
  const std::string plain =
      fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", header.lines, header.length);
  std::vector<uint8_t> result(plain.begin(), plain.end());
  result.insert(result.end(), file.begin() + static_cast<std::ptrdiff_t>(header.end), file.end());
  return result;
}

std::vector<float> upright_radiance(const std::vector<float>& pixels, size_t channels,
                                    const RadianceHeader& header) {
  // CIE XYZ to the primaries that Radiance's RGB has unless a picture names others, of the same white.
  constexpr double k_rgb_from_xyz[3][3] = {
      {2.565313, -1.166850, -0.398463}, {-1.022108, 1.978287, 0.043822}, {0.074724, -0.251940, 1.177215}};
  glm::dmat3 to_rgb(1);
  if (header.xyz)
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) to_rgb[c][r] = k_rgb_from_xyz[r][c];
  else if (header.primaries)
    to_rgb = rec709_from(*header.primaries).value_or(to_rgb);
  const bool mixed = to_rgb != glm::dmat3(1);
  const size_t width = header.width(), height = header.height();
  std::vector<float> result(pixels.size());
  for (size_t i = 0; i < header.lines; ++i)
    for (size_t j = 0; j < header.length; ++j) {
      const size_t column = header.columns ? i : j, row = header.columns ? j : i;
      const size_t x = header.columns_left ? width - 1 - column : column;
      const size_t y = header.rows_up ? height - 1 - row : row;
      const float* from = pixels.data() + (i * header.length + j) * channels;
      float* to = result.data() + (y * width + x) * channels;
      std::copy(from, from + channels, to);
      if (channels < 3) continue;
      glm::dvec3 color(from[0], from[1], from[2]);
      if (mixed) color = to_rgb * color;
      for (int k = 0; k < 3; ++k)
        to[k] = static_cast<float>(color[k] * double{header.scale[static_cast<size_t>(k)]});
    }
  return result;
}

}  // namespace lucerna
