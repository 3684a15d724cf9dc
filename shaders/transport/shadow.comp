// Shadow rays that hit no opaque surface deliver their light. In scenes with transparent surfaces (LUCERNA_TRANSPARENT) the
// ray first passes them one by one: the queue of unfinished rays is traced again.
#include "lib/variants.glsl"
#include "lib/wavefront.glsl"
#if LUCERNA_SPLATS_SUMMED
#include "transport/splat.glsl"
#endif
#if LUCERNA_LEARNED
#include "lib/frame.glsl"
#include "shaders/shared/learned_lights.h"
layout(scalar) writeonly buffer LightRecords { LightRecord light_records[]; };
#endif
#include "lib/path_events.glsl"
#include "lib/layers.glsl"
#if LUCERNA_TRANSPARENT
#include "lib/surface.glsl"
layout(scalar) buffer ShadowQueue { uint shadow_queue[]; };
#endif

#if LUCERNA_PATH_EVENTS
// The light sample has arrived. `number`: from 1; 0: not recorded.
void note_arrival(uint slot, uint number, vec3 light) {
  if (number == 0u) return;
  uint at = slot * path_event_frame.most + number - 1u;
  path_events[at].bits = path_events[at].bits & ~0xffu | k_path_light;
  path_events[at].contribution = light;
}
#endif

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = queue[index];
  Hit hit = load_hit(slot);
  ShadowState s = load_shadow_state(slot);
  bool blocked = hit.prim != k_no_hit;
#if LUCERNA_TRANSPARENT
  // Hits of non-opaque triangles; the first pass (push.round == 0) has tested the opaque ones.
  if (push.round == 0u) {
    if (!blocked) shadow_queue[queue_place(k_counter_shadow_next)] = slot;
    return;
  }
  if (blocked) {
    Ray ray = load_shadow_ray(slot);
    Surface surface = make_surface(ray, hit);
    float coverage = is_catcher(surface) ? 0.0 : surface_coverage(surface);
    vec3 undeflected = vec3(0.0);
#if LUCERNA_THIN_GLASS
    mat3 to_world = shading_frame(surface, -ray.direction);
    float mu = dot(to_world[2], -ray.direction);
    undeflected = bsdf_undeflected(surface_bsdf(surface, to_world, -ray.direction), mu);
#endif
    vec3 transmittance = vec3(1.0 - coverage) + coverage * undeflected;
    s.diffuse *= transmittance;
    s.glossy *= transmittance;
    if (max3(s.diffuse) + max3(s.glossy) > 0.0) {
      vec3 origin = offset_origin(surface, ray.direction);
      // The end point stays unchanged.
      ray.tmax -= ray.tmax < 1e30 ? dot(origin - ray.origin, ray.direction) : 0.0;
      ray.origin = origin;
      if (ray.tmax > 0.0) {
        store_shadow_ray(slot, ray);
        store_shadow_state(slot, s);
        shadow_queue[queue_place(k_counter_shadow_next)] = slot;
        return;
      }
    } else {
      return;
    }
  }
  blocked = false;
#endif
#if LUCERNA_SPLATS_SUMMED
  if (!blocked) add_splat(slot, s);
#else
#if LUCERNA_LEARNED
  for (uint once = 0u; once < (!blocked && frame.learning != 0u && s.tag > 0u ? 1u : 0u); ++once)
    light_records[s.tag - 1u].arrived = luminance(s.diffuse + s.glossy);
#endif
  if (!blocked) {
    add_radiance_of_group(slot, s.lanes & 0xffu, s.diffuse, (s.lanes >> 8) & 0xffu, s.glossy);
#if LUCERNA_WORD_LAYERS
    vec3 of_layers[LUCERNA_WORD_LAYERS];
    [[unroll]] for (uint l = 0u; l < LUCERNA_WORD_LAYERS; ++l)
      of_layers[l] = in_layer(l, layer_table.states[s.lanes >> 16 & 0xffu].accept, s.diffuse) +
                     in_layer(l, layer_table.states[s.lanes >> 24].accept, s.glossy);
    add_to_layers(slot, of_layers);
#endif
#if LUCERNA_PATH_EVENTS
    note_arrival(slot, s.tag & 0xffffu, s.diffuse);
    note_arrival(slot, s.tag >> 16, s.glossy);
#endif
  }
#endif
}
