// Where a pixel's paths ask for records, and with which normal: the surface that is seen through the pixel's centre, as the
// screen-space stage has met it (shaders/shared/discontinuity.h), so that an answer here is what paths are answered. The
// film cannot say: its depths are means over a pixel, which lie off the plane of a floor seen at a slant, and its normals are
// those of normal maps, while records stand on the smooth surface. It stands in where that stage has not looked yet.
#ifndef LUCERNA_IRRADIANCE_CACHE_ASKING
#define LUCERNA_IRRADIANCE_CACHE_ASKING
#include "irradiance_cache/seen.glsl"
#include "shaders/shared/discontinuity.h"

uniform samplerBuffer surface_texels;

struct Asking {
  bool asks;        // something diffuse is seen
  bool answerable;  // ... whose normal map does not lead away from what records can serve
  vec3 position, normal;
};

// `seen`: seen_at() of that pixel.
Asking asking_at(uint pixel, uint width, SightGrid grid, Seen seen) {
  bool met = grid.across > 0u;
  uvec2 point = uvec2(pixel % width, pixel / width) / max(grid.stride, 1u);
  int at = met ? int((point.y * grid.across + point.x) * k_surface_texels) : 0;
  vec4 place = texelFetch(surface_texels, at);
  vec3 normal = texelFetch(surface_texels, at + 1).xyz;
  if (!met) return Asking(seen.solid, seen.solid, seen.position, seen.normal);
  return Asking(place.w != k_surface_none, place.w >= 0.0, place.xyz, normal);
}
#endif
