// Octree, step 12, optional: copies the spheres in the order of the references.
#include "lib/octree_leaves.glsl"
layout(local_size_x = LUCERNA_OCTREE_GROUP) in;
layout(scalar) writeonly buffer Copies { vec4 copies[]; };

void main() {
  if (global_index() >= LUCERNA_OCTREE_RUNS) return;
  Run run = own_run(global_index(), reference_count());
  for (uint at = run.first; at < run.end; at += 2u) {
    uvec4 two = texelFetch(octree_references, int(at >> 1));
    // The mark of a split leaf is not a sphere and is never read as one.
    uvec2 two_spheres = uvec2((two.y & k_octree_split) != 0u ? 0u : two.y, (two.w & k_octree_split) != 0u ? 0u : two.w);
    copies[at] = texelFetch(spheres, int(two_spheres.x));
    if (at + 1u < run.end) copies[at + 1u] = texelFetch(spheres, int(two_spheres.y));
  }
}
