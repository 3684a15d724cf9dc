// Input of the filter from a component of the film: halves over the colour of the surface, and the surface of the pixel.
#include "lib/film.glsl"
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
layout(scalar) readonly buffer FilmLookups { vec2 film_lookups[]; };  // squares: noise of stored light, of interpolation
uniform samplerBuffer filter_seen;
layout(scalar) writeonly buffer FilterLights { vec4 lights[]; };
layout(scalar) writeonly buffer FilterSurfaces { vec4 surfaces[]; };

float luminance_sum(FilmPixel p) {
  return luminance(p.even.sum + p.even.compensation) + luminance(p.odd.sum + p.odd.compensation);
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uint count = film_count[pixel];
  vec4 albedo = texelFetch(film_albedo, int(pixel)), normal = texelFetch(film_normal, int(pixel));
  float samples = float(max(count, 1u)), hits = albedo.w;
  FilterSurface s;
  s.covered = hits / samples;
  s.depth = hits > 0.0 ? normal.w / hits : 0.0;
  float len = length(normal.xyz);
  s.normal = len > 0.0 ? normal.xyz / len : vec3(0.0);
  s.albedo = max(albedo.rgb / samples + (1.0 - s.covered), vec3(k_filter_least_albedo));
  if (push.seen != 0u) {
    // Mirrors and glass take the surface seen in them.
    PreviewSurface seen = preview_surface(texelFetch(filter_seen, int(pixel)));
    if (seen.samples == k_preview_beyond) {
      bool met = seen.depth > 0.0;
      s.depth = met ? seen.depth : 0.0;
      s.normal = met ? seen.normal : vec3(0.0);
      s.albedo = met ? max(seen.albedo, vec3(k_filter_least_albedo)) : vec3(1.0);
      s.covered = met ? s.covered : 0.0;
    }
  }
  surfaces[pixel] = filter_texel(s);
  FilmPixel p = film_load(push.component, pixel, film_ratio(pixel));
  vec3 even = (p.even.sum + p.even.compensation) / float(max((count + 1u) / 2u, 1u));
  vec3 odd = (p.odd.sum + p.odd.compensation) / float(max(count / 2u, 1u));
  if (count < 2u) odd = even;
  float in_both = 0.0;
  if ((push.looked_up >> push.component & 1u) != 0u) {
    // Assumes equal relative errors of lookups in all components.
    float all = 0.0;
    for (uint c = 0u; c < k_component_count; ++c)
      if ((push.looked_up >> c & 1u) != 0u) all += luminance_sum(film_load(c, pixel));
    float share = all > 0.0 ? luminance_sum(p) / all : 0.0;
    in_both = share * sqrt(film_lookups[pixel].x) * push.scale / luminance(s.albedo);
  }
  lights[pixel] = filter_texel(FilterLight(even * push.scale / s.albedo, odd * push.scale / s.albedo, 0.0, in_both));
}
