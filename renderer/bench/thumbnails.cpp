#include "bench/thumbnails.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/base64.h"
#include "base/file.h"
#include "base/markup.h"
#include "bench/folder.h"
#include "bench/html.h"
#include "film/io/image_file.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::array<uint8_t, 3>, 9> k_magma = {{{0, 0, 4},
                                                            {28, 16, 68},
                                                            {79, 18, 123},
                                                            {129, 37, 129},
                                                            {181, 54, 122},
                                                            {229, 89, 100},
                                                            {251, 136, 97},
                                                            {254, 194, 135},
                                                            {252, 253, 191}}};

std::string tag_of(const std::string& png, uint32_t width, uint32_t height, const std::string& alt,
                   const std::string& title) {
  return fmt::format(
      "<img width=\"{}\" height=\"{}\" alt=\"{}\" title=\"{}\" src=\"data:image/png;base64,{}\"/>", width,
      height, escape_markup(alt), escape_markup(title), base64(png));
}

}  // namespace

std::array<uint8_t, 3> magma(double x) {
  const double at = std::clamp(x, 0.0, 1.0) * (k_magma.size() - 1);
  const auto i = std::min(size_t(at), k_magma.size() - 2);
  std::array<uint8_t, 3> out{};
  for (size_t c = 0; c < 3; ++c)
    out[c] = uint8_t(std::lround(k_magma[i][c] + (at - double(i)) * (k_magma[i + 1][c] - k_magma[i][c])));
  return out;
}

std::string magma_gradient() {
  std::string text = "linear-gradient(to right";
  for (const auto& c : k_magma) text += fmt::format(", #{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
  return text + ")";
}

std::optional<ErrorPicture> read_error_picture(const fs::path& file) {
  if (!file_exists(file)) return std::nullopt;
  try {
    film::FilmImage image = film::read_exr(file);
    if (image.channels.size() != 1) return std::nullopt;
    return ErrorPicture{image.width, image.height, std::move(image.channels[0].second)};
  } catch (const Error&) {
    return std::nullopt;
  }
}

double scale_of(const ErrorPicture& picture) {
  std::vector<float> values = picture.values;
  if (values.empty()) return 1;
  const auto at = values.begin() + ptrdiff_t((values.size() - 1) * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  if (!(*at > 0)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(double(*at))));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= double(*at)) return step * power;
  return 10 * power;
}

std::string image_tag(const fs::path& png, uint32_t width, uint32_t height, const std::string& alt,
                      const std::string& title) {
  try {
    return file_exists(png) ? tag_of(read_file(png), width, height, alt, title) : "";
  } catch (const Error&) {
    return "";
  }
}

std::string image_tag(const ErrorPicture& picture, double scale, uint32_t width, uint32_t height,
                      const std::string& alt, const std::string& title, const fs::path& scratch) {
  std::vector<uint8_t> rgba(picture.values.size() * 4, 255);
  for (size_t i = 0; i < picture.values.size(); ++i) {
    const auto colour = magma(double(picture.values[i]) / scale);
    std::copy(colour.begin(), colour.end(), rgba.begin() + ptrdiff_t(4 * i));
  }
  film::write_png(scratch, picture.width, picture.height, rgba);
  return image_tag(scratch, width, height, alt, title);
}

}  // namespace lucerna::bench
