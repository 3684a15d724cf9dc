// Octree, step 2, one workgroup: root box, and the leaf level that fits the size of the spheres. Sums run in a fixed order.
#include "lib/octree_build.glsl"
layout(local_size_x = 64) in;
layout(scalar) readonly buffer RunBounds { vec4 run_bounds[]; };
layout(scalar) writeonly buffer OctreeHeaders { OctreeHeader octree; };
shared vec4 lows[64], highs[64];
shared float counts[64];

void main() {
  uint lane = gl_LocalInvocationIndex;
  const uint each = (LUCERNA_OCTREE_RUNS + 63) / 64;
  uint end = min((lane + 1u) * each, LUCERNA_OCTREE_RUNS);
  vec4 low = vec4(vec3(3.4e38), 0.0), high = vec4(vec3(-3.4e38), 0.0);
  float summed = 0.0;
  for (uint i = lane * each; i < end; ++i) {
    vec4 a = run_bounds[3u * i], b = run_bounds[3u * i + 1u];
    summed += run_bounds[3u * i + 2u].x;
    low = vec4(min(low.xyz, a.xyz), low.w + a.w);
    high = vec4(max(high.xyz, b.xyz), high.w + b.w);
  }
  lows[lane] = low;
  highs[lane] = high;
  counts[lane] = summed;
  barrier();
  if (lane != 0u) return;
  for (uint i = 1u; i < 64u; ++i) {
    low = vec4(min(low.xyz, lows[i].xyz), low.w + lows[i].w);
    high = vec4(max(high.xyz, highs[i].xyz), high.w + highs[i].w);
    summed += counts[i];
  }
  float n = high.w;
  // Distant spheres are left out: they would enlarge all leaves.
  vec3 core_low = max(low.xyz, push.core_low), core_high = min(high.xyz, push.core_high);
  bool held = all(lessThanEqual(push.core_low, push.core_high)) && all(lessThan(core_low, core_high)) &&
              (any(lessThan(low.xyz, core_low)) || any(lessThan(core_high, high.xyz)));
  low.xyz = held ? core_low : low.xyz;
  high.xyz = held ? core_high : high.xyz;
  OctreeHeader o;
  o.open = held ? 1u : 0u;
  o.origin = n > 0.0 ? low.xyz : vec3(0.0);
  precise vec3 extent = n > 0.0 ? high.xyz - o.origin : vec3(0.0);
  float longest = max(max(extent.x, extent.y), extent.z);
  o.mean_diameter = summed > 0.0 ? low.w / summed : 0.0;
  // Largest power of two not above the wanted size; at most k_octree_levels levels; one root contains everything.
  float wanted = max(push.scale * o.mean_diameter, longest * (0.5 / float(1u << k_octree_levels)));
  int exponent;
  frexp(clamp(wanted, 1e-30, 1e30), exponent);   // wanted = [0.5, 1) * 2^exponent
  o.leaf = ldexp(1.0, exponent - 1);
  o.level = 0u;
  o.edge = o.leaf;
  // `longest` itself lies inside: a point there is in the last cell, not behind it.
  for (uint i = 0u; i < 300u && o.edge <= longest; ++i) {
    o.edge *= 2.0;
    if (o.level < k_octree_levels) o.level++; else o.leaf *= 2.0;
  }
  o.inverse_leaf = 1.0 / o.leaf;
  o.wanted_level = o.level;
  o.cells = n > 0.0 ? 1u << o.level : 0u;
  o.spheres = uint(n);
  o.references = o.needed = o.leaves = o.overflow = o.split = o.split_references = o.split_cells = 0u;
  o.capacity = push.capacity;
  o.slots = 2u;
  o.slot_shift = 31u;
  octree = o;
}
