#pragma once
// The surfaces that photons can lie on, to be found by whoever wants to know how much of them there is around
// a place (shaders/photons/area.glsl).
//
// A binary tree in depth-first order whose nodes know where to go on when a ball misses them, so that a
// lookup needs no stack: node i is followed by i + 1 where it is met, else by its own `next`.
#include <vector>

#include "gpu/kernel.h"
#include "upload/flatten.h"

namespace lucerna::photons {

/// By material: whether photons may be stored on it. By its factors alone: what a texture may make diffuse
/// counts.
std::vector<bool> diffuse_materials(const upload::FlatMaterials& flat);

/// Texels of the index. Two a node: (low corner, bits `next`) (high corner, bits 0 of an inner node, else
/// first triangle << 3 | triangles). Three a triangle: its vertices, counter-clockwise from its front.
struct SurfaceTree {
  std::vector<vec4> nodes, triangles;
  uint32_t node_count() const { return uint32_t(nodes.size() / 2); }
};
/// Triangles of no area are left out. `diffuse`: by material.
SurfaceTree make_surface_tree(const upload::FlatScene& flat, const std::vector<bool>& diffuse);

class SurfaceIndex {
 public:
  /// An empty one. Throws Error: no memory.
  explicit SurfaceIndex(gpu::Device& device);
  /// Whether it is that of this scene, as far as materials say.
  bool serves(const upload::FlatScene& flat) const;
  /// Its surfaces have moved: it serves no more.
  void invalidate() { made_ = false; }
  /// Makes it for that scene; bound resources are then stale. Where there is more than the device can hold in
  /// an array it stays empty. Throws Error: no memory.
  void make(gpu::Device& device, const upload::FlatScene& flat);
  /// photon_surface_nodes, photon_surface_triangles.
  void bind(gpu::Resources& resources) const;
  /// 0: it is empty.
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
