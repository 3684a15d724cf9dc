// Octree, step 3: references of every run at the requested level and all coarser ones, at most (most_cells). Sums saturate
// at 2^32 - 1. A level counts as unaffordable if one sphere overlaps more leaves than an invocation may visit (see
// lib/runs.glsl).
#include "lib/octree_cells.glsl"
layout(local_size_x = LUCERNA_OCTREE_GROUP) in;
layout(scalar) writeonly buffer RunNeeds { uint run_needs[]; };   // k_octree_levels + 1 for each run

void main() {
  if (global_index() >= LUCERNA_OCTREE_RUNS) return;
  Run run = own_run(global_index(), sphere_count());
  uint need[k_octree_levels + 1u];
  for (uint k = 0u; k <= k_octree_levels; ++k) need[k] = 0u;
  for (uint i = run.first; i < run.end; ++i) {
    vec4 s = texelFetch(spheres, int(i));
    SphereCells c = sphere_cells(s, i);
    bool used = usable(s);
    [[unroll]] for (uint k = 0u; k <= k_octree_levels; ++k) {
      uvec2 rows = uvec2((c.last.yz >> k) - (c.first.yz >> k) + 1);
      uint cells = most_cells(c, k), sum = need[k] + (used ? cells : 0u);
      need[k] = sum < need[k] || (used && max(cells, rows.x * rows.y) > k_longest_run) ? 0xffffffffu : sum;
    }
  }
  for (uint k = 0u; k <= k_octree_levels; ++k)
    run_needs[global_index() * (k_octree_levels + 1u) + k] = need[k];
}
