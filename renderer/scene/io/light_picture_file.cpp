#include "scene/io/light_picture_file.h"

#include <utility>

#include "base/error.h"
#include "scene/io/images.h"

namespace lucerna::scene {
namespace {

constexpr uint64_t k_most_file = 64 << 20, k_most_memory = uint64_t{4} << 30;

}  // namespace

std::shared_ptr<const LightPicture> light_picture_of(std::vector<uint8_t> bytes, const std::string& name,
                                                     const std::string& where, Budget& budget,
                                                     size_t& mended) {
  if (bytes.size() > k_most_file)
    throw_error(where, "{} bytes are more than the limit of {}", bytes.size(), k_most_file);
  Image image = decode_image(bytes, name, where, Precision::linear_floats, budget);
  mended = mend_texels(image);
  std::vector<vec3> texels(size_t{image.width} * image.height);
  for (size_t i = 0; i < texels.size(); ++i)
    texels[i] = vec3(image.floats[4 * i], image.floats[4 * i + 1], image.floats[4 * i + 2]);
  LightPicture picture = make_picture(image.width, image.height, std::move(texels), where);
  picture.name = name, picture.file = std::move(bytes);
  return std::make_shared<const LightPicture>(std::move(picture));
}

std::shared_ptr<const LightPicture> load_light_picture(const std::filesystem::path& file, size_t& mended) {
  const std::string where = file.string();
  std::error_code error;
  if (std::filesystem::file_size(file, error) == uintmax_t(-1))
    throw_error(where, "cannot be read: {}", error.message());
  Budget budget(k_most_memory);
  return light_picture_of(read_file(file, where, budget), file.filename().string(), where, budget, mended);
}

}  // namespace lucerna::scene
