#include "bvh/layout.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <istream>
#include <ostream>

#include "base/error.h"

namespace lucerna::bvh {

namespace {

float half_area(const Box& box) {
  const vec3 s = box.size();
  return s.x * s.y + s.y * s.z + s.z * s.x;
}

/// A box for a child that does not exist: a point, so that no ordering of low and high turns it inside out.
Box empty_child(const Box& bounds) {
  return bounds.empty() ? Box{vec3(0), vec3(0)} : Box{bounds.lo, bounds.lo};
}

float reach_of(const Box& bounds) {
  if (bounds.empty()) return 0;
  const vec3 m = glm::max(glm::abs(bounds.lo), glm::abs(bounds.hi));
  return std::max({m.x, m.y, m.z});
}

class Writer {
 public:
  Writer(const Tree& tree, const Triangles& triangles) : tree_(tree), triangles_(triangles) {}

  BvhData run() {
    data_.primitive_count = static_cast<uint32_t>(triangles_.count());
    for (size_t i = 0; i < triangles_.count(); ++i)
      (triangles_.opaque(i) ? data_.has_opaque : data_.has_non_opaque) = true;
    data_.triangles.reserve(3 * tree_.references.size());
    data_.nodes.reserve(2 * (tree_.nodes.size() + 2));
    data_.max_depth = std::max(1u, depth(tree_));
    if (!tree_.nodes.empty()) data_.bounds = tree_.nodes[0].box;
    if (tree_.nodes.empty() || tree_.nodes[0].leaf()) {
      const uint32_t root = append_node();
      if (!tree_.nodes.empty()) set_child(root, 0, tree_.nodes[0].box, leaf(tree_.nodes[0]));
      data_.sah_cost = 1;
    } else {
      area_ = std::max(half_area(data_.bounds), 1e-30f);
      inner(tree_.nodes[0]);
    }
    data_.nodes[3].z = reach_of(data_.bounds);
    data_.node_count = static_cast<uint32_t>(data_.nodes.size() / 4);
    data_.triangle_count = static_cast<uint32_t>(data_.triangles.size() / 3);
    return std::move(data_);
  }

 private:
  uint32_t append_node() {
    const auto index = static_cast<uint32_t>(data_.nodes.size() / 4);
    data_.nodes.resize(data_.nodes.size() + 4, vec4(0));
    for (int side = 0; side < 2; ++side) set_child(index, side, empty_child(data_.bounds), {true, 0});
    return index;
  }

  void set_child(uint32_t node, int side, const Box& box, Word link) {
    vec4* texel = &data_.nodes[4 * static_cast<size_t>(node)];
    for (int axis = 0; axis < 3; ++axis)
      texel[axis][2 * side] = box.lo[axis], texel[axis][2 * side + 1] = box.hi[axis];
    texel[3][side] = encode(link);
  }

  Word leaf(const Tree::Node& node) {
    prims_.clear();
    for (uint32_t i = 0; i < node.count; ++i) prims_.push_back(tree_.references[node.first + i].prim);
    std::sort(prims_.begin(), prims_.end());
    // Two parts of one split triangle may meet again in a leaf: one test answers for both.
    prims_.erase(std::unique(prims_.begin(), prims_.end()), prims_.end());
    const auto count = static_cast<uint32_t>(prims_.size());
    const auto first = static_cast<uint32_t>(data_.triangles.size() / 3);
    for (const uint32_t prim : prims_) {
      const vec3* p = &triangles_.vertices[3 * static_cast<size_t>(prim)];
      data_.triangles.emplace_back(p[0], encode({!triangles_.opaque(prim), prim}));
      data_.triangles.emplace_back(p[1], 0.0f);
      data_.triangles.emplace_back(p[2], 0.0f);
    }
    data_.sah_cost += static_cast<float>(count) * half_area(node.box) / area_;
    return {true, first << 3 | count};
  }

  // Depth is at most k_max_depth, so recursion is safe.
  uint32_t inner(const Tree::Node& node) {
    const uint32_t index = append_node();
    data_.sah_cost += half_area(node.box) / area_;
    for (int side = 0; side < 2; ++side) {
      const Tree::Node& child = tree_.nodes[node.child[side]];
      set_child(index, side, child.box, child.leaf() ? leaf(child) : Word{false, inner(child)});
    }
    return index;
  }

  const Tree& tree_;
  const Triangles& triangles_;
  BvhData data_;
  float area_ = 1;
  std::vector<uint32_t> prims_;  // of the leaf at hand
};

}  // namespace

BvhData flatten(const Tree& tree, const Triangles& triangles) {
  if (tree.references.size() > k_max_triangles)
    throw_error("bvh", "{} triangles, of which the device layout holds at most {}", tree.references.size(),
                k_max_triangles);
  assert(triangles.count() < k_word_limit);
  const Tree limited = limit_depth(tree, k_max_depth);
  BvhData data = Writer(limited, triangles).run();
  assert(data.max_depth <= k_max_depth);
  if (data.max_depth > k_max_depth)
    throw_error("bvh", "depth {} exceeds the traversal stack of {}", data.max_depth, k_max_depth);
  return data;
}

namespace {

constexpr std::array<char, 8> k_magic = {'L', 'U', 'C', 'B', 'V', 'H', '0', '1'};

struct Header {
  std::array<char, 8> magic = k_magic;
  uint32_t node_count = 0, triangle_count = 0, primitive_count = 0, max_depth = 0;
  uint32_t has_opaque = 0, has_non_opaque = 0;
  float sah_cost = 0;
  float bounds[6] = {};
};

}  // namespace

void write(std::ostream& out, const BvhData& data) {
  Header h;
  h.node_count = data.node_count, h.triangle_count = data.triangle_count,
  h.primitive_count = data.primitive_count;
  h.max_depth = data.max_depth, h.has_opaque = data.has_opaque, h.has_non_opaque = data.has_non_opaque;
  h.sah_cost = data.sah_cost;
  for (int i = 0; i < 3; ++i) h.bounds[i] = data.bounds.lo[i], h.bounds[3 + i] = data.bounds.hi[i];
  out.write(reinterpret_cast<const char*>(&h), sizeof(h));
  out.write(reinterpret_cast<const char*>(data.nodes.data()),
            static_cast<std::streamsize>(data.nodes.size() * sizeof(vec4)));
  out.write(reinterpret_cast<const char*>(data.triangles.data()),
            static_cast<std::streamsize>(data.triangles.size() * sizeof(vec4)));
}

BvhData read(std::istream& in, const std::string& where) {
  Header h;
  in.read(reinterpret_cast<char*>(&h), sizeof(h));
  if (!in || h.magic != k_magic) throw_error(where, "not a tree of this version");
  if (h.node_count == 0 || h.node_count > k_max_triangles || h.triangle_count > k_max_triangles ||
      h.primitive_count > k_word_limit || h.max_depth > k_max_depth)
    throw_error(where, "tree with impossible counts");
  BvhData data;
  data.node_count = h.node_count, data.triangle_count = h.triangle_count,
  data.primitive_count = h.primitive_count;
  data.max_depth = h.max_depth, data.has_opaque = h.has_opaque != 0,
  data.has_non_opaque = h.has_non_opaque != 0;
  data.sah_cost = h.sah_cost;
  for (int i = 0; i < 3; ++i) data.bounds.lo[i] = h.bounds[i], data.bounds.hi[i] = h.bounds[3 + i];
  const auto fill = [&](std::vector<vec4>& texels, size_t count) {
    // Grown by blocks, so that a wrong count in a short file does not ask for gigabytes first.
    for (size_t done = 0; done < count;) {
      const size_t block = std::min<size_t>(count - done, 1 << 20);
      texels.resize(done + block);
      in.read(reinterpret_cast<char*>(&texels[done]), static_cast<std::streamsize>(block * sizeof(vec4)));
      if (!in) throw_error(where, "tree is cut short");
      done += block;
    }
  };
  fill(data.nodes, 4 * static_cast<size_t>(h.node_count));
  fill(data.triangles, 3 * static_cast<size_t>(h.triangle_count));
  return data;
}

}  // namespace lucerna::bvh
