#pragma once
// Hashes of the parts of a scene that determine its light. Equal for equal content, however it was loaded or
// edited. For files that store light of a scene (caches). Not included: names, cameras, settings, unused
// textures and images, and the strength of lamps that are off.
#include "scene/scene.h"

namespace lucerna::scene {

struct LightHash {
  uint64_t geometry = 0;     ///< placed surfaces, and the material of each
  uint64_t materials = 0;    ///< with textures and emission
  uint64_t lights = 0;       ///< lamps
  uint64_t environment = 0;  ///< with its image
  bool operator==(const LightHash&) const = default;
};

/// Reads the whole scene once.
LightHash light_hash(const Scene& scene);

}  // namespace lucerna::scene
