// What the kernels share that build the octree. Most of their invocations work through a run of spheres, references, leaves
// or slots.
#ifndef LUCERNA_LIB_OCTREE_BUILD
#define LUCERNA_LIB_OCTREE_BUILD
#include "shaders/shared/sort.h"
#include "shaders/shared/octree.h"
#include "lib/invocation.glsl"
#include "lib/runs.glsl"

#ifndef LUCERNA_OCTREE_GROUP
#define LUCERNA_OCTREE_GROUP 8
#define LUCERNA_OCTREE_WANTED 1024
#define LUCERNA_OCTREE_RUNS 4096
#endif
const uint k_least_run = 16u;

layout(push_constant, scalar) uniform Push { OctreePush push; };
layout(scalar) readonly buffer SphereCount { uint sphere_count_words[]; };
uniform samplerBuffer spheres;   // centre, radius

uint sphere_count() {
  return counted(sphere_count_words);
}
Run own_run(uint index, uint count) {
  uint length = run_length(count, k_least_run, LUCERNA_OCTREE_WANTED);
  return run_of(index, run_count(count, length), length, count);
}

// Of two pairs, and of four words, in a texel.
uvec2 pair_of(uvec4 two, uint index) { return (index & 1u) != 0u ? two.zw : two.xy; }
uint word_of(uvec4 four, uint index) {
  uvec2 two = (index & 2u) != 0u ? four.zw : four.xy;
  return (index & 1u) != 0u ? two.y : two.x;
}

bool finite(float x) { return abs(x) <= 3.4e38; }
// Spheres without extent or place are left out.
bool usable(vec4 s) { return s.w >= 0.0 && finite(s.x) && finite(s.y) && finite(s.z) && finite(s.w); }

// Points that pass dot(x - c, x - c) <= r * r in float may be up to about 4 ulps beyond r.
float safe_radius(float r) { return r * (1.0 + 1.0 / 1048576.0); }
#endif
