// Shared by the wavefront's kernels: queues, counters, and the state of the paths in flight.
//
// State is read through texel buffers (RGBA32F; integers as bit patterns) and written as storage buffers of four words. On
// lavapipe a masked storage-buffer access is a scalar loop over the lanes, one per store of any width, and these loops took
// half of the shading time of a plain scene; a texel fetch is a vector operation (an image store is slower than either).
// Within one dispatch one invocation accesses a slot, and reads it before it writes it.
#ifndef LUCERNA_LIB_WAVEFRONT
#define LUCERNA_LIB_WAVEFRONT
#include "lib/variants.glsl"
#include "lib/frame.glsl"
#include "lib/invocation.glsl"
#include "lib/radiance.glsl"

layout(local_size_x = 64) in;
// Kernels that start or end paths define LUCERNA_PUSH first, as the name of their push structure.
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
layout(scalar) writeonly buffer Rays { uvec4 rays[]; };    // store_ray()
layout(scalar) writeonly buffer Paths { uvec4 paths[]; };  // store_path()
layout(scalar) writeonly buffer Radiance { vec4 radiance[]; };
layout(scalar) writeonly buffer Features { vec4 features[]; };  // 2 a slot: (albedo, hit 0/1) (normal, depth)
layout(scalar) writeonly buffer ShadowRays { uvec4 shadow_rays[]; };
layout(scalar) writeonly buffer ShadowStates { uvec4 shadow_states[]; };

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
  return ShadowState(a.xyz, floatBitsToUint(a.w), b.xyz, floatBitsToUint(b.w));
}
uvec4 words(vec3 a, float b) { return floatBitsToUint(vec4(a, b)); }
uvec4 words(vec3 a, uint b) { return uvec4(floatBitsToUint(a), b); }
void store_ray(uint slot, Ray r) {
  rays[2u * slot] = words(r.origin, r.tmax);
  rays[2u * slot + 1u] = words(r.direction, r.slot);
}
void store_path(uint slot, PathState p) {
  paths[3u * slot] = words(p.throughput, p.pdf);
  paths[3u * slot + 1u] = uvec4(p.pixel, p.sample_index, p.bits, p.media);
  paths[3u * slot + 2u] = uvec4(floatBitsToUint(p.travelled), floatBitsToUint(p.eta_scale), p.nulls, p.light_group);
}
void store_shadow_ray(uint slot, Ray r) {
  shadow_rays[2u * slot] = words(r.origin, r.tmax);
  shadow_rays[2u * slot + 1u] = words(r.direction, r.slot);
}
void store_shadow_state(uint slot, ShadowState s) {
  shadow_states[2u * slot] = words(s.diffuse, s.lanes);
  shadow_states[2u * slot + 1u] = words(s.glossy, s.tag);
}

// Reserves a place in a queue of length counters[length] for each invocation that gets here; counted by `component` in
// counters[by_component ...]. Concurrent invocations share one atomic addition: separate ones took a tenth of the shading
// time.
uint queue_place(uint length, uint by_component, uint component) {
#if LUCERNA_SUBGROUPS
  uint mine = 1u << 8u * component;  // a byte a component
  uint all = subgroupAdd(mine), before = subgroupExclusiveAdd(mine);
  uvec4 each = uvec4(all, all >> 8, all >> 16, all >> 24) & 0xffu, each_before = uvec4(before, before >> 8, before >> 16, before >> 24) & 0xffu;
  uint first = 0u;
  if (subgroupElect()) first = atomicAdd(counters[length], each.x + each.y + each.z + each.w);
  // The first invocation of each component adds for all of them.
  if ((before >> 8u * component & 0xffu) == 0u) atomicAdd(counters[by_component + component], all >> 8u * component & 0xffu);
  return subgroupBroadcastFirst(first) + each_before.x + each_before.y + each_before.z + each_before.w;
#else
  atomicAdd(counters[by_component + component], 1u);
  return atomicAdd(counters[length], 1u);
#endif
}
// Likewise, not counted by component.
uint queue_place(uint length) {
#if LUCERNA_SUBGROUPS
  uint all = subgroupAdd(1u), before = subgroupExclusiveAdd(1u), first = 0u;
  if (subgroupElect()) first = atomicAdd(counters[length], all);
  return subgroupBroadcastFirst(first) + before;
#else
  return atomicAdd(counters[length], 1u);
#endif
}
// Counts the invocations that get here.
void count_one(uint counter) {
#if LUCERNA_SUBGROUPS
  uint all = subgroupAdd(1u);
  if (subgroupElect()) atomicAdd(counters[counter], all);
#else
  atomicAdd(counters[counter], 1u);
#endif
}
// Appends a path's next ray to the queue.
void queue_ray(uint slot, PathState p, vec3 origin, vec3 direction) {
  next_queue[queue_place(k_counter_next, k_counter_rays, automaton_account(path_automaton(p)))] = slot;
  store_ray(slot, Ray(origin, k_infinity, direction, slot));
  store_path(slot, p);
}

// Sets zero light, of no group.
void clear_radiance(uint slot) {
#if LUCERNA_GROUP_SUMS
  for (uint c = 0u; c < k_component_count; ++c) radiance[radiance_texel(slot, c)] = vec4(0.0);
#else
  for (uint lane = 0u; lane < k_lane_count; ++lane) radiance[radiance_texel(slot, lane)].rgb = vec3(0.0);
#endif
}

// Adds to a texel of the path's radiance. At most once per texel and dispatch (see above).
void add_to_radiance(uint slot, uint lane, bool wanted, vec3 value) {
  if (wanted && any(notEqual(value, vec3(0.0)))) {
    int at = int(radiance_texel(slot, lane));
    radiance[at].rgb = texelFetch(radiance_texels, at).rgb + value;
  }
}

// True if a lane's light is added. Non-finite light is refused and counted.
bool radiance_wanted(uint lane, vec3 value) {
  bool wanted = lane < k_no_lane, finite = is_finite(value);
  if (wanted && !finite) atomicAdd(counters[k_counter_dropped], 1u);
  return wanted && finite;
}

#if LUCERNA_GROUP_SUMS
// Adds to the light of a group. At most once per slot and dispatch, like the next.
void add_to_group(uint slot, uint group, vec3 value) {
  if (any(notEqual(value, vec3(0.0)))) {
    uint lit = groups_lit(slot), bit = 1u << group;
    radiance[group_texel(slot, group)].rgb =
        value + ((lit & bit) != 0u ? group_light(slot, group) : vec3(0.0));
    radiance[radiance_texel(slot, 0u)].a = uintBitsToFloat(lit | bit);
  }
}
// ... of two different groups, or of one with b zero.
void add_to_groups(uint slot, uint group_a, vec3 a, uint group_b, vec3 b) {
  uint lit = groups_lit(slot);
  uint bit_a = any(notEqual(a, vec3(0.0))) ? 1u << group_a : 0u, bit_b = any(notEqual(b, vec3(0.0))) ? 1u << group_b : 0u;
  if (bit_a != 0u)
    radiance[group_texel(slot, group_a)].rgb =
        a + ((lit & bit_a) != 0u ? group_light(slot, group_a) : vec3(0.0));
  if (bit_b != 0u)
    radiance[group_texel(slot, group_b)].rgb =
        b + ((lit & bit_b) != 0u ? group_light(slot, group_b) : vec3(0.0));
  if ((bit_a | bit_b) != 0u) radiance[radiance_texel(slot, 0u)].a = uintBitsToFloat(lit | bit_a | bit_b);
}
// Adds light of two lanes of one group, which may be equal. At most once per slot and dispatch, like the next.
void add_radiance_of_group(uint slot, uint lane_a, vec3 a, uint lane_b, vec3 b) {
  bool same = lane_a == lane_b;
  vec3 both = a + b;
  a = same ? both : a;
  b = same ? vec3(0.0) : b;
  bool wanted_a = radiance_wanted(lane_a, a), wanted_b = radiance_wanted(lane_b, b);
  vec3 of_group = (wanted_a ? a : vec3(0.0)) + (wanted_b ? b : vec3(0.0));
  add_to_radiance(slot, component_of_lane(lane_a), wanted_a, a);
  add_to_radiance(slot, component_of_lane(lane_b), wanted_b, b);
  add_to_group(slot, group_of_lane(wanted_a ? lane_a : lane_b), of_group);
}
// ... of two groups and one component.
void add_radiance_of_component(uint slot, uint lane_a, vec3 a, uint lane_b, vec3 b) {
  bool wanted_a = radiance_wanted(lane_a, a), wanted_b = radiance_wanted(lane_b, b);
  a = wanted_a ? a : vec3(0.0);
  b = wanted_b ? b : vec3(0.0);
  add_to_radiance(slot, component_of_lane(wanted_a ? lane_a : lane_b), wanted_a || wanted_b, a + b);
  add_to_groups(slot, group_of_lane(lane_a), a, group_of_lane(lane_b), b);
}
// ... of two lanes, and looked-up light by component and by group.
void add_radiance_found(uint slot, uint lane_a, vec3 a, uint lane_b, vec3 b, vec3 found[k_component_count],
                        vec3 found_by_group[k_group_count]) {
  bool wanted_a = radiance_wanted(lane_a, a), wanted_b = radiance_wanted(lane_b, b);
  a = wanted_a ? a : vec3(0.0);
  b = wanted_b ? b : vec3(0.0);
  for (uint c = 0u; c < k_component_count; ++c) {
    vec3 value = found[c] + (component_of_lane(lane_a) == c ? a : vec3(0.0)) + (component_of_lane(lane_b) == c ? b : vec3(0.0));
    bool finite = is_finite(value);
    if (!finite) atomicAdd(counters[k_counter_dropped], 1u);
    add_to_radiance(slot, c, finite, value);
  }
  uint group_a = group_of_lane(lane_a), group_b = group_of_lane(lane_b);
  vec3 all = vec3(0.0);
  [[unroll]] for (uint g = 0u; g < k_group_count; ++g) all += abs(found_by_group[g]);
  bool any_found = any(notEqual(all, vec3(0.0)));
  uint lit = groups_lit(slot), bits = 0u;
  // A loop instead of a branch: on lavapipe a branch saves no work, and few vertices have lookups.
  for (uint once = 0u; once < (any_found ? 1u : 0u); ++once) {
    [[unroll]] for (uint g = 0u; g < k_group_count; ++g) {
      vec3 value = found_by_group[g] + (group_a == g ? a : vec3(0.0)) + (group_b == g ? b : vec3(0.0));
      if (is_finite(value) && any(notEqual(value, vec3(0.0)))) {
        radiance[group_texel(slot, g)].rgb = value + ((lit >> g & 1u) != 0u ? group_light(slot, g) : vec3(0.0));
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
  add_to_radiance(slot, component_of_lane(lane), wanted, value);
  add_to_group(slot, group_of_lane(lane), wanted ? value : vec3(0.0));
}
#else
// At most once per lane, slot and dispatch.
void add_radiance(uint slot, uint lane, vec3 value) { add_to_radiance(slot, lane, radiance_wanted(lane, value), value); }
// Adds light of two lanes of one group, which may be equal.
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
// Adds VertexOut.bias; at most once per slot and dispatch. Non-finite values are omitted, with their light.
void add_lookup_bias(uint slot, float value) {
  int at = int(radiance_texel(slot, 1u));
  if (value != 0.0 && is_finite(vec3(value))) radiance[at].a = texelFetch(radiance_texels, at).a + value;
}
#endif

#endif
