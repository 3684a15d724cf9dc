#pragma once
// Loads an environment image on its own.
#include <filesystem>

#include "scene/scene.h"

namespace lucerna::scene {

/// Reads a latitude-longitude image (HDR, EXR or another supported format) as linear floats; negative and
/// non-finite values are replaced. Throws Error located at the file: missing, unreadable, undecodable or
/// truncated, larger than `most_bytes`, or of a shape that check_environment_shape() (images.h) refuses.
Image load_environment(const std::filesystem::path& file, uint64_t most_bytes);

}  // namespace lucerna::scene
