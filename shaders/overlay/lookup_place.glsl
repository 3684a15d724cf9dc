// Where a pixel's paths ask for light that is stored, in records for example, and with which normal: the surface that is
// seen through the pixel's centre, as rays have met it (shaders/shared/sight.h), so that an answer here is what paths are
// answered. The film cannot say: its depths are means over a pixel, which lie off the plane of a floor seen at a slant, and
// its normals are those of normal maps, while light is stored for the smooth surface. It stands in where nobody has looked
// yet.
#ifndef LUCERNA_OVERLAY_LOOKUP_PLACE
#define LUCERNA_OVERLAY_LOOKUP_PLACE
#include "overlay/seen.glsl"
#include "shaders/shared/sight.h"

uniform samplerBuffer surface_texels;

struct LookupPlace {
  bool diffuse;       // something diffuse is seen
  bool answerable;  // ... whose normal map does not lead away from what can be answered
  vec3 position, normal;
};

// `seen`: seen_at() of that pixel.
LookupPlace lookup_place(uint pixel, uint width, SightGrid grid, Seen seen) {
  bool met = grid.across > 0u;
  uvec2 point = uvec2(pixel % width, pixel / width) / (sheet.scale * max(grid.stride, 1u));
  int at = met ? int((point.y * grid.across + point.x) * k_surface_texels) : 0;
  vec4 place = texelFetch(surface_texels, at);
  vec3 normal = texelFetch(surface_texels, at + 1).xyz;
  if (!met) return LookupPlace(seen.solid, seen.solid, seen.position, seen.normal);
  return LookupPlace(place.w != k_surface_none, place.w >= 0.0, place.xyz, normal);
}
#endif
