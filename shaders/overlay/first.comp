// Finds the first surface on a ray through a pixel, passing holes of cut-out materials. Replaces transport/shade.comp
// (transport/wavefront.h, PathEnds::vertex), between overlay/centre.comp and overlay/first_keep.comp.
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
#if LUCERNA_ALPHA
  if (surface_coverage(surface) < 0.5) {
    path.bits += 1u << k_path_events_shift;
    if (path_depth(path) < frame.max_depth) queue_ray(slot, path, offset_origin(surface, ray.direction), ray.direction);
    return;
  }
#endif
  features[2u * slot] = vec4(surface.position, 1.0);
  features[2u * slot + 1u] = vec4(surface.front ? surface.normal_g : -surface.normal_g, 0.0);
}
