#pragma once
// Loads an image for a texture on its own.
#include <filesystem>

#include "scene/scene.h"

namespace lucerna::scene {

/// Reads a PNG or JPEG file, the formats of glTF. `colour`: 16-bit texels are rounded to 8 bits, sRGB;
/// otherwise they become floats. Throws Error located at the file: missing, unreadable, of another format,
/// truncated, larger than `most_bytes`.
Image load_texture(const std::filesystem::path& file, bool colour, uint64_t most_bytes);

}  // namespace lucerna::scene
