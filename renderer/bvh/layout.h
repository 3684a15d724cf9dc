#pragma once
// The tree as the device reads it: two arrays of RGBA32F texels (shaders/lib/bvh.glsl is the reader).
//
// A node is 4 texels holding both children:
//   0..2  for each axis x, y, z: (child 0 low, child 0 high, child 1 low, child 1 high)
//   3     (child 0, child 1, reach, 0): links as words (below); `reach` of node 0 is the largest absolute
//   coordinate
//         of the scene, from which the traversal takes its rounding margin
// Nodes lie in depth-first order, node 0 is the root and always there: an empty scene has a root with two
// empty leaves. A triangle is 3 texels, in leaf order: (p0, word), (p1, 0), (p2, 0).
//
// A word is an integer below 2^29 and a flag, stored as the bits of a float that is never denormal, infinite
// or NaN (bit 30 set, bit 29 clear), so that no device may flush or quieten it on the way: flag << 31 | 1 <<
// 30 | value.
//   link:     flag = leaf; value = node index, or first triangle << 3 | triangles (0..4)
//   triangle: flag = non-opaque; value = primitive id
#include <bit>
#include <iosfwd>
#include <string>
#include <vector>

#include "bvh/bvh.h"
#include "bvh/tree.h"

namespace lucerna::bvh {

struct BvhData {
  std::vector<vec4> nodes;      ///< 4 a node
  std::vector<vec4> triangles;  ///< 3 a triangle reference
  Box bounds;                   ///< of all triangles that can be hit; empty for none
  uint32_t node_count = 0;
  uint32_t triangle_count = 0;   ///< references: a triangle that was split counts once for each part
  uint32_t primitive_count = 0;  ///< primitive ids are below this
  uint32_t max_depth = 0;        ///< inner nodes on the deepest path, 1..k_max_depth
  bool has_opaque = false, has_non_opaque = false;
  float sah_cost = 0;  ///< expected node visits + triangle tests of a random ray that enters the bounds
};

struct Word {
  bool flag;
  uint32_t value;  ///< below k_word_limit
};
inline constexpr uint32_t k_word_limit = 1u << 29;
inline float encode(Word w) { return std::bit_cast<float>((w.flag ? 1u << 31 : 0u) | 1u << 30 | w.value); }
inline Word decode(float f) {
  const auto bits = std::bit_cast<uint32_t>(f);
  return {bits >> 31 != 0, bits & (k_word_limit - 1)};
}

/// Most triangle references: 3 texels each within the 2^27 texels that every device of interest offers.
inline constexpr uint32_t k_max_triangles = (1u << 27) / 3;

/// Lays the tree out, its depth held to k_max_depth first. Within a leaf triangles are in id order.
/// Throws Error when there are more references than k_max_triangles.
BvhData flatten(const Tree& tree, const Triangles& triangles);

/// Checks every promise of this header against the triangles: order, links, depth, boxes around their
/// content, each triangle that can be hit present with its flag. Returns "" or the first thing found wrong.
/// For tests and tools.
std::string check(const BvhData& data, const Triangles& triangles);

/// The arrays with a small header, for flattened scene files. read() throws Error (at `where`) for anything
/// that write() has not written, truncation included.
void write(std::ostream& out, const BvhData& data);
BvhData read(std::istream& in, const std::string& where);

}  // namespace lucerna::bvh
