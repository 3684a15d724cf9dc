// Traversal of the tree that renderer/bvh/layout.h describes.
//
// Device-dependent choices, all made here:
//   LUCERNA_FETCH_STORAGE  nodes and triangles from storage buffers (default: texel buffers, LUCERNA_FETCH_TEXEL)
//   LUCERNA_COUNT_BVH      bvh_visits counts nodes visited and triangles tested
//   LUCERNA_STACK_LOCAL    a stack in registers or private memory (default: in shared memory, LUCERNA_STACK_SHARED)
// The kernel must have declared its local_size_x, at most 64, before including this file.
//
// No hit is lost to rounding. The triangle test is watertight; box tests include everything that the triangle test accepts
// (k_bvh_slack). Hits do not depend on the order of traversal: at equal distance the lower primitive id wins.
#ifndef LUCERNA_LIB_BVH
#define LUCERNA_LIB_BVH
#include "lib/variants.glsl"
#include "shaders/shared/ray.h"
#include "shaders/shared/trace.h"
#include "lib/triangle_test.glsl"

// ---- fetch ----
#if LUCERNA_FETCH_STORAGE
layout(scalar) readonly buffer bvh_nodes { uvec4 bvh_node_texels[]; };
layout(scalar) readonly buffer bvh_triangles { vec4 bvh_triangle_texels[]; };
uvec4 bvh_node_texel(uint i) { return bvh_node_texels[i]; }
vec4 bvh_triangle_texel(uint i) { return bvh_triangle_texels[i]; }
#else
uniform usamplerBuffer bvh_nodes;
uniform samplerBuffer bvh_triangles;
uvec4 bvh_node_texel(uint i) { return texelFetch(bvh_nodes, int(i)); }
vec4 bvh_triangle_texel(uint i) { return texelFetch(bvh_triangles, int(i)); }
#endif

// ---- stack ----
// lucerna::bvh::k_stack: the layout ensures that no traversal needs more.
const uint k_bvh_stack = 48u;
#if LUCERNA_STACK_LOCAL
uint bvh_stack[k_bvh_stack];
#define bvh_stack_at(i) bvh_stack[i]
#else
shared uint bvh_stack[k_bvh_stack * 64u];
#define bvh_stack_at(i) bvh_stack[(i) * 64u + gl_LocalInvocationIndex]
#endif

#if LUCERNA_COUNT_BVH
uint bvh_visits = 0u;
#endif

// ---- words ----
const uint k_bvh_flag = 0x80000000u;  // of a link: leaf; of a triangle: non-opaque
const uint k_bvh_prim = 0x1fffffffu;  // of a triangle's word, its id
const uint k_bvh_done = 0xffffffffu;  // no link: no leaf has 7 triangles

// ---- boxes ----
// The ray hits the faces of the boxes at origin * inverse + byte * (cell * inverse), a sum of two terms that may cancel.
// Each has an error of up to 5 roundings (2^-24) of its size. The distance of a triangle hit is clamped to the part of the
// ray inside a box within these (bvh_within_box()), up to 20 roundings of the distance. Faces are therefore moved outwards
// by 34 roundings of both terms. The tolerance grows with the box and its distance from the ray, never with the scene.
// The four bytes of a word, the lowest first.
vec4 bvh_bytes(uint w) { return vec4(ivec4(uvec4(w, w >> 8, w >> 16, w >> 24) & 0xffu)); }

// ---- order ----
// Sort key of a hit child: the bits of the distance, which sort like it, with the child's number in the last two bits.
const int k_bvh_missed = 0x7fffffff;  // larger than the key of any distance

uint bvh_child(uvec4 links, int key) {
  bool odd = (key & 1) != 0;
  return (key & 2) != 0 ? (odd ? links.w : links.z) : (odd ? links.y : links.x);
}

// The hit of a ray, as `query` (shaders/shared/trace.h, a constant) defines it; dead rays hit nothing.
Hit bvh_trace(Ray ray, const uint query) {
  Hit hit;
  hit.t = ray.tmax;
  hit.prim = 0u;  // before the first hit: no id is lower, so an equal distance does not count
  hit.u = 0.0;
  hit.v = 0.0;
  bool found = false;

  ShearedRay sheared = bvh_shear(ray);
  vec3 inverse = bvh_inverse(ray.direction);
  bvec3 back = lessThan(inverse, vec3(0.0));

  uint link = ray.tmax > 0.0 ? 0u : k_bvh_done;
  uint depth = 0u;
  while (link != k_bvh_done) {
    while (link < k_bvh_flag) {
#if LUCERNA_COUNT_BVH
      ++bvh_visits;
#endif
      uint at = link * 4u;
      uvec4 head = bvh_node_texel(at), xy = bvh_node_texel(at + 1u), z = bvh_node_texel(at + 2u);
      uvec4 links = bvh_node_texel(at + 3u);
      vec3 origin = uintBitsToFloat(head.xyz);
      vec3 step = uintBitsToFloat(uvec3(head.w << 23, head.w << 15, head.w << 7) & 0x7f800000u) * inverse;
      vec3 start = (origin - ray.origin) * inverse;
      vec3 near = start - k_bvh_slack * abs(start), far = start + k_bvh_slack * abs(start);
      vec3 step_near = step - k_bvh_slack * abs(step), step_far = step + k_bvh_slack * abs(step);
      // Near and far planes by the sign of the direction. Compared as integers, which sort like floats unless both are
      // negative; then the result is the same here, and no instruction is spent on NaNs, which cannot occur.
      ivec4 x0 = floatBitsToInt(bvh_bytes(back.x ? xy.y : xy.x) * step_near.x + near.x);
      ivec4 x1 = floatBitsToInt(bvh_bytes(back.x ? xy.x : xy.y) * step_far.x + far.x);
      ivec4 y0 = floatBitsToInt(bvh_bytes(back.y ? xy.w : xy.z) * step_near.y + near.y);
      ivec4 y1 = floatBitsToInt(bvh_bytes(back.y ? xy.z : xy.w) * step_far.y + far.y);
      ivec4 z0 = floatBitsToInt(bvh_bytes(back.z ? z.y : z.x) * step_near.z + near.z);
      ivec4 z1 = floatBitsToInt(bvh_bytes(back.z ? z.x : z.y) * step_far.z + far.z);
      ivec4 enter = max(max(x0, y0), max(z0, ivec4(0)));
      vec4 leave = intBitsToFloat(min(min(x1, y1), min(z1, ivec4(floatBitsToInt(hit.t)))));
      bvec4 inside = lessThanEqual(intBitsToFloat(enter), leave);
      ivec4 key = mix(ivec4(k_bvh_missed), (enter & ~3) | ivec4(0, 1, 2, 3), inside);
      // Sorted by a network of five comparators.
      ivec2 low = min(key.xy, key.zw), high = max(key.xy, key.zw);
      int first = min(low.x, low.y), last = max(high.x, high.y);
      int a = max(low.x, low.y), b = min(high.x, high.y);
      int second = min(a, b), third = max(a, b);
      if (last != k_bvh_missed) {
        bvh_stack_at(depth) = bvh_child(links, last);
        ++depth;
      }
      if (third != k_bvh_missed) {
        bvh_stack_at(depth) = bvh_child(links, third);
        ++depth;
      }
      if (second != k_bvh_missed) {
        bvh_stack_at(depth) = bvh_child(links, second);
        ++depth;
      }
      if (first != k_bvh_missed) {
        link = bvh_child(links, first);
      } else if (depth == 0u) {
        link = k_bvh_done;
      } else {
        --depth;
        link = bvh_stack_at(depth);
      }
    }
    if (link == k_bvh_done) break;
    uint first = (link & ~k_bvh_flag) >> 3, count = link & 7u;
#if LUCERNA_COUNT_BVH
    bvh_visits += count;
#endif
    for (uint i = 0u; i < count; ++i) {
      uint at = (first + i) * 3u;
      vec4 p0 = bvh_triangle_texel(at), p1 = bvh_triangle_texel(at + 1u), p2 = bvh_triangle_texel(at + 2u);
      float t, u, v;
      bool accept = bvh_test(sheared, p0.xyz, p1.xyz, p2.xyz, t, u, v);
      uint word = floatBitsToUint(p0.w);
      uint prim = word & k_bvh_prim;
      accept = accept && t > 0.0 && (t < hit.t || (t == hit.t && prim < hit.prim));
#if LUCERNA_NON_OPAQUE
      if (query == k_query_any_opaque) accept = accept && word < k_bvh_flag;
#endif
      if (query == k_query_closest_non_opaque) accept = accept && word >= k_bvh_flag;
      if (accept) {
        hit.t = t;
        hit.prim = prim;
        hit.u = u;
        hit.v = v;
        found = true;
      }
    }
    bool over = depth == 0u || (query == k_query_any_opaque && found);
    depth = over ? 0u : depth - 1u;
    link = over ? k_bvh_done : bvh_stack_at(depth);
  }
  hit.prim = found ? hit.prim : k_no_hit;
  return hit;
}

#endif
