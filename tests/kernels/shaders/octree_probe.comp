// The octree's result for every point: the number of spheres that contain it, a checksum of their indices, the length
// of its list, and whether the list is in order.
#include "shaders/lib/invocation.glsl"
#include "shaders/lib/variants.glsl"
#include "shaders/lib/octree.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { uint count; };
uniform samplerBuffer points;
uniform samplerBuffer spheres;
#ifndef LUCERNA_DISCS
#define LUCERNA_DISCS 0
#endif
#if LUCERNA_DISCS
uniform samplerBuffer normals;
#endif
layout(scalar) writeonly buffer Found { uvec4 found[]; };

void main() {
  uint index = global_index();
  if (index >= count) return;
  vec3 x = texelFetch(points, int(index)).xyz;
  OctreeRange range = octree_find(x);
  uint n = 0u, sum = 0u, unordered = 0u, previous = 0u;
  for (uint i = range.first; i < range.last; ++i) {
    uint sphere = octree_sphere(i);
#if LUCERNA_COPIES
    vec4 s = octree_copy(i);
#else
    vec4 s = texelFetch(spheres, int(sphere));
#endif
    precise vec3 d = x - s.xyz, dd = d * d;
    precise float square = dd.x + dd.y, all = square + dd.z, limit = s.w * s.w;
    bool inside = all <= limit && s.w >= 0.0;
#if LUCERNA_DISCS
    precise vec3 off = d * texelFetch(normals, int(sphere)).xyz;
    precise float sum_off = off.x + off.y, away = sum_off + off.z, thick = 0.2 * s.w;
    inside = inside && abs(away) <= thick;
#endif
    n += inside ? 1u : 0u;
    sum += inside ? (sphere + 1u) * 2654435761u : 0u;
    unordered |= i > range.first && sphere <= previous ? 1u : 0u;
    previous = sphere;
  }
  found[index] = uvec4(n, sum, range.last - range.first, unordered);
}
