// What the wavefront's kernels share: queues, counters, and the state of the paths in flight.
//
// State is read through texel buffers (RGBA32F; integers as bit patterns) and written as storage buffers, word by word and
// only what changed: on lavapipe a storage-buffer access under a mask is a scalar loop over the lanes for every word, and
// those loops were two thirds of the shading time; a texel fetch is a vector operation (and an image store slower than
// either). Within one dispatch a slot is touched by one invocation, which reads it before it writes it.
#ifndef LUCERNA_LIB_WAVEFRONT
#define LUCERNA_LIB_WAVEFRONT
#include "lib/variants.glsl"
#include "lib/frame.glsl"
#include "lib/invocation.glsl"
#include "lib/radiance.glsl"

layout(local_size_x = 64) in;
// Kernels that begin or end paths define LUCERNA_PUSH first, as the name of a structure of their own.
#ifndef LUCERNA_PUSH
#define LUCERNA_PUSH TransportPush
#endif
layout(push_constant, scalar) uniform Push { LUCERNA_PUSH push; };

layout(scalar) buffer Queue { uint queue[]; };
layout(scalar) buffer NextQueue { uint next_queue[]; };
layout(scalar) buffer Counters { uint counters[]; };

uniform samplerBuffer ray_texels;           // Rays, 2 texels a slot
uniform samplerBuffer hit_texels;           // Hits, 1
uniform samplerBuffer path_texels;          // Paths, 3
uniform samplerBuffer shadow_ray_texels;    // ShadowRays, 2
uniform samplerBuffer shadow_state_texels;  // ShadowStates, 2
layout(scalar) writeonly buffer Rays { Ray rays[]; };
layout(scalar) writeonly buffer Paths { PathState paths[]; };
layout(scalar) writeonly buffer Radiance { vec4 radiance[]; };
layout(scalar) writeonly buffer Features { vec4 features[]; };  // 2 a slot: (albedo, hit 0/1) (normal, depth)
layout(scalar) writeonly buffer ShadowRays { Ray shadow_rays[]; };
layout(scalar) writeonly buffer ShadowStates { ShadowState shadow_states[]; };

Ray ray_from(vec4 a, vec4 b) { return Ray(a.xyz, a.w, b.xyz, floatBitsToUint(b.w)); }
Ray load_ray(uint slot) { return ray_from(texelFetch(ray_texels, int(2u * slot)), texelFetch(ray_texels, int(2u * slot + 1u))); }
Ray load_shadow_ray(uint slot) {
  return ray_from(texelFetch(shadow_ray_texels, int(2u * slot)), texelFetch(shadow_ray_texels, int(2u * slot + 1u)));
}
Hit hit_from(vec4 h) { return Hit(h.x, floatBitsToUint(h.y), h.z, h.w); }
Hit load_hit(uint slot) { return hit_from(texelFetch(hit_texels, int(slot))); }

PathState path_from(vec4 a, vec4 bits, vec4 c) {
  uvec4 b = floatBitsToUint(bits);
  return PathState(a.xyz, a.w, b.x, b.y, b.z, b.w, c.x, c.y, floatBitsToUint(c.z), floatBitsToUint(c.w));
}
PathState load_path(uint slot) {
  int at = int(3u * slot);
  return path_from(texelFetch(path_texels, at), texelFetch(path_texels, at + 1), texelFetch(path_texels, at + 2));
}
ShadowState load_shadow_state(uint slot) {
  vec4 a = texelFetch(shadow_state_texels, int(2u * slot)), b = texelFetch(shadow_state_texels, int(2u * slot + 1u));
#if !(LUCERNA_SPECULAR || LUCERNA_GLASS)
  b.xyz = vec3(0.0);  // where nothing is glossy it is not written
#endif
  return ShadowState(a.xyz, floatBitsToUint(a.w), b.xyz, floatBitsToUint(b.w));
}
// What later vertices change of a path; what the scene cannot change is not written.
void store_path(uint slot, PathState p) {
  paths[slot].throughput = p.throughput;
  paths[slot].pdf = p.pdf;
  paths[slot].bits = p.bits;
#if LUCERNA_VOLUMES
  paths[slot].media = p.media;
#endif
#if LUCERNA_TRANSPARENT
  paths[slot].travelled = p.travelled;
  paths[slot].nulls = p.nulls;
#endif
#if LUCERNA_SOLID_GLASS
  paths[slot].eta_scale = p.eta_scale;
#endif
}

// Zero light, of no group.
void clear_radiance(uint slot) {
#if LUCERNA_GROUP_SUMS
  for (uint c = 0u; c < k_component_count; ++c) radiance[radiance_texel(slot, c)] = vec4(0.0);
#else
  for (uint lane = 0u; lane < k_lane_count; ++lane) radiance[radiance_texel(slot, lane)].rgb = vec3(0.0);
#endif
}

// To a texel of the path's radiance. At most once a texel and dispatch (see above).
void add_to_radiance(uint slot, uint lane, bool wanted, vec3 value) {
  if (wanted && any(notEqual(value, vec3(0.0)))) {
    int at = int(radiance_texel(slot, lane));
    radiance[at].rgb = texelFetch(radiance_texels, at).rgb + value;
  }
}

// Whether a lane's light is to be added. What is not finite is refused and counted.
bool radiance_wanted(uint lane, vec3 value) {
  bool wanted = lane < k_no_lane, finite = is_finite(value);
  if (wanted && !finite) atomicAdd(counters[k_counter_dropped], 1u);
  return wanted && finite;
}

#if LUCERNA_GROUP_SUMS
// To the light of a group. At most once a slot and dispatch, like the next.
void add_to_group(uint slot, uint group, vec3 value) {
  if (any(notEqual(value, vec3(0.0)))) {
    uint lit = groups_lit(slot), bit = 1u << group;
    radiance[radiance_texel(slot, k_component_count + group)].rgb =
        value + ((lit & bit) != 0u ? group_light(slot, group) : vec3(0.0));
    radiance[radiance_texel(slot, 0u)].a = uintBitsToFloat(lit | bit);
  }
}
// ... of two that are not the same, or of one where b is zero.
void add_to_groups(uint slot, uint group_a, vec3 a, uint group_b, vec3 b) {
  uint lit = groups_lit(slot);
  uint bit_a = any(notEqual(a, vec3(0.0))) ? 1u << group_a : 0u, bit_b = any(notEqual(b, vec3(0.0))) ? 1u << group_b : 0u;
  if (bit_a != 0u)
    radiance[radiance_texel(slot, k_component_count + group_a)].rgb =
        a + ((lit & bit_a) != 0u ? group_light(slot, group_a) : vec3(0.0));
  if (bit_b != 0u)
    radiance[radiance_texel(slot, k_component_count + group_b)].rgb =
        b + ((lit & bit_b) != 0u ? group_light(slot, group_b) : vec3(0.0));
  if ((bit_a | bit_b) != 0u) radiance[radiance_texel(slot, 0u)].a = uintBitsToFloat(lit | bit_a | bit_b);
}
// Light of two lanes of one group, which may be the same. At most once a slot and dispatch, like the next.
void add_radiance_of_group(uint slot, uint lane_a, vec3 a, uint lane_b, vec3 b) {
  bool same = lane_a == lane_b;
  vec3 both = a + b;
  a = same ? both : a;
  b = same ? vec3(0.0) : b;
  bool wanted_a = radiance_wanted(lane_a, a), wanted_b = radiance_wanted(lane_b, b);
  vec3 of_group = (wanted_a ? a : vec3(0.0)) + (wanted_b ? b : vec3(0.0));
  add_to_radiance(slot, lane_a % k_component_count, wanted_a, a);
  add_to_radiance(slot, lane_b % k_component_count, wanted_b, b);
  add_to_group(slot, (wanted_a ? lane_a : lane_b) / k_component_count, of_group);
}
// ... of two groups and one component.
void add_radiance_of_component(uint slot, uint lane_a, vec3 a, uint lane_b, vec3 b) {
  bool wanted_a = radiance_wanted(lane_a, a), wanted_b = radiance_wanted(lane_b, b);
  a = wanted_a ? a : vec3(0.0);
  b = wanted_b ? b : vec3(0.0);
  add_to_radiance(slot, (wanted_a ? lane_a : lane_b) % k_component_count, wanted_a || wanted_b, a + b);
  add_to_groups(slot, lane_a / k_component_count, a, lane_b / k_component_count, b);
}
// ... of two lanes, and what is found by component and by group.
void add_radiance_found(uint slot, uint lane_a, vec3 a, uint lane_b, vec3 b, vec3 found[k_component_count],
                        vec3 found_by_group[k_group_count]) {
  bool wanted_a = radiance_wanted(lane_a, a), wanted_b = radiance_wanted(lane_b, b);
  a = wanted_a ? a : vec3(0.0);
  b = wanted_b ? b : vec3(0.0);
  for (uint c = 0u; c < k_component_count; ++c) {
    vec3 value = found[c] + (lane_a % k_component_count == c ? a : vec3(0.0)) + (lane_b % k_component_count == c ? b : vec3(0.0));
    bool finite = is_finite(value);
    if (!finite) atomicAdd(counters[k_counter_dropped], 1u);
    add_to_radiance(slot, c, finite, value);
  }
  uint group_a = lane_a / k_component_count, group_b = lane_b / k_component_count;
  vec3 all = vec3(0.0);
  [[unroll]] for (uint g = 0u; g < k_group_count; ++g) all += abs(found_by_group[g]);
  bool any_found = any(notEqual(all, vec3(0.0)));
  uint lit = groups_lit(slot), bits = 0u;
  // A loop, because a branch saves no work on lavapipe, and few vertices look anything up.
  for (uint once = 0u; once < (any_found ? 1u : 0u); ++once) {
    [[unroll]] for (uint g = 0u; g < k_group_count; ++g) {
      vec3 value = found_by_group[g] + (group_a == g ? a : vec3(0.0)) + (group_b == g ? b : vec3(0.0));
      if (is_finite(value) && any(notEqual(value, vec3(0.0)))) {
        radiance[radiance_texel(slot, k_component_count + g)].rgb = value + ((lit >> g & 1u) != 0u ? group_light(slot, g) : vec3(0.0));
        bits |= 1u << g;
      }
    }
    radiance[radiance_texel(slot, 0u)].a = uintBitsToFloat(lit | bits);
  }
  bool same = group_a == group_b;
  a = any_found ? vec3(0.0) : a + (same ? b : vec3(0.0));
  b = any_found || same ? vec3(0.0) : b;
  add_to_groups(slot, group_a, a, group_b, b);
}
void add_radiance(uint slot, uint lane, vec3 value) {
  bool wanted = radiance_wanted(lane, value);
  add_to_radiance(slot, lane % k_component_count, wanted, value);
  add_to_group(slot, lane / k_component_count, wanted ? value : vec3(0.0));
}
#else
// At most once a lane, slot and dispatch.
void add_radiance(uint slot, uint lane, vec3 value) { add_to_radiance(slot, lane, radiance_wanted(lane, value), value); }
// Light of two lanes of one group, which may be the same.
void add_radiance_of_group(uint slot, uint lane_a, vec3 a, uint lane_b, vec3 b) {
  bool same = lane_a == lane_b;
  add_radiance(slot, lane_a, a + (same ? b : vec3(0.0)));
  add_radiance(slot, same ? k_no_lane : lane_b, b);
}
// ... of two groups and one component.
void add_radiance_of_component(uint slot, uint lane_a, vec3 a, uint lane_b, vec3 b) {
  add_radiance(slot, lane_a, a);
  add_radiance(slot, lane_b, b);
}
#endif

#if LUCERNA_LOOKUP_BIAS
// VertexOut.bias; at most once a slot and dispatch. What is not finite is left out, and the light that it is of is refused.
void add_lookup_bias(uint slot, float value) {
  int at = int(radiance_texel(slot, 1u));
  if (value != 0.0 && is_finite(vec3(value))) radiance[at].a = texelFetch(radiance_texels, at).a + value;
}
#endif

#endif
