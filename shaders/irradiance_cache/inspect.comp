// Lists the records that serve the surface of one pixel with their weights, and the record whose disc is drawn there. One
// invocation. Uses the lookup functions themselves, so it reports exactly what lookups use.
#include "lib/invocation.glsl"
#include "irradiance_cache/lookup.glsl"
#include "irradiance_cache/seen.glsl"
#include "overlay/lookup_place.glsl"
#include "shaders/shared/irradiance_cache/inspect.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { InspectPush push; };
layout(scalar) buffer Inspection {
  InspectHeader header;
  InspectServing serving[];
};

void main() {
  if (global_index() > 0u) return;
  Seen seen = seen_at(push.pixel, push.width, push.height);
  LookupPlace a = lookup_place(push.pixel, push.width, push.grid, seen);
  if (a.diffuse) seen.position = a.position, seen.normal = a.normal;
  uint count = 0u, under = k_no_record;
  Nearest nearest = nothing_near();
  float nearest_disc = k_infinity;
  vec3 under_at = vec3(0.0);
  OctreeRange range = cache_range(seen.position, seen.solid);
  for (uint i = range.first; i < range.last; ++i) {
    uint record = octree_sphere(i);
    int at = int(record * k_record_texels);
    vec4 place = texelFetch(record_texels, at), facing = texelFetch(record_texels, at + 1);
    vec4 shape = record_shape(record, place);
    float weight = a.answerable ? record_weight(seen.position, seen.normal, place, facing, shape) : 0.0;
    vec3 centre = to_picture(place.xyz, push.width, push.height);
    bool crowds = weight > 0.0 && record_crowded(record);
    nearest = nearer(nearest, weight, seen.position - place.xyz, crowds);
    if (weight > 0.0 && !crowds) {
      if (count < k_inspect_most) serving[count] = InspectServing(record, weight, centre.xy, centre.z);
      ++count;
    }
    float from = distance(seen.position, place.xyz);
    if (from < nearest_disc && seen_on_disc(seen, place, facing, shape)) {
      nearest_disc = from;
      under = record;
      under_at = centre;
    }
  }
  bool gathers = paths_gather(nearest);
  if (gathers) count = 0u;
  uint lookup = a.answerable ? k_lookup_possible : a.diffuse ? k_lookup_too_steep : k_lookup_none;
  header = InspectHeader(seen.solid ? 1u : 0u, lookup, count, gathers ? 1u : 0u, under, seen.size, seen.depth, seen.position, seen.normal, under_at);
}
