#pragma once
// A picture that lights a scene, read by itself.
#include <filesystem>

#include "scene/scene.h"

namespace lucerna::scene {

/// Reads a latitude-longitude image (HDR, EXR or whatever the loader decodes) as linear floats, values that
/// are negative or not finite replaced. Throws Error located at the file: it is not there, cannot be read or
/// decoded, is cut short, takes more than `most_bytes`, or has a shape that check_environment_shape
/// (images.h) refuses, as the environment that a scene names.
Image load_environment(const std::filesystem::path& file, uint64_t most_bytes);

}  // namespace lucerna::scene
