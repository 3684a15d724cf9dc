// The bench of lookups: which spheres contain a point, as their number and a checksum that does not depend on order.
// LUCERNA_NEIGHBOURS 0: the octree's one list. 27 or 8: a grid that lists a sphere in the cell of its centre alone; 27 cells
// around that of the point (cells no smaller than the largest radius), or the 8 nearest (no smaller than the largest
// diameter).
#include "lib/octree.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { uint count; };
uniform samplerBuffer points;
uniform samplerBuffer spheres;
layout(scalar) writeonly buffer Found { uvec4 found[]; };

#ifndef LUCERNA_NEIGHBOURS
#define LUCERNA_NEIGHBOURS 0
#endif

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
    for (uint i = range.first; i < range.last; ++i) {
      uint sphere = octree_sphere(i);
      vec4 s = texelFetch(spheres, int(sphere));
      vec3 d = x - s.xyz;
      bool within = dot(d, d) <= s.w * s.w;
      n += within ? 1u : 0u;
      sum += within ? (sphere + 1u) * 2654435761u : 0u;
    }
#if LUCERNA_NEIGHBOURS
  }
#endif
  found[index] = uvec4(n, sum, listed, 0u);
}
