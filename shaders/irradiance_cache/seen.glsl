// Tests whether a record's disc covers the surface that a pixel shows.
#ifndef LUCERNA_IRRADIANCE_CACHE_SEEN
#define LUCERNA_IRRADIANCE_CACHE_SEEN
#include "overlay/seen.glsl"
#include "irradiance_cache/ellipse.glsl"

// Reach of a record in the direction of a point. `shape`: record_shape() of lookup.glsl.
float seen_reach(Seen s, vec4 place, vec4 shape) {
  vec3 away = s.position - place.xyz;
  float of_reach = record_distance(away, shape);
  return of_reach > 1e-6 ? length(away) / of_reach : shape.w;
}

// True if the surface is near the record's plane and parallel to it, at any distance. Tolerant: discs follow curved surfaces,
// and a pixel's depth is a mean over its samples.
bool seen_on_plane(Seen s, vec4 place, vec4 facing, vec4 shape) {
  return abs(dot(s.position - place.xyz, facing.xyz)) < 2.0 * s.size + 0.15 * shape.w && dot(s.normal, facing.xyz) > 0.7;
}
bool seen_on_disc(Seen s, vec4 place, vec4 facing, vec4 shape) {
  return record_distance(s.position - place.xyz, shape) < 1.0 && seen_on_plane(s, place, facing, shape);
}
#endif
