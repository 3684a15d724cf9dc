// The `compute-bvh` tracer: for each row of the queue, its ray's hit (see shaders/shared/ray.h for both).
//
// Defines: LUCERNA_QUERY = 0 closest, 1 any_opaque, 2 closest_non_opaque (see lucerna::bvh::Query);
// LUCERNA_NON_OPAQUE where the scene has non-opaque triangles; those of lib/bvh.glsl. With
// LUCERNA_COUNT_BVH the hit's u is the number of nodes visited and triangles tested.
#include "lib/variants.glsl"
#include "lib/invocation.glsl"
#include "shaders/shared/ray.h"
#include "shaders/shared/trace.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { TracePush push; };

uniform samplerBuffer ray_texels;  // Rays, 2 texels each: (origin, tmax) (direction, bits slot)
layout(scalar) writeonly buffer Hits { Hit hits[]; };
layout(scalar) readonly buffer Queue { uint queue[]; };

#include "lib/bvh.glsl"

void main() {
  uint row = global_index();
  bool inside = row < push.count;
  // Loads outside of control flow: a row too many reads the last one's ray and is dead.
  uint last = min(row, push.count - 1u);
  uint queued = queue[push.use_queue != 0u ? last : 0u];
  uint index = push.use_queue != 0u ? queued : last;
  vec4 a = texelFetch(ray_texels, int(2u * index)), b = texelFetch(ray_texels, int(2u * index + 1u));
  Ray ray = Ray(a.xyz, a.w, b.xyz, floatBitsToUint(b.w));
  ray.tmax = inside ? ray.tmax : 0.0;
  Hit hit = bvh_trace(ray, LUCERNA_QUERY);
#if LUCERNA_COUNT_BVH
  hit.u = float(bvh_visits);
#endif
  if (inside) hits[index] = hit;
}
