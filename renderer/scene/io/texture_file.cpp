#include "scene/io/texture_file.h"

#include "scene/io/document.h"
#include "scene/io/images.h"

namespace lucerna::scene {

Image load_texture(const std::filesystem::path& file, bool colour, uint64_t most_bytes) {
  const std::string where = file.string();
  std::error_code error;
  if (std::filesystem::file_size(file, error) == uintmax_t(-1))
    throw_error(where, "cannot be read: {}", error.message());
  Budget budget(most_bytes);
  const std::vector<uint8_t> bytes = read_file(file, where, budget);
  if (mime_type({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).empty())
    throw_error(where, "is neither PNG nor JPEG, the formats that glTF has for textures");
  Image image = decode_image(bytes, file.filename().string(), where,
                             colour ? Precision::eight_bit : Precision::keep, budget);
  image.name = where;
  mend_texels(image);
  return image;
}

}  // namespace lucerna::scene
