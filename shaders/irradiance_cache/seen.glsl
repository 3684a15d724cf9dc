// Tests whether a record's disc covers the surface that a pixel shows.
#ifndef LUCERNA_IRRADIANCE_CACHE_SEEN
#define LUCERNA_IRRADIANCE_CACHE_SEEN
#include "overlay/seen.glsl"
#include "irradiance_cache/ellipse.glsl"

// Pixels from the border of a record to a place, negative inside, along the steepest way. `steps`: pixel_steps(); `shape`:
// record_shape() of lookup.glsl.
float pixels_beyond(Seen s, mat2x3 steps, vec4 place, vec4 shape) {
  vec3 away = s.position - place.xyz;
  float here = record_distance(away, shape);
  vec2 slope = vec2(record_distance(away + steps[0], shape), record_distance(away + steps[1], shape)) - here;
  return (here - 1.0) / max(length(slope), 1e-9);
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
