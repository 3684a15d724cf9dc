// Place and normal of a pixel's lookups of stored light (records, photons): the surface at the pixel's centre, as traced by
// rays (shaders/shared/sight.h), so that results equal those of paths. The film is not exact: its depths are means over a
// pixel, which lie off the plane of a slanted floor, and its normals include normal maps, while light is stored for the
// smooth surface. It is used only before rays have been traced.
#ifndef LUCERNA_OVERLAY_LOOKUP_PLACE
#define LUCERNA_OVERLAY_LOOKUP_PLACE
#include "overlay/seen.glsl"
#include "shaders/shared/sight.h"

uniform samplerBuffer surface_texels;

struct LookupPlace {
  bool diffuse;       // a diffuse surface is visible
  bool answerable;  // ... and its normal map is not too steep for a lookup
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
