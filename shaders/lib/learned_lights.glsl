// Lights chosen by what has arrived at a place before (shared/learned_lights.h): P. Vevoda, I. Kondapaneni and J. Krivanek,
// "Bayesian online regression for adaptive direct illumination sampling" (2018). For lib/lights.glsl.
#ifndef LUCERNA_LIB_LEARNED_LIGHTS
#define LUCERNA_LIB_LEARNED_LIGHTS
#include "lib/variants.glsl"
#include "lib/frame.glsl"
#include "lib/sampler.glsl"
#include "shaders/shared/learned_lights.h"

uniform samplerBuffer learned_grid;
uniform samplerBuffer learned_rows;
uniform samplerBuffer light_clusters;
uniform samplerBuffer cluster_members;
#if LUCERNA_SHAPES
uniform samplerBuffer shape_clusters;  // a texel a lamp with a shape: bits of its cluster
#endif

// Facing of a unit normal: its dominant axis and sign.
uint learned_facing(vec3 normal) {
  vec3 a = abs(normal);
  uint axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
  float along = axis == 0u ? normal.x : axis == 1u ? normal.y : normal.z;
  return 2u * axis + (along < 0.0 ? 1u : 0u);
}

uint learned_word(uint at) {
  vec4 four = texelFetch(learned_grid, int(at >> 2));
  vec2 two = (at & 2u) != 0u ? four.zw : four.xy;
  return floatBitsToUint((at & 1u) != 0u ? two.y : two.x);
}

// The row for a point on a surface with that normal, unit, on the visible side.
uint learned_row(vec3 position, vec3 normal) {
  vec3 at = clamp((position - frame.learned_origin) * frame.learned_scale, vec3(0.0), vec3(float(k_learned_cells) - 0.5));
  uvec3 cell = uvec3(at), top = cell / k_learned_brick, within = cell % k_learned_brick;
  uint first = ((learned_facing(normal) * k_learned_top + top.z) * k_learned_top + top.y) * k_learned_top + top.x;
  uint word = learned_word(first);
  const uint bricks = k_learned_facings * k_learned_top * k_learned_top * k_learned_top;
  uint second = bricks + ((word >> 1) * k_learned_brick * k_learned_brick + within.z * k_learned_brick + within.y) * k_learned_brick + within.x;
  // A row's word is always fetched again: a branch would save nothing.
  return learned_word((word & 1u) != 0u ? second : first) >> 1;
}

// The row's probability of a cluster over that without learning.
float learned_ratio(uint row, uint cluster) { return texelFetch(learned_rows, int(row * frame.light_clusters + cluster)).z; }

struct LightCluster {
  uint first, count;  // range of cluster_members
  vec2 corner;        // corner of its square
  float side;         // side of its square: 1 over the number of squares
  float plain;        // probability without learning
  bool of_triangles;  // a run of emissive triangles
};
LightCluster light_cluster(uint cluster) {
  vec4 c = texelFetch(light_clusters, int(cluster));
  uint square = floatBitsToUint(c.z);
  float side = 1.0 / float(square >> 16 & 0xffu);
  return LightCluster(floatBitsToUint(c.x), floatBitsToUint(c.y), vec2(square & 0xffu, square >> 8 & 0xffu) * side, side, c.w, (square & k_cluster_of_triangles) != 0u);
}

// Chooses a member of a cluster as without learning; bits: 64, as for alias_choose().
uint cluster_member(LightCluster c, uvec2 bits) {
  uint i, fraction, more, lost, carry;
  umulExtended(bits.x, c.count, i, fraction);
  umulExtended(bits.y, c.count, more, lost);
  fraction = uaddCarry(fraction, more, carry);
  i += carry;
  vec4 e = texelFetch(cluster_members, int(c.first + i));
  return floatBitsToUint(coin_below(fraction, e.x) ? e.z : e.w);
}

// Index of the square, of `squares` along a side, that contains these random numbers.
uint square_of(vec2 u, uint squares) {
  uvec2 at = min(uvec2(u * float(squares)), uvec2(squares - 1u));
  return at.y * squares + at.x;
}

#if LUCERNA_EMISSIVE
uniform samplerBuffer primitive_clusters;
// Cluster of a point of an emissive triangle, by the barycentrics of a hit.
uint emissive_cluster(uint primitive, vec2 uv) {
  vec4 four = texelFetch(primitive_clusters, int(primitive >> 2));
  vec2 two = (primitive & 2u) != 0u ? four.zw : four.xy;
  uint word = floatBitsToUint((primitive & 1u) != 0u ? two.y : two.x);
  // Inverse of the mapping of sample_light().
  vec2 b = vec2(1.0 - uv.x - uv.y, uv.x);
  float middle = 0.5 * (b.x + b.y);
  vec2 m = b.y > b.x ? vec2(b.x, middle) : vec2(middle, b.y);
  return (word & 0xffffffu) + square_of(clamp(2.0 * m, 0.0, 1.0), word >> 24);
}
#endif

#if LUCERNA_ENVIRONMENT_MAP
#if !LUCERNA_SKY_SQUARES
uniform samplerBuffer sky_tiles;
#endif
// Cluster of a direction within a texel of the environment.
uint sky_cluster(vec3 direction, uint texel, float u) {
#if LUCERNA_SKY_SQUARES
  return square_of(vec2(u, 0.5 - 0.5 * direction.y), uint(LUCERNA_SKY_SQUARES));
#else
  uvec4 words = floatBitsToUint(texelFetch(sky_tiles, int(texel >> 4)));
  return words[texel >> 2 & 3u] >> 8u * (texel & 3u) & 0xffu;
#endif
}
#endif

#endif
