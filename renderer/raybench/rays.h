#pragma once
// The measured rays: those of a path tracer, in the order of its wavefront.
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bvh/bvh.h"
#include "raybench/scene_file.h"

namespace lucerna::raybench {

using TraceBatch = std::function<void(bvh::Query, std::span<const shared::Ray>, std::span<shared::Hit>)>;

struct RaySet {
  std::string name;
  bvh::Query query;
  bool coherent = false;  ///< neighbours start alike
  std::vector<shared::Ray> rays;
};

/// `primary`: from the camera, jittered, 8x8 tiles in Morton order; `diffuse`: from their hits,
/// cosine-distributed; `diffuse 2`: from those rays' hits; `shadow`: from the primary hits to lights chosen
/// like the renderer (to points in the scene's box without lights), ending just before them. About
/// `count` primary rays; the others as many as there are hits. `trace` answers closest queries. Same seed,
/// same rays.
std::vector<RaySet> make_rays(const FlatFile& scene, uint32_t count, uint32_t seed, const TraceBatch& trace);

}  // namespace lucerna::raybench
