#pragma once
// What bundles light in a scene: surfaces that mirror or refract smoothly, in clusters, each with its box.
// Light paths are aimed at these (light_source.h).
#include <span>
#include <vector>

#include "base/math.h"
#include "upload/flatten.h"

namespace lucerna::transport {

/// Clusters of things in space: at most `most`, fewer where parting them would not make their boxes smaller
/// together. Returns the cluster of each, 0 ... n - 1. Splits the cluster first of which that takes most
/// surface of boxes away (binned as in a tree of least surface; I. Wald 2007).
std::vector<uint32_t> cluster(std::span<const Box> things, uint32_t most);

/// A box around the things of each such cluster.
std::vector<Box> cluster_boxes(std::span<const Box> things, uint32_t most);

/// By material: true if its smooth lobes can focus light: metal or glass with a roughness of at most 0.5.
/// Varnish, which reflects 4 %, is found without aiming.
std::vector<bool> casting_materials(const upload::FlatMaterials& flat);

/// At most shared::k_most_casters boxes around all casters, a little wider than these so that no box is flat.
/// None: nothing casts.
std::vector<Box> find_casters(const upload::FlatScene& flat);

}  // namespace lucerna::transport
