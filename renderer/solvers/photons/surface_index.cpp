#include "solvers/photons/surface_index.h"

#include <algorithm>
#include <bit>

#include "bvh/tree.h"

namespace lucerna::photons {

using namespace shared;

namespace {

bool textured(const std::vector<vec4>& materials, size_t material, uint32_t use) {
  const vec4& bits = materials[material + k_material_textures + k_texture_texels * use + 1];
  return (std::bit_cast<uint32_t>(bits.x) & k_texture_present) != 0;
}

void add_node(SurfaceTree& into, const Box& box) {
  into.nodes.emplace_back(box.lo, 0);
  into.nodes.emplace_back(box.hi, 0);
}

}  // namespace

std::vector<bool> diffuse_materials(const upload::FlatMaterials& flat) {
  std::vector<bool> diffuse(flat.materials.size() / k_material_texels);
  for (size_t i = 0; i < diffuse.size(); ++i) {
    const std::vector<vec4>& m = flat.materials;
    const size_t at = i * k_material_texels;
    const vec4 &base = m[at + k_material_base], &through = m[at + k_material_diffuse_t];
    const uint32_t flags = std::bit_cast<uint32_t>(m[at + k_material_emission].w);
    const bool metal = m[at + k_material_surface].x >= 1 && !textured(m, at, k_use_metallic_roughness);
    const bool glass = m[at + k_material_specular].w >= 1 && !textured(m, at, k_use_transmission);
    const bool black = std::max({base.x, base.y, base.z}) <= 0 &&
                       (through.w <= 0 || std::max({through.x, through.y, through.z}) <= 0);
    diffuse[i] = !metal && !glass && !black && (flags & k_flag_unlit) == 0;
  }
  return diffuse;
}

SurfaceTree make_surface_tree(const upload::FlatScene& flat, const std::vector<bool>& diffuse) {
  std::vector<bvh::Reference> references = bvh::references_of({flat.positions, {}});
  std::erase_if(references, [&](const bvh::Reference& r) {
    return !diffuse[flat.triangles[r.prim].w & k_triangle_material_mask];
  });
  SurfaceTree made;
  if (references.empty()) return made;
  const bvh::Tree tree = bvh::build_median(std::move(references));
  // On the way back up, nodes get the link to what follows their subtree.
  struct Step {
    uint32_t node, index;
    bool back;
  };
  std::vector<Step> steps{{0, 0, false}};
  while (!steps.empty()) {
    Step step = steps.back();
    steps.pop_back();
    if (step.back) {
      made.nodes[2 * size_t{step.index}].w = std::bit_cast<float>(made.node_count());
      continue;
    }
    const bvh::Tree::Node& node = tree.nodes[step.node];
    step.index = made.node_count(), step.back = true;
    add_node(made, node.box);
    steps.push_back(step);
    if (!node.leaf()) {
      steps.push_back({node.child[1], 0, false});
      steps.push_back({node.child[0], 0, false});
      continue;
    }
    made.nodes.back().w = std::bit_cast<float>(uint32_t(made.triangles.size() / 3) << 3 | node.count);
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const uint32_t prim = tree.references[i].prim;
      const bool flipped = (flat.triangles[prim].w & k_triangle_flipped) != 0;
      const vec3* p = &flat.positions[3 * size_t{prim}];
      for (const int k : {0, flipped ? 2 : 1, flipped ? 1 : 2}) made.triangles.emplace_back(p[k], 0);
    }
  }
  return made;
}

SurfaceIndex::SurfaceIndex(gpu::Device& device) { upload(device, {}); }

bool SurfaceIndex::serves(const upload::FlatScene& flat) const {
  return made_ && diffuse_materials(flat) == diffuse_;
}

void SurfaceIndex::make(gpu::Device& device, const upload::FlatScene& flat) {
  diffuse_ = diffuse_materials(flat);
  const gpu::Limits& limits = device.info().limits;
  const uint64_t most =
      std::min<uint64_t>(limits.max_texel_elements, limits.max_storage_buffer / sizeof(vec4));
  SurfaceTree tree;
  if (flat.positions.size() <= most) tree = make_surface_tree(flat, diffuse_);
  if (tree.nodes.size() > most) tree = {};
  upload(device, tree);
  made_ = true;
}

void SurfaceIndex::upload(gpu::Device& device, const SurfaceTree& tree) {
  const auto texels = [&](const char* name, const std::vector<vec4>& values) {
    const uint64_t bytes = sizeof(vec4) * std::max<uint64_t>(1, values.size());
    gpu::Buffer buffer(device, {.name = name, .bytes = bytes, .texel = true});
    if (!values.empty()) buffer.write(std::span<const vec4>(values));
    return buffer;
  };
  node_texels_ = texels("surfaces of photons", tree.nodes);
  triangle_texels_ = texels("triangles of photons", tree.triangles);
  nodes_ = tree.node_count();
}

void SurfaceIndex::bind(gpu::Resources& resources) const {
  resources.set("photon_surface_nodes", node_texels_);
  resources.set("photon_surface_triangles", triangle_texels_);
}

}  // namespace lucerna::photons
