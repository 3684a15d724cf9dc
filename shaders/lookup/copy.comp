// Octree, step 12, where it is asked for: the spheres themselves in the order of the references.
#include "lib/octree_leaves.glsl"
layout(local_size_x = LUCERNA_OCTREE_GROUP) in;
layout(scalar) writeonly buffer Copies { vec4 copies[]; };

void main() {
  if (global_index() >= LUCERNA_OCTREE_RUNS) return;
  Run run = own_run(global_index(), reference_count());
  for (uint at = run.first; at < run.end; at += 2u) {
    uvec4 two = texelFetch(octree_references, int(at >> 1));
    copies[at] = texelFetch(spheres, int(two.y));
    if (at + 1u < run.end) copies[at + 1u] = texelFetch(spheres, int(two.w));
  }
}
