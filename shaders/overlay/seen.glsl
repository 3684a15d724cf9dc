// Position of a pixel's surface in the scene, from the film's features, and of a place of the scene in the picture. Pixels
// without samples use the coarse film, so that overlays show before there is a picture.
#ifndef LUCERNA_OVERLAY_SEEN
#define LUCERNA_OVERLAY_SEEN
#include "lib/frame.glsl"
#include "lib/film.glsl"

uniform samplerBuffer coarse_albedo, coarse_normal;
layout(scalar) readonly buffer CoarseCount { uint coarse_count[]; };

struct Seen {
  bool solid;       // false where most samples of the pixel met nothing: there is no place then
  float depth;      // along the view axis [m]
  float size;       // of the pixel there [m]
  vec3 position, normal;
};

Seen seen_at(uint pixel, uint width, uint height) {
  uvec2 xy = uvec2(pixel % width, pixel / width), film = uvec2(width, height);
  uint count = film_count[pixel];
  bool sampled = count > 0u;
  uvec2 coarse_film = max(film / k_coarse_step, uvec2(1u)), coarse_xy = min(xy / k_coarse_step, coarse_film - 1u);
  uint coarse = coarse_xy.y * coarse_film.x + coarse_xy.x;
  vec4 albedo = sampled ? texelFetch(film_albedo, int(pixel)) : texelFetch(coarse_albedo, int(coarse));
  vec4 sums = sampled ? texelFetch(film_normal, int(pixel)) : texelFetch(coarse_normal, int(coarse));
  count = sampled ? count : coarse_count[coarse];
  vec2 ndc = (sampled ? (vec2(xy) + 0.5) / vec2(film) : (vec2(coarse_xy) + 0.5) / vec2(coarse_film)) * 2.0 - 1.0;
  float hits = albedo.w;
  Seen s;
  s.solid = hits > 0.5 * float(count) && hits > 0.0;
  s.depth = sums.w / max(hits, 1.0);
  vec3 shift = ndc.x * frame.camera_right - ndc.y * frame.camera_up;
  s.position = frame.orthographic != 0u ? frame.camera_origin + shift + s.depth * frame.camera_forward
                                        : frame.camera_origin + s.depth * (frame.camera_forward + shift);
  s.size = 2.0 * length(frame.camera_up) / float(sampled ? film.y : coarse_film.y) *
           (frame.orthographic != 0u ? 1.0 : s.depth);
  s.normal = dot(sums.xyz, sums.xyz) > 0.0 ? normalize(sums.xyz) : -frame.camera_forward;
  return s;
}

// Depth at a share t of the way between two places of the picture, on the line between them in the scene.
float depth_between(float a, float b, float t) {
  return frame.orthographic != 0u ? mix(a, b, t) : 1.0 / mix(1.0 / a, 1.0 / b, t);
}

// Pixels from the upper left corner, and depth; behind the eye the depth is not above 0 and the rest means nothing.
vec3 to_picture(vec3 position, uint width, uint height) {
  vec3 away = position - frame.camera_origin;
  float depth = dot(away, frame.camera_forward);
  float scale = frame.orthographic != 0u ? 1.0 : 1.0 / max(depth, 1e-20);
  vec2 ndc = scale * vec2(dot(away, frame.camera_right) / dot(frame.camera_right, frame.camera_right),
                          -dot(away, frame.camera_up) / dot(frame.camera_up, frame.camera_up));
  return vec3((0.5 * ndc + 0.5) * vec2(width, height), depth);
}

// Of a picture of that height, at a depth [m].
float pixel_size(float depth, uint height) {
  return 2.0 * length(frame.camera_up) / float(height) * (frame.orthographic != 0u ? 1.0 : depth);
}
#endif
