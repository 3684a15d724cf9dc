// Finds the surfaces that the picture's pixels show, also in mirrors and through glass: the first surface that does not only
// mirror or refract. Rays follow the strongest lobe. Replaces transport/shade.comp (transport/wavefront.h, PathEnds::vertex),
// between overlay/centre.comp and film/preview_sight.comp, which reads the features (k_sight_*). A surface seen in a mirror is
// placed behind it, mirrored at its plane; one seen through glass at its undeflected position. There it moves approximately as
// a surface does when the camera moves.
#include "lib/variants.glsl"
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "lib/sight.glsl"
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
  SightStep on = sight_step(surface, ray.direction);
  if (!on.cut_out && emits(surface)) on.undeflected = on.turned = false;
  on.turned = on.turned && path_depth(path) < frame.max_depth;
  if (!on.undeflected && !on.turned) {
    vec3 normal = surface.front ? surface.normal_s : -surface.normal_s;
    vec3 first = camera_direction(camera_shift(vec2(path.pixel % frame.width, path.pixel / frame.width) + 0.5)), turned = first - ray.direction;
    if ((path.nulls & 1u) != 0u && dot(turned, turned) > 0.0) normal = reflect(normal, normalize(turned));
    float found = float(k_sight_met | (path_depth(path) > 0u ? k_sight_beyond : 0u) | (emits(surface) ? k_sight_emits : 0u));
    features[2u * slot] = vec4(path.throughput * surface.parameters.base, found + k_sight_mirrors * on.mirrors);
    features[2u * slot + 1u] = vec4(normal, camera_depth(travelled * first));
    return;
  }
  if (!on.cut_out) path.throughput *= surface.parameters.base;
  if (on.turned) {
    path.bits += 1u << k_path_events_shift;
    path.nulls += on.mirrored ? 1u : 0u;  // here: number of mirrors
    features[2u * slot] = vec4(0.0, 0.0, 0.0, float(k_sight_beyond));
  }
  path.travelled = travelled;
  queue_ray(slot, path, offset_origin(surface, on.direction), on.direction);
}
