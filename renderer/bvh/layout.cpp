#include "bvh/layout.h"

#include <algorithm>
#include <array>
#include <bit>
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

/// Stack entries that a subtree of `height` levels of inner nodes needs when every node takes in two levels.
uint32_t least_stack(uint32_t height) { return height / 2 * 3 + height % 2; }

class Writer {
 public:
  Writer(const Tree& tree, const Triangles& triangles) : tree_(tree), triangles_(triangles) {}

  BvhData run() {
    data_.primitive_count = static_cast<uint32_t>(triangles_.count());
    for (size_t i = 0; i < triangles_.count(); ++i)
      (triangles_.opaque(i) ? data_.has_opaque : data_.has_non_opaque) = true;
    data_.triangles.reserve(3 * tree_.references.size());
    if (tree_.nodes.empty() || tree_.nodes[0].leaf()) {
      // A single leaf, or none, becomes the root's only child.
      data_.nodes.resize(k_node_texels);
      data_.max_depth = 1;
      std::vector<uint32_t> children(tree_.nodes.size(), 0u);
      if (!children.empty()) data_.bounds = tree_.nodes[0].box;
      area_ = std::max(half_area(data_.bounds), 1e-30f);
      data_.sah_cost = 1;
      fill(0, children, 1, k_stack);
    } else {
      heights_ = heights(tree_);
      data_.bounds = tree_.nodes[0].box;
      area_ = std::max(half_area(data_.bounds), 1e-30f);
      inner(0, 1, k_stack);
    }
    data_.node_count = static_cast<uint32_t>(data_.nodes.size() / k_node_texels);
    data_.triangle_count = static_cast<uint32_t>(data_.triangles.size() / 3);
    return std::move(data_);
  }

 private:
  /// Up to four nodes that take the place of `node`'s two children. Those of largest area are replaced by
  /// their own children, which saves most visits, unless a path would then need more than `stack` entries:
  /// then the grandchildren are taken, with which least_stack() holds for every subtree.
  std::vector<uint32_t> children_of(const Tree::Node& node, uint32_t stack) const {
    std::vector<uint32_t> children(node.child, node.child + 2);
    while (children.size() < k_width) {
      auto widest = children.end();
      for (auto c = children.begin(); c != children.end(); ++c)
        if (!tree_.nodes[*c].leaf() && (widest == children.end() ||
                                        half_area(tree_.nodes[*c].box) > half_area(tree_.nodes[*widest].box)))
          widest = c;
      if (widest == children.end()) break;
      replace(children, static_cast<size_t>(widest - children.begin()));
    }
    const auto held = static_cast<uint32_t>(children.size()) - 1;
    const bool fits = std::all_of(children.begin(), children.end(),
                                  [&](uint32_t c) { return held + least_stack(heights_[c]) <= stack; });
    if (fits) return children;
    children.assign(node.child, node.child + 2);
    for (size_t i = children.size(); i-- > 0;)
      if (!tree_.nodes[children[i]].leaf()) replace(children, i);
    return children;
  }

  /// Puts both children of the node in place `i` there.
  void replace(std::vector<uint32_t>& nodes, size_t i) const {
    const Tree::Node& node = tree_.nodes[nodes[i]];
    nodes[i] = node.child[0];
    nodes.insert(nodes.begin() + static_cast<std::ptrdiff_t>(i) + 1, node.child[1]);
  }

  Link leaf(const Tree::Node& node) {
    prims_.clear();
    for (uint32_t i = 0; i < node.count; ++i) prims_.push_back(tree_.references[node.first + i].prim);
    std::sort(prims_.begin(), prims_.end());
    // Two parts of one split triangle may meet again in a leaf: one test answers for both.
    prims_.erase(std::unique(prims_.begin(), prims_.end()), prims_.end());
    const auto count = static_cast<uint32_t>(prims_.size());
    const auto first = static_cast<uint32_t>(data_.triangles.size() / 3);
    for (const uint32_t prim : prims_) {
      const vec3* p = &triangles_.vertices[3 * static_cast<size_t>(prim)];
      data_.triangles.emplace_back(p[0], encode(Word{!triangles_.opaque(prim), prim}));
      data_.triangles.emplace_back(p[1], 0.0f);
      data_.triangles.emplace_back(p[2], 0.0f);
    }
    data_.sah_cost += static_cast<float>(count) * half_area(node.box) / area_;
    return {true, first << 3 | count};
  }

  // Depth is at most k_max_depth, so recursion is safe.
  uint32_t inner(uint32_t from, uint32_t level, uint32_t stack) {
    const Tree::Node& node = tree_.nodes[from];
    const auto index = static_cast<uint32_t>(data_.nodes.size() / k_node_texels);
    data_.nodes.resize(data_.nodes.size() + k_node_texels);
    data_.max_depth = std::max(data_.max_depth, level);
    data_.sah_cost += half_area(node.box) / area_;
    fill(index, children_of(node, stack), level, stack);
    return index;
  }

  void fill(uint32_t index, const std::vector<uint32_t>& children, uint32_t level, uint32_t stack) {
    std::vector<Box> boxes;
    for (const uint32_t c : children) boxes.push_back(tree_.nodes[c].box);
    const Grid grid = children.empty() ? Grid{} : Grid::around(boxes);
    const uint32_t held = children.empty() ? 0 : static_cast<uint32_t>(children.size()) - 1;
    data_.stack = std::max(data_.stack, k_stack - stack + held);
    uint32_t low[3] = {}, high[3] = {}, exponents = 0;
    uvec4 links(encode(Link{true, 0}));
    for (uint32_t c = 0; c < k_width; ++c) {
      const bool there = c < children.size();
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] |= uint32_t{there ? grid.low[c][axis] : uint8_t{255}} << 8 * c;
        high[axis] |= uint32_t{there ? grid.high[c][axis] : uint8_t{0}} << 8 * c;
      }
      if (!there) continue;
      const Tree::Node& child = tree_.nodes[children[c]];
      links[static_cast<int>(c)] =
          encode(child.leaf() ? leaf(child) : Link{false, inner(children[c], level + 1, stack - held)});
    }
    for (int axis = 0; axis < 3; ++axis)
      exponents |= static_cast<uint32_t>(grid.exponent[axis] + 127) << 8 * axis;
    uvec4* texel = &data_.nodes[k_node_texels * static_cast<size_t>(index)];
    texel[0] = {std::bit_cast<uint32_t>(grid.origin.x), std::bit_cast<uint32_t>(grid.origin.y),
                std::bit_cast<uint32_t>(grid.origin.z), exponents};
    texel[1] = {low[0], high[0], low[1], high[1]};
    texel[2] = {low[2], high[2], 0, 0};
    texel[3] = links;
  }

  const Tree& tree_;
  const Triangles& triangles_;
  BvhData data_;
  float area_ = 1;
  std::vector<uint32_t> heights_;  // of the binary tree's nodes, 0 for leaves
  std::vector<uint32_t> prims_;    // primitives of the current leaf
};

}  // namespace

Grid Grid::around(std::span<const Box> boxes) {
  Box all;
  for (const Box& box : boxes) all.grow(box);
  Grid grid;
  grid.origin = all.lo;
  for (int axis = 0; axis < 3; ++axis) {
    // The least power of two of which 255 reach across. In double precision, where differences of floats of
    // one scene and all that follows are exact or rounded far below what the traversal allows for.
    const double lo = all.lo[axis], extent = double{all.hi[axis]} - lo;
    int e = -126;
    if (extent > 0) {
      std::frexp(extent / 255, &e);  // extent / 255 < 2^e
      if (std::ldexp(255.0, e - 1) >= extent) --e;
      e = std::clamp(e, -126, 127);
    }
    grid.exponent[axis] = e;
    for (size_t c = 0; c < boxes.size(); ++c) {
      const double low = std::floor(std::ldexp(boxes[c].lo[axis] - lo, -e));
      const double high = std::ceil(std::ldexp(boxes[c].hi[axis] - lo, -e));
      grid.low[c][axis] = static_cast<uint8_t>(std::clamp(low, 0.0, 255.0));
      grid.high[c][axis] = static_cast<uint8_t>(std::clamp(high, 0.0, 255.0));
    }
  }
  return grid;
}

Box Grid::box(uint32_t child) const {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = origin[axis] + std::ldexp(double(low[child][axis]), exponent[axis]);
    const double hi = origin[axis] + std::ldexp(double(high[child][axis]), exponent[axis]);
    const auto l = static_cast<float>(lo), h = static_cast<float>(hi);
    box.lo[axis] = l > lo ? std::nextafter(l, -k_infinity) : l;
    box.hi[axis] = h < hi ? std::nextafter(h, k_infinity) : h;
  }
  return box;
}

BvhData flatten(const Tree& tree, const Triangles& triangles) {
  if (tree.references.size() > k_max_triangles)
    throw_error("bvh", "{} triangles, of which the device layout holds at most {}", tree.references.size(),
                k_max_triangles);
  assert(triangles.count() < k_word_limit);
  const Tree limited = limit_depth(tree, k_max_depth);
  BvhData data = Writer(limited, triangles).run();
  assert(data.stack <= k_stack);
  if (data.stack > k_stack)
    throw_error("bvh", "a traversal may hold {} entries, more than its stack of {}", data.stack, k_stack);
  return data;
}

namespace {

constexpr std::array<char, 8> k_magic = {'L', 'U', 'C', 'B', 'V', 'H', '0', '3'};

struct Header {
  std::array<char, 8> magic = k_magic;
  uint32_t node_count = 0, triangle_count = 0, primitive_count = 0, max_depth = 0, stack = 0;
  uint32_t has_opaque = 0, has_non_opaque = 0;
  float sah_cost = 0;
  float bounds[6] = {};
};

}  // namespace

void write(std::ostream& out, const BvhData& data) {
  Header h;
  h.node_count = data.node_count, h.triangle_count = data.triangle_count,
  h.primitive_count = data.primitive_count;
  h.max_depth = data.max_depth, h.stack = data.stack, h.has_opaque = data.has_opaque,
  h.has_non_opaque = data.has_non_opaque;
  h.sah_cost = data.sah_cost;
  for (int i = 0; i < 3; ++i) h.bounds[i] = data.bounds.lo[i], h.bounds[3 + i] = data.bounds.hi[i];
  out.write(reinterpret_cast<const char*>(&h), sizeof(h));
  out.write(reinterpret_cast<const char*>(data.nodes.data()),
            static_cast<std::streamsize>(data.nodes.size() * sizeof(uvec4)));
  out.write(reinterpret_cast<const char*>(data.triangles.data()),
            static_cast<std::streamsize>(data.triangles.size() * sizeof(vec4)));
}

BvhData read(std::istream& in, const std::string& where) {
  Header h;
  in.read(reinterpret_cast<char*>(&h), sizeof(h));
  if (!in || h.magic != k_magic) throw_error(where, "not a tree of this version");
  if (h.node_count == 0 || h.node_count > k_max_triangles || h.triangle_count > k_max_triangles ||
      h.primitive_count > k_word_limit || h.max_depth > k_max_depth || h.stack > k_stack)
    throw_error(where, "tree with impossible counts");
  BvhData data;
  data.node_count = h.node_count, data.triangle_count = h.triangle_count,
  data.primitive_count = h.primitive_count;
  data.max_depth = h.max_depth, data.stack = h.stack, data.has_opaque = h.has_opaque != 0,
  data.has_non_opaque = h.has_non_opaque != 0;
  data.sah_cost = h.sah_cost;
  for (int i = 0; i < 3; ++i) data.bounds.lo[i] = h.bounds[i], data.bounds.hi[i] = h.bounds[3 + i];
  const auto fill = [&](auto& texels, size_t count) {
    // Grown by blocks, so that a wrong count in a short file does not allocate gigabytes first.
    for (size_t done = 0; done < count;) {
      const size_t block = std::min<size_t>(count - done, 1 << 20);
      texels.resize(done + block);
      in.read(reinterpret_cast<char*>(&texels[done]),
              static_cast<std::streamsize>(block * sizeof(texels[0])));
      if (!in) throw_error(where, "tree is cut short");
      done += block;
    }
  };
  fill(data.nodes, k_node_texels * static_cast<size_t>(h.node_count));
  fill(data.triangles, 3 * static_cast<size_t>(h.triangle_count));
  return data;
}

}  // namespace lucerna::bvh
