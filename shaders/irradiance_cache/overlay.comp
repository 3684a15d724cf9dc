// Draws the records over the picture, on the surfaces that the camera sees: each as a ring around where it is valid, one pixel
// of the sheet wide, with a dot at its centre and a faint fill; and how many serve a pixel as a heat map.
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "irradiance_cache/lookup.glsl"
#include "irradiance_cache/seen.glsl"
#include "overlay/lookup_place.glsl"
#include "irradiance_cache/ink.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OverlayPush push; };
layout(scalar) buffer Picture { uint picture[]; };

const float k_half_line = 0.55, k_dot = 1.5;               // pixels
const float k_least_ring = 1.5, k_full_ring = 10.0;        // apparent width [pixels] of the first and the full visibility
const float k_faintest = 0.15, k_ink = 0.9, k_fill = 0.06; // shares

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  Seen seen = seen_at(pixel, push.width, push.height);

  LookupPlace a = lookup_place(pixel, push.width, push.grid, seen);
  uint overlap = 0u;
  Nearest nearest = nothing_near();
  vec4 over = vec4(0.0);  // premultiplied
  vec2 here = vec2(pixel % push.width, pixel / push.width) + 0.5;
  mat2x3 steps = pixel_steps(seen, push.width, push.height);
  vec3 away = camera_towards(seen.position);
  float pixel_width = pixel_size(seen.depth, push.height);
  float facing_share = abs(dot(seen.normal, away));
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
    vec3 ink = crowds ? k_gathered_ink : record_ink(record, push.color, push.lo, push.hi);
    float beyond = pixels_beyond(seen, steps, place, shape);
    // Rings of a few pixels fade, so that many of them far away do not become fog.
    float strength = clamp((facing_share * shape.w / pixel_width - k_least_ring) / (k_full_ring - k_least_ring), k_faintest, 1.0);
    float rim = clamp(k_half_line + 0.5 - abs(beyond + k_half_line), 0.0, 1.0) * strength;
    float dot_ = 0.0;
    if (distance(seen.position, place.xyz) * facing_share < 4.0 * pixel_width) {
      vec3 centre = to_picture(place.xyz, push.width, push.height);
      dot_ = clamp(k_dot + 0.5 - distance(centre.xy, here), 0.0, 1.0) * max(strength, 0.5);
    }
    float inside = k_fill * clamp(0.5 - beyond, 0.0, 1.0);
    bool drawn = push.discs != 0u && seen.solid && seen_on_plane(seen, place, facing, shape);
    float alpha = drawn ? max(k_ink * max(rim, dot_), inside) : 0.0;
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
