#pragma once
// What of a scene decides the light in it, as numbers: equal where two loadings, or a loading and an edit,
// come to the same. For files that hold light of a scene (caches). Not in it: names, cameras, settings,
// textures and images that no surface uses, and how bright a lamp that is off would be.
#include "scene/scene.h"

namespace lucerna::scene {

struct LightHash {
  uint64_t geometry = 0;     ///< surfaces where they stand, and which material each has
  uint64_t materials = 0;    ///< with their textures; emission too
  uint64_t lights = 0;       ///< lamps
  uint64_t environment = 0;  ///< with its image
  bool operator==(const LightHash&) const = default;
};

/// Reads all of the scene once: about 2.5 s a GiB.
LightHash light_hash(const Scene& scene);

}  // namespace lucerna::scene
