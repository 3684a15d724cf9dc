// Octree, step 1: bounding box, count and summed diameter of the spheres of every run.
#include "lib/octree_build.glsl"
layout(local_size_x = LUCERNA_OCTREE_GROUP) in;
layout(scalar) writeonly buffer RunBounds { vec4 run_bounds[]; };   // low, sum of diameters; high, count; (x) spheres in the sum

void main() {
  if (global_index() >= LUCERNA_OCTREE_RUNS) return;
  Run run = own_run(global_index(), sphere_count());
  vec3 low = vec3(3.4e38), high = vec3(-3.4e38);
  float sum = 0.0, n = 0.0, summed = 0.0;
  // Distant spheres must not determine the leaf size near the points.
  bool core = all(lessThanEqual(push.core_low, push.core_high));
  for (uint i = run.first; i < run.end; ++i) {
    vec4 s = texelFetch(spheres, int(i));
    bool used = usable(s);
    // One unit in the last place more on each side, for the rounding of these differences.
    vec3 r = vec3(safe_radius(s.w)), slack = (abs(s.xyz) + r) * (1.0 / 4194304.0) + 1e-30;
    low = used ? min(low, s.xyz - r - slack) : low;
    high = used ? max(high, s.xyz + r + slack) : high;
    bool counts = used && (!core || (all(greaterThanEqual(s.xyz, push.core_low)) && all(lessThanEqual(s.xyz, push.core_high))));
    sum += counts ? 2.0 * s.w : 0.0;
    summed += counts ? 1.0 : 0.0;
    n += used ? 1.0 : 0.0;
  }
  uint at = 3u * global_index();
  run_bounds[at] = vec4(low, sum);
  run_bounds[at + 1u] = vec4(high, n);
  run_bounds[at + 2u] = vec4(summed, 0.0, 0.0, 0.0);
}
