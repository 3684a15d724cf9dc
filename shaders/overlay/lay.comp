// Draws the marks of strokes over the picture, optionally dimmed, so that they are visible on any background. In a dimmed
// picture, surfaces of pixels without samples are grey by orientation, because the coarse picture's noise would hide the marks.
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "overlay/seen.glsl"
#include "shaders/shared/overlay.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OverlayLayPush push; };
layout(scalar) readonly buffer OverlayMarks { uint marks[]; };
layout(scalar) readonly buffer OverlayInks { vec4 inks[]; };
layout(scalar) buffer Picture { uint picture[]; };

const float k_dim = 0.6, k_grey = 0.6;
const float k_background = 0.1, k_edge_on = 0.1, k_facing = 0.4;  // encoded

float grey_of(uvec2 xy, uvec2 coarse_film) {
  uint pixel = xy.y * coarse_film.x + xy.x;
  vec4 albedo = texelFetch(coarse_albedo, int(pixel));
  vec3 normal = texelFetch(coarse_normal, int(pixel)).xyz;
  if (albedo.w < 0.5 * float(coarse_count[pixel]) || dot(normal, normal) == 0.0) return k_background;
  vec3 view = camera_direction(shift_at((vec2(xy) + 0.5) / vec2(coarse_film)));
  float light = sqrt(clamp(dot(albedo.xyz / albedo.w, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0));
  return mix(k_edge_on, k_facing, abs(dot(normalize(normal), view))) * mix(0.5, 1.0, light);
}

// Grey of a pixel, interpolated between the coarse film's pixels.
float grey_at(uvec2 xy) {
  uvec2 coarse_film = max(uvec2(sheet.film_width, sheet.film_height) / k_coarse_step, uvec2(1u));
  vec2 at = (vec2(xy) + 0.5) / float(sheet.scale * k_coarse_step) - 0.5, low = floor(at), part = at - low;
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    vec2 weight = mix(1.0 - part, part, vec2(corner));
    sum += weight.x * weight.y * grey_of(uvec2(clamp(ivec2(low) + corner, ivec2(0), ivec2(coarse_film) - 1)), coarse_film);
  }
  return sum;
}

// Grey of a surface traced for the sheet.
float grey_of(Seen s) {
  if (!s.solid) return k_background;
  vec3 view = camera_towards(s.position);
  return 0.8 * mix(k_edge_on, k_facing, abs(dot(s.normal, view)));
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uint mark = marks[pixel];
  if (mark == 0u && push.dimmed == 0u) return;
  vec3 color = picture_color(picture[pixel]);
  if (push.dimmed != 0u) {
    if (film_count[film_pixel_below(pixel, push.width)] == 0u)
      color = vec3(sheet.surfaces_known != 0u ? grey_of(seen_at(pixel, push.width, push.height))
                                              : grey_at(uvec2(pixel % push.width, pixel / push.width)));
    else
      color = k_dim * mix(color, vec3(dot(color, vec3(0.2126, 0.7152, 0.0722))), k_grey);
  }
  if (mark != 0u) {
    float cover = float(mark >> k_mark_cover_shift & 0x7fu) / 127.0;
    bool edge = mark >> k_mark_rank_shift == k_rank_edge;
    vec4 ink = edge ? vec4(0.0, 0.0, 0.0, push.edge_alpha) : inks[k_mark_number - (mark & k_mark_number)];
    color = mix(color, ink.rgb, ink.a * cover);
  }
  picture[pixel] = picture_packed(color);
}
