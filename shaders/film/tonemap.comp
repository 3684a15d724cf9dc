// Film -> picture: chosen layer, exposure, tone curve, sRGB bytes. Pixels that no sample has reached are taken from the coarse
// film, which the host has tone-mapped into `Coarse` first.
#include "lib/film.glsl"
#include "lib/display.glsl"
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { TonePush push; };
layout(scalar) buffer Picture { uint picture[]; };
layout(scalar) readonly buffer Coarse { uint coarse[]; };

vec3 component_mean(uint c, uint pixel, FilmRatio ratio, float n) {
  FilmPixel p = film_load(c, pixel, ratio);
  vec3 sum = (p.even.sum + p.odd.sum) + (p.even.compensation + p.odd.compensation);
  return sum / n;
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uint count = film_count[pixel];
  float n = float(max(count, 1u));
  vec3 color = vec3(0.0);
  FilmRatio ratio = film_ratio(pixel);
  for (uint c = 0u; c < k_component_count; ++c) {
    bool shown = push.layer == k_layer_beauty ? (push.show >> c & 1u) != 0u : push.layer == k_layer_primary + c;
    if (shown) color += component_mean(c, pixel, ratio, n);
  }
#if LUCERNA_FILM_LAYER
  FilmPixel own = LUCERNA_FILM_LOAD(film_layer, pixel);
  own = FilmPixel(film_mixed(own.even, ratio.even), film_mixed(own.odd, ratio.odd));
  color = ((own.even.sum + own.odd.sum) + (own.even.compensation + own.odd.compensation)) / n;
#endif
  vec4 albedo = texelFetch(film_albedo, int(pixel)), normal = texelFetch(film_normal, int(pixel));
  float hits = max(albedo.w, 1.0);
  vec3 flat_color = albedo.xyz / n;
  if (push.layer == k_layer_normal) flat_color = 0.5 * normalize(normal.xyz + vec3(0.0, 0.0, 1e-20)) + 0.5;
  if (push.layer == k_layer_depth) flat_color = vec3(albedo.w > 0.0 ? normal.w / hits / push.scale : 1.0);
  vec3 srgb;
  if (!is_light_layer(push.layer)) {
    vec3 linear_color = clamp(flat_color, vec3(0.0), vec3(1.0));
    srgb = push.layer == k_layer_normal ? linear_color : srgb_encode(linear_color);
  } else {
    srgb = display_color(color * push.exposure, push.curve);
  }
  uint packed = picture_packed(srgb);
  if (count == 0u && push.coarse_width > 0u) {
    uvec2 xy = uvec2(pixel % push.width, pixel / push.width);
    uvec2 at = min(xy * uvec2(push.coarse_width, push.coarse_height) / uvec2(push.width, push.height), uvec2(push.coarse_width, push.coarse_height) - 1u);
    packed = coarse[at.y * push.coarse_width + at.x];
  }
  picture[pixel] = packed;
}
