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
    if (data_.node_count == 0 || data_.nodes.size() != k_node_texels * size_t{data_.node_count})
      return "wrong number of node texels";
    if (data_.triangles.size() != 3 * size_t{data_.triangle_count}) return "wrong number of triangle texels";
    if (data_.primitive_count != triangles_.count()) return "wrong number of primitives";
    covered_.assign(triangles_.count(), Box{});
    node(0, data_.bounds, 1, 0);
    if (!wrong_.empty()) return wrong_;
    if (next_node_ != data_.node_count) return "nodes that are never reached";
    if (next_triangle_ != data_.triangle_count) return "triangles that are never reached";
    if (deepest_ != data_.max_depth) return fmt::format("depth {} stated {}", deepest_, data_.max_depth);
    if (most_held_ != data_.stack || most_held_ > k_stack)
      return fmt::format("stack {} stated {}", most_held_, data_.stack);
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

  /// `held`: maximum entries on the stack when a traversal reaches the node.
  void node(uint32_t index, const Box& parent, uint32_t level, uint32_t held) {
    if (index != next_node_++) return fail(fmt::format("node {} is out of depth-first order", index));
    if (index >= data_.node_count) return fail("link beyond the last node");
    deepest_ = std::max(deepest_, level);
    const uvec4* texel = &data_.nodes[k_node_texels * size_t{index}];
    Grid grid;
    grid.origin = std::bit_cast<vec3>(uvec3(texel[0]));
    if (!std::isfinite(grid.origin.x + grid.origin.y + grid.origin.z))
      return fail("origin that is not finite");
    const uint32_t low[3] = {texel[1].x, texel[1].z, texel[2].x},
                   high[3] = {texel[1].y, texel[1].w, texel[2].y};
    uint32_t children = 0;
    bool there[k_width];
    for (uint32_t c = 0; c < k_width; ++c) {
      bool missing = true;
      for (int axis = 0; axis < 3; ++axis) {
        grid.exponent[axis] = static_cast<int>(texel[0].w >> 8 * axis & 255) - 127;
        if (std::abs(grid.exponent[axis]) > 126) return fail("cell that is not a normal number");
        grid.low[c][axis] = static_cast<uint8_t>(low[axis] >> 8 * c);
        grid.high[c][axis] = static_cast<uint8_t>(high[axis] >> 8 * c);
        missing = missing && grid.low[c][axis] == 255 && grid.high[c][axis] == 0;
      }
      there[c] = !missing;
      children += there[c];
    }
    if (children > 0) held += children - 1;
    most_held_ = std::max(most_held_, held);
    for (uint32_t c = 0; c < k_width; ++c) {
      const Link link = decode(texel[3][static_cast<int>(c)]);
      // Bounds of the traversal: each box on the way is rounded on its own grid.
      Box box = grid.box(c);
      if (there[c]) box = {glm::max(box.lo, parent.lo), glm::min(box.hi, parent.hi)};
      if (!there[c]) {
        if (!link.leaf || link.value != 0) fail(fmt::format("node {}: a link to a child without box", index));
      } else if (link.leaf) {
        leaf(link.value, box);
      } else {
        node(link.value, box, level + 1, held);
      }
      if (!wrong_.empty()) return;
    }
  }

  void leaf(uint32_t value, const Box& box) {
    const uint32_t first = value >> 3, count = value & 7;
    if (count > k_max_leaf) return fail("leaf too large");
    if (count == 0) return;
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
      own = grown(own, margin_of(&triangles_.vertices[3 * size_t{word.value}]));
      const Box part{glm::max(own.lo, box.lo), glm::min(own.hi, box.hi)};
      if (part.empty()) return fail(fmt::format("triangle {} lies outside its leaf", word.value));
      covered_[word.value].grow(part);
    }
  }

  const BvhData& data_;
  const Triangles& triangles_;
  std::vector<Box> covered_;
  std::string wrong_;
  uint32_t next_node_ = 0, next_triangle_ = 0, deepest_ = 0, most_held_ = 0;
};

}  // namespace

std::string check(const BvhData& data, const Triangles& triangles) { return Checker(data, triangles).run(); }

}  // namespace lucerna::bvh
