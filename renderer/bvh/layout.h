#pragma once
// The tree for the device: two arrays of texels, read by shaders/lib/bvh.glsl.
//
// The binary tree of the builder is collapsed into nodes of up to four children, whose boxes are rounded
// outwards to 8 bits a side on a grid of the node's own (H. Ylitie, T. Karras, S. Laine, "Efficient
// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, with four children for their
// eight): half the texels of a binary node for each child, whatever the scale of the scene.
//
// A node is 4 texels of RGBA32UI:
//   0  (origin x, y, z as float bits, exponents)   cell of axis a: 2^(e - 127), e = byte a of `exponents`
//   1  (x low, x high, y low, y high)              byte c is that of child c: its plane lies at
//   2  (z low, z high, 0, 0)                       origin + byte * cell
//   3  links of the four children: leaf << 31 | value; an inner node's index, or first triangle << 3 |
//   triangles (0..4)
// A missing child has low 255, high 0 and an empty leaf. Nodes are in depth-first order; node 0 is the root
// and always present: an empty scene has a root without children.
//
// A triangle is 3 texels of RGBA32F, in leaf order: (p0, word), (p1, 0), (p2, 0). Its word is the primitive
// id and a flag (non-opaque), stored as the bits of a float that is never denormal, infinite or NaN, so that
// no device may change it: flag << 31 | 1 << 30 | id.
#include <bit>
#include <iosfwd>
#include <string>
#include <vector>

#include "bvh/bvh.h"
#include "bvh/tree.h"

namespace lucerna::bvh {

inline constexpr uint32_t k_node_texels = 4;
inline constexpr uint32_t k_width = 4;  ///< children of a node

struct BvhData {
  std::vector<uvec4> nodes;     ///< k_node_texels a node
  std::vector<vec4> triangles;  ///< 3 a triangle reference
  Box bounds;                   ///< bounds of all triangles that can be hit; empty without any
  uint32_t node_count = 0;
  uint32_t triangle_count = 0;   ///< references: a split triangle counts once for each part
  uint32_t primitive_count = 0;  ///< primitive ids are below this
  uint32_t max_depth = 0;        ///< nodes on the deepest path, at least 1
  uint32_t stack = 0;            ///< maximum stack entries of a traversal, 0..k_stack
  bool has_opaque = false, has_non_opaque = false;
  float sah_cost = 0;  ///< expected node visits + triangle tests of a random ray that enters the bounds
};

struct Link {
  bool leaf;
  uint32_t value;  ///< below 2^31
};
inline uint32_t encode(Link l) { return (l.leaf ? 1u << 31 : 0u) | l.value; }
inline Link decode(uint32_t bits) { return {bits >> 31 != 0, bits & 0x7fffffffu}; }

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

/// The boxes of a node's children on the node's grid.
struct Grid {
  vec3 origin{0};
  int exponent[3] = {};  ///< exponents of the cells, -126..127
  uint8_t low[k_width][3] = {}, high[k_width][3] = {};

  /// The finest grid for these boxes, 1..k_width of them: byte * cell + origin is never inside a box.
  static Grid around(std::span<const Box> boxes);
  /// The box of a child, rounded outwards if not exact in floats.
  Box box(uint32_t child) const;
};

/// Maximum triangle references: 3 texels each within the 2^27 texels of every relevant device.
inline constexpr uint32_t k_max_triangles = (1u << 27) / 3;

/// Layout of the tree, with its depth limited to k_max_depth first. Within a leaf, triangles are in id order.
/// Throws Error if there are more references than k_max_triangles.
BvhData flatten(const Tree& tree, const Triangles& triangles);

/// Checks all properties of this header against the triangles: order, links, stack, boxes around their
/// content, each triangle that can be hit present with its flag. Returns "" or the first violation. For tests
/// and tools.
std::string check(const BvhData& data, const Triangles& triangles);

/// The arrays with a small header, for flattened scene files. read() throws Error (at `where`) for anything
/// not written by write(), including truncated data.
void write(std::ostream& out, const BvhData& data);
BvhData read(std::istream& in, const std::string& where);

}  // namespace lucerna::bvh
