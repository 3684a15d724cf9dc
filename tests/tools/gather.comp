// Lookup bench: which spheres contain a point, as a count and an order-independent checksum. LUCERNA_NEIGHBOURS 0: one list
// of the octree. 27 or 8: a grid that lists a sphere only in the cell of its centre; reads the 27 cells around the point
// (cells at least as wide as the largest radius), or the 8 nearest (at least as wide as the largest diameter).
#include "lib/variants.glsl"
#include "lib/octree.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { uint count; };
uniform samplerBuffer points;
uniform samplerBuffer spheres;
layout(scalar) writeonly buffer Found { uvec4 found[]; };

void take(uint sphere, inout uint n, inout uint sum) {
  n++;
  sum += (sphere + 1u) * 2654435761u;
}

void main() {
  uint index = global_index();
  if (index >= count) return;
  vec3 x = texelFetch(points, int(index)).xyz;
  uint n = 0u, sum = 0u, listed = 0u;
#if LUCERNA_NEIGHBOURS
  vec3 scaled = (x - octree.origin) * octree.inverse_leaf, cell = floor(scaled);
#if LUCERNA_NEIGHBOURS == 8
  vec3 lowest = floor(scaled - 0.5);
  const uint side = 2u;
#else
  vec3 lowest = cell - 1.0;
  const uint side = 3u;
#endif
  for (uint k = 0u; k < side * side * side; ++k) {
    vec3 neighbour = lowest + vec3(float(k % side), float(k / side % side), float(k / (side * side)));
    bool inside = all(greaterThanEqual(neighbour, vec3(0.0))) && all(lessThan(neighbour, vec3(float(octree.cells))));
    OctreeRange range = octree_leaf(octree_code(uvec3(inside ? neighbour : vec3(0.0))));
    if (!inside) range.last = range.first;
#else
    OctreeRange range = octree_find(x);
#endif
    listed += range.last - range.first;
#if LUCERNA_COPIES
    for (uint i = range.first; i < range.last; ++i) {
      vec4 s = octree_copy(i);
      vec3 d = x - s.xyz;
      if (dot(d, d) <= s.w * s.w) take(octree_sphere(i), n, sum);
    }
#else
    for (uint i = range.first & ~1u; i < range.last; i += 2u) {
      uvec2 two = octree_two_spheres(i);
      vec4 a = texelFetch(spheres, int(two.x)), b = texelFetch(spheres, int(two.y));
      vec3 da = x - a.xyz, db = x - b.xyz;
      if (i >= range.first && dot(da, da) <= a.w * a.w) take(two.x, n, sum);
      if (i + 1u < range.last && dot(db, db) <= b.w * b.w) take(two.y, n, sum);
    }
#endif
#if LUCERNA_NEIGHBOURS
  }
#endif
  found[index] = uvec4(n, sum, listed, 0u);
}
