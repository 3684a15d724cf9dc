// Draws records on the visible surfaces: each record's disc of validity with a mark at its centre, and the number of records
// that serve a pixel as a heat map. Discs use the film's depth, so that hidden ones stay hidden.
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "irradiance_cache/lookup.glsl"
#include "irradiance_cache/seen.glsl"
#include "overlay/lookup_place.glsl"
#include "irradiance_cache/ink.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OverlayPush push; };
layout(scalar) buffer Picture { uint picture[]; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  Seen seen = seen_at(pixel, push.width, push.height);

  LookupPlace a = lookup_place(pixel, push.width, push.grid, seen);
  uint overlap = 0u;
  Nearest nearest = nothing_near();
  vec4 over = vec4(0.0);  // premultiplied
  OctreeRange range = cache_range(a.diffuse ? a.position : seen.position, a.diffuse || seen.solid);
  for (uint i = range.first; i < range.last; ++i) {
    uint record = octree_sphere(i);
    int at = int(record * k_record_texels);
    vec4 place = texelFetch(record_texels, at), facing = texelFetch(record_texels, at + 1);
    vec4 shape = record_shape(record, place);
    float weight = a.answerable ? record_weight(a.position, a.normal, place, facing, shape) : 0.0;
    bool crowds = record_crowded(record);
    nearest = nearer(nearest, weight, a.position - place.xyz, crowds);
    overlap += weight > 0.0 && !crowds ? 1u : 0u;
    float from = distance(seen.position, place.xyz), reach = seen_reach(seen, place, shape);
    vec3 ink = crowds ? k_gathered_ink : record_ink(record, push.color, push.lo, push.hi);
    // Discs of a few pixels fade: many distant ones would look like fog.
    float strength = clamp((shape.w / seen.size - 2.0) / 8.0, 0.2, 1.0);
    float rim = clamp(1.25 - abs(reach - 0.5 * seen.size - from) / seen.size, 0.0, 1.0) * 0.8 * strength;
    float dot_ = clamp(2.0 - from / seen.size, 0.0, 1.0) * max(strength, 0.5);
    float inside = from < reach ? 0.06 : 0.0;
    float alpha = push.discs != 0u && seen.solid && seen_on_plane(seen, place, facing, shape) ? max(max(rim, dot_), inside) : 0.0;
    over += (1.0 - over.a) * vec4(ink * alpha, alpha);
  }
  vec3 color = picture_color(picture[pixel]);
  if (push.overlap != 0u && a.diffuse) {
    // One colour per count up to the end of the scale; red: none serves; grey: paths gather.
    vec3 ink = paths_gather(nearest) ? k_gathered_ink : overlap == 0u ? k_unserved_ink : ramp_color(k_ramp_viridis, float(overlap) / push.overlap_most);
    color = mix(color, ink, 0.8);
  }
  color = color * (1.0 - over.a) + over.rgb;
  picture[pixel] = picture_packed(color);
}
