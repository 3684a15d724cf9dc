// Position in the scene of the surface of a sheet's pixel, and projection of a point of the scene onto the sheet. The surface is
// the one traced through the pixel's centre; before it is known, the plane of the film's samples, or of the coarse film's.
#ifndef LUCERNA_OVERLAY_SEEN
#define LUCERNA_OVERLAY_SEEN
#include "lib/frame.glsl"
#include "lib/film.glsl"
#include "shaders/shared/sheet.h"

layout(scalar) readonly buffer SheetBlock { SheetView sheet; };
uniform samplerBuffer sheet_surfaces;  // normal, depth along the view axis [m]; 0: none
uniform samplerBuffer coarse_albedo, coarse_normal;
layout(scalar) readonly buffer CoarseCount { uint coarse_count[]; };

struct Seen {
  bool solid;       // false if most samples of the pixel have no hit; then there is no position
  float depth;      // along the view axis [m]
  float size;       // width of the pixel there [m]
  vec3 position, normal;
};

// Sets depth and position for a point of the picture, 0..1 to the right and down.
void place_seen(inout Seen s, vec2 at, float depth) {
  vec3 shift = shift_at(at);
  s.depth = depth;
  s.position = camera_start(shift) + depth * camera_view(shift);
}

// Depth at the point `to` of the picture of the plane with this normal and this depth at the point `from`.
float depth_on_plane(vec3 normal, vec2 from, float depth, vec2 to) {
  vec3 a = shift_at(from), b = shift_at(to);
  if (is_parallel(frame.projection)) return depth + dot(normal, a - b) / dot(normal, frame.camera_forward);
  return depth * dot(normal, camera_view(a)) / dot(normal, camera_view(b));
}

// Index of the film's pixel below a pixel of the sheet.
uint film_pixel_below(uint pixel, uint width) {
  uvec2 xy = uvec2(pixel % width, pixel / width) / sheet.scale;
  return xy.y * sheet.film_width + xy.x;
}

// Visible surface of a pixel of the sheet. `width`, `height`: size of the sheet.
Seen seen_at(uint pixel, uint width, uint height) {
  uvec2 sheet_xy = uvec2(pixel % width, pixel / width);
  Seen s;
  if (sheet.surfaces_known != 0u) {
    vec4 surface = texelFetch(sheet_surfaces, int(pixel));
    s.solid = surface.w > 0.0;
    place_seen(s, (vec2(sheet_xy) + 0.5) / vec2(width, height), surface.w);
    s.size = 2.0 * length(frame.camera_up) / float(height) * (is_parallel(frame.projection) ? 1.0 : s.depth);
    s.normal = s.solid ? surface.xyz : -frame.camera_axis;
    return s;
  }
  uvec2 film = uvec2(sheet.film_width, sheet.film_height), xy = sheet_xy / sheet.scale;
  uint below = xy.y * film.x + xy.x, count = film_count[below];
  bool sampled = count > 0u;
  uvec2 coarse_film = max(film / k_coarse_step, uvec2(1u)), coarse_xy = min(xy / k_coarse_step, coarse_film - 1u);
  uint coarse = coarse_xy.y * coarse_film.x + coarse_xy.x;
  vec4 albedo = sampled ? texelFetch(film_albedo, int(below)) : texelFetch(coarse_albedo, int(coarse));
  vec4 sums = sampled ? texelFetch(film_normal, int(below)) : texelFetch(coarse_normal, int(coarse));
  count = sampled ? count : coarse_count[coarse];
  float hits = albedo.w;
  s.solid = hits > 0.5 * float(count) && hits > 0.0;
  s.normal = dot(sums.xyz, sums.xyz) > 0.0 ? normalize(sums.xyz) : -frame.camera_axis;
  vec2 at = (vec2(sheet_xy) + 0.5) / vec2(width, height);
  vec2 known = sampled ? (vec2(xy) + 0.5) / vec2(film) : (vec2(coarse_xy) + 0.5) / vec2(coarse_film);
  float depth = sums.w / max(hits, 1.0), moved = depth_on_plane(s.normal, known, depth, at);
  place_seen(s, at, moved > 0.8 * depth && moved < 1.25 * depth ? moved : depth);
  s.size = 2.0 * length(frame.camera_up) / float(sampled ? film.y : coarse_film.y) *
           (is_parallel(frame.projection) ? 1.0 : s.depth);
  return s;
}

// Steps on the plane of a surface from a pixel's centre to those of its right and lower neighbours [m].
mat2x3 pixel_steps(Seen s, uint width, uint height) {
  bool parallel = is_parallel(frame.projection);
  vec3 along = parallel ? frame.camera_forward : (s.position - frame.camera_origin) / max(s.depth, 1e-20);
  float facing = dot(s.normal, along), least = 0.02 * length(along);
  facing = facing < 0.0 ? min(facing, -least) : max(facing, least);  // limited for surfaces at grazing angles
  float scale = parallel ? 1.0 : s.depth;
  vec3 right = 2.0 / float(width) * frame.camera_right, down = -2.0 / float(height) * frame.camera_up;
  if (is_wide(frame.projection)) {
    vec2 at = angles_towards(normalize(along));
    vec3 x = normalize(frame.camera_right), y = normalize(frame.camera_up);
    right = wide_direction(frame.projection, at + vec2(length(right), 0.0), x, y, frame.camera_axis) - along;
    down = wide_direction(frame.projection, at - vec2(0.0, length(down)), x, y, frame.camera_axis) - along;
  }
  return mat2x3(scale * (right - dot(s.normal, right) / facing * along), scale * (down - dot(s.normal, down) / facing * along));
}

// Depth at parameter t (0..1) between two points of the picture, on the line between them in the scene.
float depth_between(float a, float b, float t) {
  return is_parallel(frame.projection) ? mix(a, b, t) : 1.0 / mix(1.0 / a, 1.0 / b, t);
}

// Projection: pixels from the upper left corner, and depth; 0 or less behind the eye, where the pixels are invalid.
vec3 to_picture(vec3 position, uint width, uint height) {
  vec3 away = position - frame.camera_origin;
  float depth = camera_depth(away);
  if (is_wide(frame.projection)) {
    vec2 angles = angles_towards(away / max(depth, 1e-20));
    vec2 place = angles / vec2(length(frame.camera_right), -length(frame.camera_up));
    return vec3((0.5 * place + 0.5) * vec2(width, height), wide_covers(frame.projection, angles) ? depth : 0.0);
  }
  float scale = is_parallel(frame.projection) ? 1.0 : 1.0 / max(depth, 1e-20);
  // Within the plane at distance 1, from the middle of the picture.
  away = scale * away - (frame.camera_forward - frame.camera_axis);
  vec2 ndc = vec2(dot(away, frame.camera_right) / dot(frame.camera_right, frame.camera_right),
                          -dot(away, frame.camera_up) / dot(frame.camera_up, frame.camera_up));
  return vec3((0.5 * ndc + 0.5) * vec2(width, height), depth);
}

// Width of a pixel at a depth [m], in a picture of that height.
float pixel_size(float depth, uint height) {
  return 2.0 * length(frame.camera_up) / float(height) * (is_parallel(frame.projection) ? 1.0 : depth);
}
#endif
