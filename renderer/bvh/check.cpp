#include <algorithm>
#include <cmath>

#include "bvh/layout.h"

#include <fmt/format.h>

namespace lucerna::bvh {

namespace {

bool inside(const Box& outer, const Box& inner) {
  return glm::all(glm::lessThanEqual(outer.lo, inner.lo)) &&
         glm::all(glm::greaterThanEqual(outer.hi, inner.hi));
}

class Checker {
 public:
  Checker(const BvhData& data, const Triangles& triangles) : data_(data), triangles_(triangles) {}

  std::string run() {
    if (data_.node_count == 0 || data_.nodes.size() != 4 * size_t{data_.node_count})
      return "wrong number of node texels";
    if (data_.triangles.size() != 3 * size_t{data_.triangle_count}) return "wrong number of triangle texels";
    if (data_.primitive_count != triangles_.count()) return "wrong number of primitives";
    covered_.assign(triangles_.count(), Box{});
    node(0, data_.bounds, 1);
    if (!wrong_.empty()) return wrong_;
    if (next_node_ != data_.node_count) return "nodes that are never reached";
    if (next_triangle_ != data_.triangle_count) return "triangles that are never reached";
    if (deepest_ != data_.max_depth || deepest_ > k_max_depth)
      return fmt::format("depth {} stated {}", deepest_, data_.max_depth);
    for (const Reference& r : references_of(triangles_)) {
      // The parts of a split triangle together must span it.
      const Box& box = covered_[r.prim];
      if (box.empty()) return fmt::format("triangle {} is in no leaf", r.prim);
      if (!inside(box, r.box)) return fmt::format("triangle {} sticks out of its leaves", r.prim);
    }
    return {};
  }

 private:
  void fail(std::string what) {
    if (wrong_.empty()) wrong_ = std::move(what);
  }

  void node(uint32_t index, const Box& parent, uint32_t level) {
    if (index != next_node_++) return fail(fmt::format("node {} is out of depth-first order", index));
    if (index >= data_.node_count) return fail("link beyond the last node");
    deepest_ = std::max(deepest_, level);
    if (level > k_max_depth) return fail("deeper than the stack");
    const vec4* texel = &data_.nodes[4 * size_t{index}];
    for (int side = 0; side < 2; ++side) {
      Box box;
      for (int axis = 0; axis < 3; ++axis)
        box.lo[axis] = texel[axis][2 * side], box.hi[axis] = texel[axis][2 * side + 1];
      if (!std::isnormal(texel[3][side]))
        return fail(fmt::format("link of node {} is not a normal number", index));
      const Word link = decode(texel[3][side]);
      if (!link.flag) {
        if (!inside(parent, box)) return fail(fmt::format("child of node {} sticks out of it", index));
        node(link.value, box, level + 1);
      } else {
        leaf(link.value, box, parent);
      }
      if (!wrong_.empty()) return;
    }
  }

  void leaf(uint32_t value, const Box& box, const Box& parent) {
    const uint32_t first = value >> 3, count = value & 7;
    if (count > k_max_leaf) return fail("leaf too large");
    if (count == 0) return;
    if (!inside(parent, box)) return fail("leaf sticks out of its parent");
    if (first != next_triangle_) return fail("leaves are not in depth-first order");
    next_triangle_ += count;
    uint32_t last = 0;
    for (uint32_t i = first; i < first + count; ++i) {
      if (i >= data_.triangle_count) return fail("leaf beyond the last triangle");
      const vec4* texel = &data_.triangles[3 * size_t{i}];
      if (!std::isnormal(texel[0].w)) return fail("triangle word is not a normal number");
      const Word word = decode(texel[0].w);
      if (word.value >= triangles_.count()) return fail("primitive id out of range");
      if (i > first && word.value <= last) return fail("leaf is not in id order");
      last = word.value;
      if (word.flag == triangles_.opaque(word.value))
        return fail(fmt::format("triangle {} has the wrong flag", word.value));
      Box own;
      for (int k = 0; k < 3; ++k) {
        const vec3 p(texel[k]);
        if (p != triangles_.vertices[3 * size_t{word.value} + k])
          return fail(fmt::format("triangle {} was changed", word.value));
        own.grow(p);
      }
      const Box part{glm::max(own.lo, box.lo), glm::min(own.hi, box.hi)};
      if (part.empty()) return fail(fmt::format("triangle {} lies outside its leaf", word.value));
      covered_[word.value].grow(part);
    }
  }

  const BvhData& data_;
  const Triangles& triangles_;
  std::vector<Box> covered_;
  std::string wrong_;
  uint32_t next_node_ = 0, next_triangle_ = 0, deepest_ = 0;
};

}  // namespace

std::string check(const BvhData& data, const Triangles& triangles) { return Checker(data, triangles).run(); }

}  // namespace lucerna::bvh
