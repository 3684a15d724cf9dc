#pragma once
// Files of pictures that spots project.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scene/io/document.h"
#include "scene/light_picture.h"

namespace lucerna::scene {

/// Reads a picture of any format of decode_image(); 8- and 16-bit files are sRGB. `mended`: the number of
/// texels that were negative or not finite and are now 0 or the largest value. Throws Error: missing,
/// unreadable, black, or larger than 64 MiB.
std::shared_ptr<const LightPicture> load_light_picture(const std::filesystem::path& file, size_t& mended);
/// Likewise from its bytes; `name`: of the file.
std::shared_ptr<const LightPicture> light_picture_of(std::vector<uint8_t> bytes, const std::string& name,
                                                     const std::string& where, Budget& budget,
                                                     size_t& mended);

}  // namespace lucerna::scene
