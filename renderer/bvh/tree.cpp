#include "bvh/tree.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace lucerna::bvh {

namespace {

bool finite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Box box_of(const std::vector<Reference>& references, uint32_t first, uint32_t count) {
  Box box;
  for (uint32_t i = first; i < first + count; ++i) box.grow(references[i].box);
  return box;
}

/// Appends a median-split subtree over references [first, first + count), which it reorders. Returns its
/// index.
uint32_t append_median(Tree& tree, uint32_t first, uint32_t count) {
  const auto index = static_cast<uint32_t>(tree.nodes.size());
  tree.nodes.push_back({box_of(tree.references, first, count), {Tree::k_leaf, Tree::k_leaf}, first, count});
  if (count <= k_max_leaf) return index;
  Box centres;
  for (uint32_t i = first; i < first + count; ++i) centres.grow(tree.references[i].box.centre());
  const vec3 size = centres.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  // Whole leaves go left, so that halving never needs a level more than least_depth().
  const uint32_t leaves = (count + k_max_leaf - 1) / k_max_leaf;
  const uint32_t left = std::min(count - 1, (leaves + 1) / 2 * k_max_leaf);
  const auto begin = tree.references.begin() + first;
  std::nth_element(begin, begin + left, begin + count, [axis](const Reference& a, const Reference& b) {
    const float ca = a.box.centre()[axis], cb = b.box.centre()[axis];
    return ca != cb ? ca < cb : a.prim < b.prim;
  });
  const uint32_t child0 = append_median(tree, first, left);
  const uint32_t child1 = append_median(tree, first + left, count - left);
  tree.nodes[index].child[0] = child0, tree.nodes[index].child[1] = child1;
  return index;
}

}  // namespace

float margin_of(const vec3* vertices) {
  Box box;
  for (int k = 0; k < 3; ++k) box.grow(vertices[k]);
  double size = 0;
  for (int axis = 0; axis < 3; ++axis) size = std::max(size, double{box.hi[axis]} - double{box.lo[axis]});
  return static_cast<float>(0x1p-20 * size);
}

Box grown(const Box& box, float margin) {
  Box out;
  constexpr double k_most = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    // Rounding errors of doubles are far below the last place of a float.
    const double lo = std::max(double{box.lo[axis]} - double{margin}, -k_most),
                 hi = std::min(double{box.hi[axis]} + double{margin}, k_most);
    const auto l = static_cast<float>(lo), h = static_cast<float>(hi);
    out.lo[axis] = l > lo ? std::nextafter(l, -k_infinity) : l;
    out.hi[axis] = h < hi ? std::nextafter(h, k_infinity) : h;
  }
  return out;
}

std::vector<Reference> references_of(const Triangles& triangles) {
  std::vector<Reference> references;
  references.reserve(triangles.count());
  for (size_t i = 0; i < triangles.count(); ++i) {
    const vec3 &a = triangles.vertices[3 * i], &b = triangles.vertices[3 * i + 1],
               &c = triangles.vertices[3 * i + 2];
    if (!finite(a) || !finite(b) || !finite(c))
      throw_error("bvh", "triangle {} has a vertex that is not finite", i);
    // In double precision, in which the products of differences of floats are all but always exact.
    if (glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)) == glm::dvec3(0)) continue;
    Reference reference{{}, static_cast<uint32_t>(i)};
    reference.box.grow(a), reference.box.grow(b), reference.box.grow(c);
    reference.box = grown(reference.box, margin_of(&a));
    references.push_back(reference);
  }
  return references;
}

uint32_t least_depth(uint32_t count) {
  const uint32_t leaves = count / k_max_leaf + (count % k_max_leaf != 0);
  return leaves <= 1 ? 0 : static_cast<uint32_t>(std::bit_width(leaves - 1));
}

Tree build_median(std::vector<Reference> references) {
  Tree tree;
  tree.references = std::move(references);
  if (!tree.references.empty()) append_median(tree, 0, static_cast<uint32_t>(tree.references.size()));
  return tree;
}

std::vector<uint32_t> heights(const Tree& tree) {
  std::vector<uint32_t> height(tree.nodes.size(), 0);
  for (size_t i = tree.nodes.size(); i-- > 0;) {  // children come after their parent
    const Tree::Node& node = tree.nodes[i];
    if (!node.leaf()) height[i] = 1 + std::max(height[node.child[0]], height[node.child[1]]);
  }
  return height;
}

uint32_t depth(const Tree& tree) { return tree.nodes.empty() ? 0 : heights(tree)[0]; }

Tree limit_depth(const Tree& tree, uint32_t max_depth) {
  Tree out;
  out.references = tree.references;
  if (tree.nodes.empty()) return out;
  assert(least_depth(tree.nodes[0].count) <= max_depth);
  struct Item {
    uint32_t from, parent, side, levels;
  };
  std::vector<Item> stack{{0, Tree::k_leaf, 0, max_depth}};
  while (!stack.empty()) {
    const Item item = stack.back();
    stack.pop_back();
    const Tree::Node& node = tree.nodes[item.from];
    auto index = static_cast<uint32_t>(out.nodes.size());
    const bool keep = node.leaf()
                          ? node.count <= k_max_leaf
                          : item.levels > 0 && least_depth(tree.nodes[node.child[0]].count) < item.levels &&
                                least_depth(tree.nodes[node.child[1]].count) < item.levels;
    if (keep) {
      out.nodes.push_back({node.box, {Tree::k_leaf, Tree::k_leaf}, node.first, node.count});
      if (!node.leaf()) {
        stack.push_back({node.child[1], index, 1, item.levels - 1});
        stack.push_back({node.child[0], index, 0, item.levels - 1});
      }
    } else {
      index = append_median(out, node.first, node.count);
    }
    if (item.parent != Tree::k_leaf) out.nodes[item.parent].child[item.side] = index;
  }
  return out;
}

}  // namespace lucerna::bvh
