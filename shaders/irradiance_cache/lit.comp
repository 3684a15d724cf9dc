// For every point of the screen-space stage: irradiance from the present records, its noise, and the distance of the nearest
// record that serves.
#include "lib/invocation.glsl"
#include "irradiance_cache/lookup.glsl"
#include "shaders/shared/irradiance_cache/discontinuity.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LitPush push; };
uniform samplerBuffer surface_texels;
layout(scalar) writeonly buffer Lit { vec3 lit[]; };  // luminance (-1: no record serves, -2: paths gather); distance of the nearest record [m]; standard error

void main() {
  uint point = global_index();
  if (point >= push.count) return;
  vec4 place = texelFetch(surface_texels, int(point * k_surface_texels));
  vec4 seen = texelFetch(surface_texels, int(point * k_surface_texels + 1u));
  vec3 normal = seen.xyz;
  bool solid = place.w >= 0.0;
  Cached found = cache_lookup(place.xyz, normal, normal, floatBitsToUint(seen.w) >> k_surface_media_shift, solid, 0.0);
  float light = 0.0, nearest = k_infinity, weights = 0.0, variance = 0.0;
  for (uint p = 0u; p < k_part_count; ++p) light += luminance(found.part[p]);
  OctreeRange range = cache_range(place.xyz, solid && found.weight > 0.0);
  for (uint i = range.first; i < range.last; ++i) {
    uint record = octree_sphere(i);
    int at = int(record * k_record_texels);
    vec4 centre = texelFetch(record_texels, at), facing = texelFetch(record_texels, at + 1);
    float weight = record_weight(place.xyz, normal, centre, facing, record_shape(record, centre));
    if (weight > 0.0) nearest = min(nearest, distance(place.xyz, centre.xyz));
    if (record_crowded(record)) continue;
    weights += weight;
    variance += square(weight * texelFetch(record_texels, at + 2).z);
  }
  lit[point] = vec3(found.weight > 0.0 ? light : found.guide != k_no_guide ? -2.0 : -1.0, nearest, weights > 0.0 ? sqrt(variance) / weights : 0.0);
}
