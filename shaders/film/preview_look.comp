// What rays through the picture's pixels show, in mirrors as well: the first surface that does not only mirror. In place of
// transport/shade.comp (transport/wavefront.h, PathEnds::vertex), from overlay/centre.comp to film/preview_sight.comp, which
// reads the features as k_sight_* says. What is seen in a mirror lies behind it, mirrored at its plane: there it moves as a
// surface does when the camera moves.
#include "lib/variants.glsl"
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "lib/surface.glsl"
#include "shaders/shared/preview.h"

bool emits(Surface surface) {
  bool any = false;
#if LUCERNA_EMISSIVE
  bool side = surface.front || (surface.flags & k_flag_double_sided) != 0u;
  any = side && (surface.flags & k_flag_emissive) != 0u && max3(surface.emission) > 0.0;
#endif
#if LUCERNA_UNLIT
  any = any || (surface.flags & k_flag_unlit) != 0u;
#endif
  return any;
}

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = push.use_queue != 0u ? queue[index] : index;
  Ray ray = load_ray(slot);
  Hit hit = load_hit(slot);
  PathState path = load_path(slot);
  if (path.pixel == 0xffffffffu || hit.prim == k_no_hit) return;
  Surface surface = make_surface(ray, hit);
  float travelled = path.travelled + hit.t;
  bool passed = false, mirrors = false;
#if LUCERNA_ALPHA
  passed = surface_coverage(surface) < 0.5;
#endif
  vec3 normal = surface.front ? surface.normal_s : -surface.normal_s, direction = ray.direction;
#if LUCERNA_SPECULAR
  if (!passed && !emits(surface) && surface.parameters.transmission == 0.0 && path_depth(path) < frame.max_depth) {
    vec3 wo = -ray.direction * shading_frame(surface, -ray.direction);  // transposed
    Bsdf bsdf = make_bsdf(surface.parameters, wo.z);
    direction = reflect(ray.direction, normal);
    mirrors = bsdf.delta && max3(bsdf.diffuse + bsdf.transmitted) <= 0.0 &&
              dot(direction, surface.front ? surface.normal_g : -surface.normal_g) > 0.0;
  }
#endif
  bool mirrored = path_depth(path) > 0u;
  if (!passed && !mirrors) {
    vec3 first = camera_direction(camera_shift(vec2(path.pixel % frame.width, path.pixel / frame.width) + 0.5)), turned = first - ray.direction;
    if ((path_depth(path) & 1u) != 0u && dot(turned, turned) > 0.0) normal = reflect(normal, normalize(turned));
    float found = float(k_sight_met | (mirrored ? k_sight_mirrored : 0u) | (emits(surface) ? k_sight_emits : 0u));
    features[2u * slot] = vec4(path.throughput * surface.parameters.base, found);
    features[2u * slot + 1u] = vec4(normal, travelled * dot(first, frame.camera_forward));
    return;
  }
  if (mirrors) {
    path.throughput *= surface.parameters.base;
    path.bits += 1u << k_path_events_shift;
    features[2u * slot] = vec4(0.0, 0.0, 0.0, float(k_sight_mirrored));
  } else {
    direction = ray.direction;
  }
  path.travelled = travelled;
  rays[slot].origin = offset_origin(surface, direction);
  rays[slot].direction = direction;
  store_path(slot, path);
  next_queue[atomicAdd(counters[k_counter_next], 1u)] = slot;
  atomicAdd(counters[k_counter_rays + automaton_account(path_automaton(path))], 1u);
}
