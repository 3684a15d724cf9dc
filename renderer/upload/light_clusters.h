#pragma once
// Disjoint parts of all lights among which direct light that learns chooses
// (shaders/shared/learned_lights.h): host code alone.
#include <vector>

#include "gpu/kernel.h"
#include "upload/flatten.h"

namespace lucerna::upload {

/// Where a cluster is, for views.
struct ClusterPlace {
  vec3 at{0};  ///< mean of its lights' places; of far ones the unit direction towards them
  bool is_far = false;
  bool is_sky = false;
  uint32_t light = 0;  ///< the first of its lights: an entry of LightDistribution::entries
  uint32_t count = 0;  ///< lights, or texels of the sky
};

struct LightClusters {
  uint32_t sky = 0;          ///< clusters of the sky, which are the first
  uint32_t sky_squares = 0;  ///< squares per side into which a constant sky is divided; 0: into texels
  std::vector<float> plain;  ///< by cluster: probability without learning; they sum to 1
  std::vector<vec4> clusters, members;  ///< light_clusters, cluster_members
  std::vector<uint32_t> primitives;     ///< primitive_clusters
  std::vector<uint8_t> tiles;           ///< sky_tiles
  std::vector<vec4> facets;             ///< light_facets
  std::vector<ClusterPlace> places;     ///< by cluster
  uint32_t count() const { return uint32_t(plain.size()); }
};

/// True if there is more than one cluster. Not if the sky is separate from its sun.
bool has_light_clusters(const FlatScene& flat);
/// For the distribution that `flat` has. A cut of about 256 clusters of the sky, 128 of emissive triangles,
/// 64 of lamps.
LightClusters make_light_clusters(const FlatScene& flat);
/// #defines of kernels that choose lights by them: of scenes with clusters, as has_light_clusters() says.
gpu::Defines learned_defines(const FlatScene& flat);

}  // namespace lucerna::upload
