#pragma once
// Clusters of lights for learned light selection (shaders/shared/learned_lights.h): disjoint parts of all
// lights, and the sky through each portal. Host code.
#include <vector>

#include "gpu/kernel.h"
#include "upload/flatten.h"

namespace lucerna::upload {

/// Position of a cluster, for views.
struct ClusterPlace {
  vec3 at{0};  ///< mean position of its lights; of distant ones the unit direction towards them
  bool is_far = false;
  bool is_sky = false;
  uint32_t portal = scene::k_none;  ///< the sky through FlatScene::portals.of[portal]; `at`: its centre
  uint32_t light = 0;               ///< its first light: an entry of LightDistribution::entries
  uint32_t count = 0;               ///< number of lights, or of texels of the sky
};

struct LightClusters {
  uint32_t sky = 0;          ///< number of clusters of the sky, which are the first
  uint32_t portals = 0;      ///< number of portals, which are the last of these
  uint32_t sky_squares = 0;  ///< squares per side into which a constant sky is divided; 0: into texels
  std::vector<float> plain;  ///< by cluster: probability without learning; they sum to 1
  std::vector<vec4> clusters, members;  ///< light_clusters, cluster_members
  std::vector<uint32_t> primitives;     ///< primitive_clusters
  std::vector<vec4> shapes;             ///< shape_clusters
  std::vector<uint8_t> tiles;           ///< sky_tiles
  std::vector<vec4> facets;             ///< light_facets
  std::vector<ClusterPlace> places;     ///< by cluster
  uint32_t count() const { return uint32_t(plain.size()); }
};

/// True if there is more than one cluster. Not if the sky is separate from its sun.
bool has_light_clusters(const FlatScene& flat);
/// Clusters for the distribution of `flat`: of the sky, of emissive triangles and of lamps, each up to about
/// a number that light_clusters.cpp sets.
LightClusters make_light_clusters(const FlatScene& flat);
/// #defines of kernels with learned light selection, for scenes with has_light_clusters().
gpu::Defines learned_defines(const FlatScene& flat);

}  // namespace lucerna::upload
