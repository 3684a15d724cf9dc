#pragma once
// Index of the surfaces that photons can lie on, for the surface area around a place
// (shaders/photons/area.glsl).
//
// A binary tree in depth-first order. Each node stores where traversal continues if a ball misses it, so
// lookups need no stack: node i is followed by i + 1 if hit, else by its `next`.
#include <vector>

#include "gpu/kernel.h"
#include "upload/flatten.h"

namespace lucerna::photons {

/// By material: true if photons may be stored on it. From its factors alone: a texture may make any material
/// diffuse.
std::vector<bool> diffuse_materials(const upload::FlatMaterials& flat);

/// Texels of the index. Two per node: (low corner, bits `next`) (high corner, bits 0 for an inner node, else
/// first triangle << 3 | triangles). Three per triangle: its vertices, counter-clockwise seen from its front.
struct SurfaceTree {
  std::vector<vec4> nodes, triangles;
  uint32_t node_count() const { return uint32_t(nodes.size() / 2); }
};
/// Triangles without area are left out. `diffuse`: by material.
SurfaceTree make_surface_tree(const upload::FlatScene& flat, const std::vector<bool>& diffuse);

class SurfaceIndex {
 public:
  /// Makes an empty index. Throws Error: memory.
  explicit SurfaceIndex(gpu::Device& device);
  /// True if it fits this scene's materials.
  bool serves(const upload::FlatScene& flat) const;
  /// Call when surfaces have moved.
  void invalidate() { made_ = false; }
  /// Builds it for that scene; bound resources are then stale. Stays empty if it exceeds the device's array
  /// size. Throws Error: memory.
  void make(gpu::Device& device, const upload::FlatScene& flat);
  /// Binds photon_surface_nodes and photon_surface_triangles.
  void bind(gpu::Resources& resources) const;
  /// Number of nodes; 0: empty.
  uint32_t nodes() const { return nodes_; }
  uint64_t bytes() const { return node_texels_.bytes() + triangle_texels_.bytes(); }

 private:
  void upload(gpu::Device& device, const SurfaceTree& tree);
  std::vector<bool> diffuse_;
  gpu::Buffer node_texels_, triangle_texels_;
  uint32_t nodes_ = 0;
  bool made_ = false;
};

}  // namespace lucerna::photons
