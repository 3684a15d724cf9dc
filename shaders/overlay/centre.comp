// Source of paths that find visible surfaces: a ray through the centre of every pixel, or of every point of a grid.
#define LUCERNA_PUSH SeePush
#include "shaders/shared/sight.h"
#include "lib/wavefront.glsl"
#include "lib/media.glsl"

void main() {
  uint slot = global_index();
  if (slot >= push.count) return;
  uint point = push.first + slot;
  uvec2 at = uvec2(point % push.across, point / push.across) * push.stride + push.stride / 2u;
  uvec2 xy = min(at, uvec2(frame.width, frame.height) - 1u);
  vec3 shift = camera_shift(vec2(xy) + 0.5);
  Ray ray;
  ray.origin = camera_start(shift);
  ray.direction = camera_direction(shift);
  ray.tmax = camera_covers(shift) ? k_infinity : -1.0;
  float cut = section_distance(ray.origin, ray.direction);
  if (cut >= k_infinity)
    ray.tmax = -1.0, cut = 0.0;
  else
    ray.origin += cut * ray.direction;
  ray.slot = slot;
  store_ray(slot, ray);
  PathState p;
  p.throughput = vec3(1.0);
  p.pdf = 0.0;
  p.pixel = xy.y * frame.width + xy.x;
  p.sample_index = 0u;
  p.bits = 0u;
  p.media = 0u;
#if LUCERNA_VOLUMES
  for (uint once = 0u; once < frame.camera_in_solids; ++once) p.media = media_at(ray.origin, p.pixel);
#endif
  p.travelled = cut;
  p.eta_scale = 1.0;
  p.nulls = 0u;
  p.light_group = 0u;
  store_path(slot, p);
  clear_radiance(slot);
  features[2u * slot] = vec4(0.0);
  features[2u * slot + 1u] = vec4(0.0);
}
