#include "scene/io/environment_file.h"

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
  check_environment_shape(image, where);
  mend_texels(image);
  return image;
}

}  // namespace lucerna::scene
