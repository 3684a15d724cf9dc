#include "film/io/small_image.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lucerna::film {

SmallImage read_small_image(const std::string& file, uint32_t most) {
  OIIO::ImageBuf image(file);
  if (!image.read(0, 0, true, OIIO::TypeDesc::FLOAT))
    throw_error(file, "cannot be read: {}", image.geterror());
  const OIIO::ImageSpec& spec = image.spec();
  const auto stored = image.nativespec().format;
  const bool encoded = stored == OIIO::TypeDesc::UINT8 || stored == OIIO::TypeDesc::UINT16;
  const double scale = std::min(1.0, double(most) / std::max({spec.width, spec.height, 1}));
  const int width = std::max(1, int(std::lround(spec.width * scale)));
  const int height = std::max(1, int(std::lround(spec.height * scale)));
  const int channels = spec.nchannels;
  const OIIO::ROI roi(0, width, 0, height, 0, 1, 0, channels);
  const OIIO::ImageBuf small = OIIO::ImageBufAlgo::resize(image, "box", 0, roi);
  std::vector<float> values(size_t(width) * size_t(height) * size_t(channels));
  if (small.has_error() || !small.get_pixels(roi, OIIO::TypeDesc::FLOAT, values.data()))
    throw_error(file, "cannot be made smaller: {}", small.geterror());
  SmallImage result{.width = uint32_t(width), .height = uint32_t(height), .encoded = encoded};
  result.colours.resize(size_t(width) * size_t(height));
  for (size_t i = 0; i < result.colours.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = values[i * size_t(channels) + size_t(channels >= 3 ? c : 0)];
      result.colours[i][c] = std::isfinite(value) ? std::max(value, 0.0f) : 0;
    }
  return result;
}

}  // namespace lucerna::film
