#pragma once
// glTF 2.0 (.gltf, .glb) with its images, the environment and settings.json -> Scene.
//
// Read: node hierarchy and instances, triangles, strips and fans, all index types, sparse and interleaved accessors, vertex
// colours, two UV sets, cameras, metallic-roughness materials, and the extensions listed by k_known_extensions. Images through
// OpenImageIO. Missing normals become flat ones, missing tangents are computed where a normal texture needs them.
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/error.h"
#include "scene/scene.h"

namespace lucerna::scene {

struct LoadOptions {
  bool images = true;  ///< false: textures are left as 1x1 white (for tools that look at geometry only)
};

/// fraction 0..1, what is being done; returning false cancels (an Error "cancelled" is thrown).
using LoadProgress = std::function<bool(float, const std::string&)>;

/// Throws Error located at the file and element: what cannot be read or is out of range. What can be mended (degenerate
/// triangles, missing textures, unknown optional extensions) is listed in Scene::warnings.
Scene load(const std::filesystem::path& file, const LoadOptions& options = {}, const LoadProgress& progress = {});

/// What is in a scene, for `lucerna info`.
nlohmann::ordered_json describe(const Scene& scene);
std::string describe_text(const Scene& scene);

}  // namespace lucerna::scene
