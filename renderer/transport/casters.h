#pragma once
// Casters of a scene, surfaces that focus light by smooth reflection or refraction: clusters with boxes, at
// which light paths are aimed (light_source.h).
#include <span>
#include <vector>

#include "base/math.h"
#include "upload/flatten.h"

namespace lucerna::transport {

/// Clusters of items in space: at most `most`, fewer if splitting would not reduce the surface of their
/// boxes. Returns the cluster of each item, 0 ... n - 1. Splits first the cluster with the largest reduction
/// of surface (binned surface area heuristic; I. Wald 2007).
std::vector<uint32_t> cluster(std::span<const Box> things, uint32_t most);

/// Bounding boxes of such clusters.
std::vector<Box> cluster_boxes(std::span<const Box> things, uint32_t most);

/// By material: true if its smooth lobes can focus light: metal or glass with a roughness of at most 0.5.
/// Varnish, which reflects 4 %, is found without aiming.
std::vector<bool> casting_materials(const upload::FlatMaterials& flat);

/// At most shared::k_most_casters boxes around all casters, slightly enlarged so that none is flat. Empty
/// without casters.
std::vector<Box> find_casters(const upload::FlatScene& flat);

}  // namespace lucerna::transport
