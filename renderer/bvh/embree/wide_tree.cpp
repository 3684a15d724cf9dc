#include "bvh/embree/wide_tree.h"

#include <algorithm>
#include <limits>

#include "base/huge_pages.h"

namespace lucerna::bvh {

namespace {

double half_area(const Box& box) {
  const glm::dvec3 s(box.size());  // no float holds the square of the largest
  return s.x * s.y + s.y * s.z + s.z * s.x;
}

/// Moves an array into memory of its exact size, in large pages where the system has them.
template <class T>
void for_random_reads(std::vector<T>& array) {
  std::vector<T> exact;
  exact.reserve(array.size());
  advise_huge_pages(exact.data(), array.size() * sizeof(T));
  exact.insert(exact.end(), array.begin(), array.end());
  array.swap(exact);
}

// Costs of the surface-area heuristic: of a node with its eight boxes, of a leaf with its eight triangles.
constexpr float k_node_cost = 1.0f, k_leaf_cost = 1.0f;
constexpr uint32_t k_children = k_lanes;      // of a node
constexpr uint8_t k_first = 1, k_second = 2;  // which child of a node has all that is wanted

/// The cheapest wide tree that can be made of a binary one by leaving out inner nodes and by turning subtrees
/// of up to k_lanes triangles into leaves. H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray
/// Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.1: for every subtree the least cost
/// as a forest of at most i trees, from below.
class Writer {
 public:
  Writer(const Tree& tree, const Triangles& triangles, const std::function<bool(uint32_t)>& wanted)
      : tree_(tree), triangles_(triangles), wanted_(wanted) {}

  WideTree run() {
    if (tree_.nodes.empty()) return {};
    whole_ = std::max(half_area(tree_.nodes[0].box), std::numeric_limits<double>::min());
    subtrees_.resize(tree_.nodes.size());
    for (size_t i = tree_.nodes.size(); i-- > 0;) weigh(tree_.nodes[i], subtrees_[i]);  // children come later
    if (subtrees_[0].count == 0) return {};
    make_nodes();
    for_random_reads(made_.nodes);
    for_random_reads(made_.leaves);
    return std::move(made_);
  }

 private:
  /// State of a node of the binary tree.
  struct Subtree {
    Box box;                          ///< around what is wanted; empty: nothing is
    uint32_t count = 0;               ///< triangles that are wanted
    bool leaf = false;                ///< as one tree it is a leaf
    float cost[k_children + 1] = {};  ///< [i]: as at most i trees, i = 1..k_children - 1
    /// [i]: trees of the first child where it is i trees, i = 2..k_children; 0: it is better as i - 1 trees.
    /// [1]: k_first or k_second where only that child has anything that is wanted.
    uint8_t first[k_children + 1] = {};
  };
  struct Item {
    uint32_t from;        ///< node of the binary tree
    uint32_t parent, at;  ///< position for its index
    uint32_t held;        ///< entries of a walk's stack before its children
  };

  /// Share of the whole, which is how likely a ray meets the box.
  float area_of(const Box& box) const { return static_cast<float>(half_area(box) / whole_); }

  void weigh(const Tree::Node& node, Subtree& s) const {
    if (node.leaf()) {
      for (uint32_t r = node.first; r < node.first + node.count; ++r)
        if (wanted_(tree_.references[r].prim)) s.box.grow(tree_.references[r].box), ++s.count;
      s.leaf = true;
      if (s.count > 0) std::fill(s.cost + 1, s.cost + k_children + 1, k_leaf_cost * area_of(s.box));
      return;
    }
    const Subtree &a = subtrees_[node.child[0]], &b = subtrees_[node.child[1]];
    if (a.count == 0 || b.count == 0) {
      s = a.count == 0 ? b : a;
      std::fill(s.first, s.first + k_children + 1, a.count == 0 ? k_second : k_first);
      return;
    }
    s.box = a.box;
    s.box.grow(b.box);
    s.count = a.count + b.count;
    float split[k_children + 1];
    for (uint32_t i = 2; i <= k_children; ++i) {
      split[i] = std::numeric_limits<float>::infinity();
      for (uint32_t k = 1; k < i; ++k)
        if (const float c = a.cost[k] + b.cost[i - k]; c < split[i])
          split[i] = c, s.first[i] = static_cast<uint8_t>(k);
    }
    const float area = area_of(s.box);
    s.cost[1] = k_node_cost * area + split[k_children];
    if (const float c = k_leaf_cost * area; s.count <= k_lanes && c <= s.cost[1])
      s.cost[1] = c, s.leaf = true;
    for (uint32_t i = 2; i < k_children; ++i) {
      s.cost[i] = std::min(split[i], s.cost[i - 1]);
      if (split[i] >= s.cost[i - 1]) s.first[i] = 0;
    }
  }

  /// Appends the roots of `node` as at most `trees` trees.
  void roots(uint32_t node, uint32_t trees, std::vector<uint32_t>& out) const {
    const Subtree& s = subtrees_[node];
    const uint32_t* child = tree_.nodes[node].child;
    if (s.first[1] != 0) return roots(child[s.first[1] == k_first ? 0 : 1], trees, out);
    while (trees > 1 && s.first[trees] == 0) --trees;
    if (trees == 1) return out.push_back(node);
    roots(child[0], s.first[trees], out);
    roots(child[1], trees - s.first[trees], out);
  }

  std::vector<uint32_t> children_of(uint32_t from) const {
    std::vector<uint32_t> children;
    if (subtrees_[from].leaf) return {from};  // the root alone
    roots(from, k_children, children);
    return children;
  }

  void make_nodes() {
    std::vector<Item> items{{0, 0, k_lanes, 0}};
    while (!items.empty()) {
      const Item item = items.back();
      items.pop_back();
      const auto index = static_cast<uint32_t>(made_.nodes.size());
      if (item.at < k_lanes) made_.nodes[item.parent].child[item.at] = index;
      const std::vector<uint32_t> children = children_of(item.from);
      WideNode node;
      node.children = static_cast<uint32_t>(children.size());
      const uint32_t held = item.held + node.children;
      made_.stack = std::max(made_.stack, held);
      for (uint32_t c = 0; c < k_lanes; ++c) {
        const Box box = c < children.size() ? subtrees_[children[c]].box : Box{};
        for (int axis = 0; axis < 3; ++axis)
          node.face[2 * axis][c] = box.lo[axis], node.face[2 * axis + 1][c] = box.hi[axis];
        node.child[c] = c < children.size() && subtrees_[children[c]].leaf ? leaf(children[c]) : 0;
      }
      made_.nodes.push_back(node);
      for (uint32_t c = node.children; c-- > 0;)
        if (!subtrees_[children[c]].leaf) items.push_back({children[c], index, c, held - 1});
    }
  }

  uint32_t leaf(uint32_t from) {
    const Tree::Node& node = tree_.nodes[from];
    uint32_t prims[k_lanes], count = 0;
    for (uint32_t r = node.first; r < node.first + node.count && count < k_lanes; ++r)
      if (wanted_(tree_.references[r].prim)) prims[count++] = tree_.references[r].prim;
    PackedTriangles packed;
    for (uint32_t k = 0; k < k_lanes; ++k) {
      packed.prim[k] = prims[k < count ? k : 0];
      for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis)
          packed.vertex[corner][axis][k] =
              triangles_.vertices[3 * size_t{packed.prim[k]} + static_cast<size_t>(corner)][axis];
    }
    made_.leaves.push_back(packed);
    return k_wide_leaf | static_cast<uint32_t>(made_.leaves.size() - 1);
  }

  const Tree& tree_;
  const Triangles& triangles_;
  const std::function<bool(uint32_t)>& wanted_;
  double whole_ = 1;
  std::vector<Subtree> subtrees_;  // of the binary tree's nodes
  WideTree made_;
};

}  // namespace

WideTree make_wide_tree(const Tree& tree, const Triangles& triangles,
                        const std::function<bool(uint32_t)>& wanted) {
  return Writer(tree, triangles, wanted).run();
}

}  // namespace lucerna::bvh
