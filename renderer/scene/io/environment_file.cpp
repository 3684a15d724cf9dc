#include "scene/io/environment_file.h"

#include <cmath>

#include "scene/io/document.h"
#include "scene/io/images.h"

namespace lucerna::scene {

Image load_environment(const std::filesystem::path& file, uint64_t most_bytes) {
  const std::string where = file.string();
  std::error_code error;
  if (std::filesystem::file_size(file, error) == uintmax_t(-1))
    throw_error(where, "cannot be read: {}", error.message());
  Budget budget(most_bytes);
  Image image = decode_image(read_file(file, where, budget), file.filename().string(), where,
                             Precision::linear_floats, budget);
  image.name = where;
  const double ratio = double(image.width) / image.height;
  if (std::abs(ratio / 2 - 1) > 0.02)
    throw_error(where, "{} x {} pixels: a latitude-longitude image is twice as wide as high", image.width,
                image.height);
  mend_texels(image);
  return image;
}

}  // namespace lucerna::scene
