// What rays through the picture's pixels show through glass and in mirrors: they go straight on, are refracted or mirrored,
// whichever is most of the light, until they meet a surface that scatters light diffusely. In place of transport/shade.comp
// (transport/wavefront.h, PathEnds::vertex), from overlay/centre.comp to overlay/look_keep.comp.
#include "lib/variants.glsl"
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "lib/surface.glsl"

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = push.use_queue != 0u ? queue[index] : index;
  Ray ray = load_ray(slot);
  Hit hit = load_hit(slot);
  PathState path = load_path(slot);
  if (path.pixel == 0xffffffffu || hit.prim == k_no_hit) return;
  Surface surface = make_surface(ray, hit);
  vec3 wo_world = -ray.direction;
  mat3 to_world = shading_frame(surface, wo_world);
  vec3 wo = wo_world * to_world;   // transposed
  Bsdf bsdf = make_bsdf(surface.parameters, wo.z);
  bool passed = false;
#if LUCERNA_ALPHA
  passed = surface_coverage(surface) < 0.5;
#endif
#if LUCERNA_THIN_GLASS
  passed = passed || bsdf_straight_probability(bsdf, wo.z) > 0.5;
#endif
  if (!passed && max3(bsdf.diffuse_albedo + bsdf.transmitted_albedo) > 0.0) {
    features[2u * slot] = vec4(surface.position, 1.0);
    features[2u * slot + 1u] = vec4(surface.front ? surface.normal_g : -surface.normal_g, float(path.nulls));
    return;
  }
  if (path_depth(path) >= frame.max_depth) return;
  vec3 direction = ray.direction;
  bool go_on = passed;
  if (!passed) {
    BsdfSample b = bsdf_sample(bsdf, wo, vec2(0.0, 0.5), vec2(0.5));
    direction = normalize(to_world * b.wi);
    vec3 side = surface.front ? surface.normal_g : -surface.normal_g;
    // What is rough shows no surface.
    go_on = b.event == k_event_specular && (dot(direction, side) > 0.0) == !b.transmitted && max3(b.weight) > 0.0;
    path.nulls = 1u;  // not straight any more
  }
  path.bits += 1u << k_path_events_shift;
  if (!go_on) return;
  rays[slot].origin = offset_origin(surface, direction);
  rays[slot].direction = direction;
  store_path(slot, path);
  next_queue[atomicAdd(counters[k_counter_next], 1u)] = slot;
  atomicAdd(counters[k_counter_rays + automaton_account(path_automaton(path))], 1u);
}
