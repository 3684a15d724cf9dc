#pragma once
// A flattened scene with its tree and camera as one file for the stand-alone ray bench, so that a machine
// with only a Vulkan driver can trace a scene without a glTF loader, image IO or a BVH builder.
#include <filesystem>
#include <string>

#include "bvh/layout.h"
#include "scene/scene.h"
#include "upload/flatten.h"

namespace lucerna::raybench {

struct FlatFile {
  std::string name;
  upload::FlatScene scene;
  bvh::BvhData tree;
  scene::Camera camera;
};

/// Written under a temporary name, then renamed. Throws Error if that fails.
void write(const std::filesystem::path& file, const FlatFile& flat);
/// Throws Error: missing, cut short, of another version or another machine's byte order. Files come from
/// write(); their content is trusted beyond that.
FlatFile read(const std::filesystem::path& file);

}  // namespace lucerna::raybench
