// Finds the surfaces that the picture's pixels show through glass and in mirrors: rays pass undeflected, are refracted or
// mirrored, whichever lobe is strongest, until they hit a diffuse surface. Replaces transport/shade.comp
// (transport/wavefront.h, PathEnds::vertex), between overlay/centre.comp and overlay/look_keep.comp.
#include "lib/variants.glsl"
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "lib/sight.glsl"

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = push.use_queue != 0u ? queue[index] : index;
  Ray ray = load_ray(slot);
  Hit hit = load_hit(slot);
  PathState path = load_path(slot);
  if (path.pixel == 0xffffffffu || hit.prim == k_no_hit) return;
  Surface surface = make_surface(ray, hit);
  SightStep on = sight_step(surface, ray.direction);
  if (on.diffuse) {
    features[2u * slot] = vec4(surface.position, 1.0);
    features[2u * slot + 1u] = vec4(surface.front ? surface.normal_g : -surface.normal_g, float(path.nulls));
    return;
  }
  if (path_depth(path) >= frame.max_depth) return;
  if (!on.undeflected) path.nulls = 1u;  // deflected
  path.bits += 1u << k_path_events_shift;
  if (!on.undeflected && !on.turned) return;
  queue_ray(slot, path, offset_origin(surface, on.direction), on.direction);
}
