// Buffers and push constants that the wavefront's kernels share.
#ifndef LUCERNA_LIB_WAVEFRONT
#define LUCERNA_LIB_WAVEFRONT
#include "lib/frame.glsl"
#include "lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { TransportPush push; };

layout(scalar) buffer Rays { Ray rays[]; };
layout(scalar) buffer Hits { Hit hits[]; };
layout(scalar) buffer Queue { uint queue[]; };
layout(scalar) buffer NextQueue { uint next_queue[]; };
layout(scalar) buffer Paths { PathState paths[]; };
layout(scalar) buffer Radiance { vec3 radiance[]; };      // slot * k_component_count + component
layout(scalar) buffer Features { vec4 features[]; };      // slot * 2: (albedo, hit 0/1) (normal, depth)
layout(scalar) buffer ShadowStates { ShadowState shadow_states[]; };
layout(scalar) buffer Counters { uint counters[]; };

void add_radiance(uint slot, uint component, vec3 value) {
  if (component >= k_component_count) return;
  if (is_finite(value)) {
    radiance[slot * k_component_count + component] += value;
  } else {
    atomicAdd(counters[k_counter_dropped], 1u);
  }
}

#endif
