// Path source `light`: one light path for each slot of a batch.
#define LUCERNA_PUSH EmitPush
#include "shaders/shared/emission.h"
#include "lib/wavefront.glsl"
#include "lib/emission.glsl"

layout(scalar) buffer LightPathCounts { uint light_path_counts[]; };

void main() {
  uint slot = global_index();
  if (slot >= push.count) return;
  uint index = push.first + slot;
  Ray ray;
  ray.origin = vec3(0.0);
  ray.direction = vec3(0.0, 0.0, 1.0);
  ray.tmax = -1.0;
  ray.slot = slot;
  vec3 flux = vec3(0.0);
  uint group = 0u;
  float over_radiance = 0.0, sampling = 0.0;
#if LUCERNA_LIGHTS
  Sampler random = make_light_sampler(index, push.round, frame.seed);
  Emission e = sample_emission(random, push.step);
  flux = e.flux * push.share;
  group = e.group;
#if LUCERNA_LIGHT_GROUPS <= 1
  // Group number: for lamps their index, for adjacent triangles their cluster.
  group = emission.casters > 0u ? floatBitsToUint(texelFetch(emission_groups, int(emission.groups + e.light)).x) : e.light;
  group &= k_most_groups - 1u;
#endif
  bool finite = is_finite(flux);
  if (!finite) atomicAdd(counters[k_counter_dropped], 1u);
  bool lit = finite && max3(flux) > 0.0;
  if (!lit) atomicAdd(light_path_counts[k_light_paths_dark], 1u);
  ray.origin = e.origin;
  ray.direction = e.direction;
  ray.tmax = lit ? k_infinity : -1.0;
  flux = lit ? flux : vec3(0.0);
  over_radiance = e.radiance > 0.0 ? luminance(flux) / e.radiance : 0.0;
  // Negative for distant light.
  sampling = (e.afar ? -1.0 : 1.0) * e.sampling / push.share;
#endif
  store_ray(slot, ray);
  PathState p;
  p.throughput = flux;
  p.pdf = over_radiance;
  p.pixel = max3(flux) > 0.0 ? index : 0xffffffffu;
  p.sample_index = push.round;
  p.bits = 1u << k_path_events_shift;  // emission uses the random numbers of depth 0
  p.media = 0u;
#if LUCERNA_VOLUMES && LUCERNA_LIGHTS
  // Distant light starts outside all media.
  for (uint once = e.afar || !lit ? 1u : 0u; once < 1u; ++once) p.media = media_at(e.origin, hash_combine(index, push.round));
#endif
  p.travelled = 0.0;
  p.eta_scale = sampling;
  p.nulls = 0u;
  p.light_group = group;
  store_path(slot, p);
}
