#pragma once
// Pictures for the page: bytes as data URIs, errors in a colour ramp.
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lucerna::bench {

/// Magma: from black over purple and orange to pale yellow, uniform in lightness; x is clamped to 0..1.
std::array<uint8_t, 3> magma(double x);
/// Likewise, as a CSS gradient from left to right.
std::string magma_gradient();

struct ErrorPicture {
  uint32_t width = 0, height = 0;
  std::vector<float> values;  ///< |difference| over mean luminance
};
/// None if the file is missing or damaged.
std::optional<ErrorPicture> read_error_picture(const std::filesystem::path& file);

/// End of the scale for such a picture: its 99th percentile, rounded up to 1, 2 or 5 times a power of ten.
double scale_of(const ErrorPicture& picture);

/// <img> with the embedded picture; "" if the file is missing. `zoom`: whole screen pixels per picture pixel.
std::string image_tag(const std::filesystem::path& png, uint32_t width, uint32_t height,
                      const std::string& alt, const std::string& title);
/// Likewise, for an error picture, 0 to `scale` over the ramp; the PNG is written to `scratch`.
std::string image_tag(const ErrorPicture& picture, double scale, uint32_t width, uint32_t height,
                      const std::string& alt, const std::string& title, const std::filesystem::path& scratch);

}  // namespace lucerna::bench
