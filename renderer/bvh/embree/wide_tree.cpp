#include "bvh/embree/wide_tree.h"

#include <algorithm>

#include "base/huge_pages.h"

namespace lucerna::bvh {

namespace {

float half_area(const Box& box) {
  const vec3 s = box.size();
  return s.x * s.y + s.y * s.z + s.z * s.x;
}

class Writer {
 public:
  Writer(const Tree& tree, const Triangles& triangles, const std::function<bool(uint32_t)>& wanted)
      : tree_(tree), triangles_(triangles), wanted_(wanted) {}

  WideTree run() {
    boxes_.resize(tree_.nodes.size());
    size_t leaves = 0;
    for (size_t i = tree_.nodes.size(); i-- > 0;) {  // children come after their parent
      const Tree::Node& node = tree_.nodes[i];
      if (node.leaf()) {
        for (uint32_t r = node.first; r < node.first + node.count; ++r)
          if (wanted_(tree_.references[r].prim)) boxes_[i].grow(tree_.references[r].box);
        leaves += boxes_[i].empty() ? 0 : 1;
      } else {
        for (const uint32_t c : node.child)
          if (!boxes_[c].empty()) boxes_[i].grow(boxes_[c]);
      }
    }
    if (leaves == 0) return {};
    made_.leaves.reserve(leaves);
    advise_huge_pages(made_.leaves.data(), leaves * sizeof(PackedTriangles));
    make_nodes();
    return std::move(made_);
  }

 private:
  struct Item {
    uint32_t from;        ///< node of the binary tree
    uint32_t parent, at;  ///< where its index belongs
    uint32_t held;        ///< entries of a walk's stack before its children
  };

  /// Up to k_lanes nodes that take the place of `from`: those of largest area are replaced by their children.
  std::vector<uint32_t> children_of(uint32_t from) const {
    std::vector<uint32_t> children{from};
    while (children.size() < k_lanes) {
      auto widest = children.end();
      for (auto c = children.begin(); c != children.end(); ++c)
        if (!tree_.nodes[*c].leaf() &&
            (widest == children.end() || half_area(boxes_[*c]) > half_area(boxes_[*widest])))
          widest = c;
      if (widest == children.end()) break;
      const Tree::Node& node = tree_.nodes[*widest];
      widest = children.erase(widest);
      for (const uint32_t c : {node.child[1], node.child[0]})
        if (!boxes_[c].empty()) widest = children.insert(widest, c);
    }
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
        const Box box = c < children.size() ? boxes_[children[c]] : Box{};
        for (int axis = 0; axis < 3; ++axis)
          node.face[2 * axis][c] = box.lo[axis], node.face[2 * axis + 1][c] = box.hi[axis];
        node.child[c] = c < children.size() && tree_.nodes[children[c]].leaf() ? leaf(children[c]) : 0;
      }
      made_.nodes.push_back(node);
      for (uint32_t c = node.children; c-- > 0;)
        if (!tree_.nodes[children[c]].leaf()) items.push_back({children[c], index, c, held - 1});
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
  std::vector<Box> boxes_;  // of the binary tree's nodes, around what is wanted; empty: nothing is
  WideTree made_;
};

}  // namespace

WideTree make_wide_tree(const Tree& tree, const Triangles& triangles,
                        const std::function<bool(uint32_t)>& wanted) {
  return Writer(tree, triangles, wanted).run();
}

}  // namespace lucerna::bvh
