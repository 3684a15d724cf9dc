// The film: for each component two half sums (even and odd samples, independently scrambled), each with the compensation
// of Neumaier's variant of Kahan's summation, so that a million samples of mixed magnitude add up without drift.
//
// Stored in texel buffers, the largest of which hold 16 times as much as a storage buffer on lavapipe. A pixel's two halves
// are three texels. With light groups (LUCERNA_LIGHT_GROUPS) each group has such sums, and the picture's derive from them;
// or compact sums of all components (LUCERNA_GROUP_SUMS), which weight those of the components when they are read, half by
// half. In one dispatch one invocation reads and then writes a pixel, as a storage buffer if it fits into one, which is
// several times as fast on lavapipe, else through images (LUCERNA_FILM_IMAGES).
#ifndef LUCERNA_LIB_FILM
#define LUCERNA_LIB_FILM
#include "lib/variants.glsl"
#include "shaders/shared/film.h"
#include "shaders/shared/lanes.h"
#include "lib/math.glsl"

uniform samplerBuffer film_primary, film_secondary, film_tertiary, film_caustic;
uniform samplerBuffer film_albedo;   // sums: albedo rgb, hits
uniform samplerBuffer film_normal;   // sums: normal xyz, depth
#if LUCERNA_FILM_IMAGES
layout(rgba32f) uniform writeonly imageBuffer film_primary_out, film_secondary_out, film_tertiary_out, film_caustic_out;
layout(rgba32f) uniform writeonly imageBuffer film_albedo_out, film_normal_out;
#define LUCERNA_FILM_WRITE(buffer, texel, value) imageStore(buffer, texel, value)
#else
layout(scalar) writeonly buffer FilmPrimary { vec4 film_primary_out[]; };
layout(scalar) writeonly buffer FilmSecondary { vec4 film_secondary_out[]; };
layout(scalar) writeonly buffer FilmTertiary { vec4 film_tertiary_out[]; };
layout(scalar) writeonly buffer FilmCaustic { vec4 film_caustic_out[]; };
layout(scalar) writeonly buffer FilmAlbedo { vec4 film_albedo_out[]; };
layout(scalar) writeonly buffer FilmNormal { vec4 film_normal_out[]; };
#define LUCERNA_FILM_WRITE(buffer, texel, value) buffer[texel] = value
#endif
#include "film/mix.glsl"
#if LUCERNA_FILM_LANES
// Sums of one light group, like those above, which then hold the picture with the mix of all groups.
uniform samplerBuffer group_primary, group_secondary, group_tertiary, group_caustic;
#if LUCERNA_FILM_IMAGES
layout(rgba32f) uniform writeonly imageBuffer group_primary_out, group_secondary_out, group_tertiary_out, group_caustic_out;
#else
layout(scalar) writeonly buffer GroupPrimary { vec4 group_primary_out[]; };
layout(scalar) writeonly buffer GroupSecondary { vec4 group_secondary_out[]; };
layout(scalar) writeonly buffer GroupTertiary { vec4 group_tertiary_out[]; };
layout(scalar) writeonly buffer GroupCaustic { vec4 group_caustic_out[]; };
#endif
#endif
layout(scalar) buffer FilmCount { uint film_count[]; };  // samples

struct FilmPixel {
  FilmHalf even, odd;
};

// Adds with compensation.
void film_half_add(inout FilmHalf h, vec3 x) {
  precise vec3 t = h.sum + x;
  precise vec3 lost_small = (h.sum - t) + x;   // |sum| >= |x|
  precise vec3 lost_large = (x - t) + h.sum;
  h.compensation += mix(lost_large, lost_small, greaterThanEqual(abs(h.sum), abs(x)));
  h.sum = t;
}

FilmPixel film_pixel(vec4 a, vec4 b, vec4 c) {
  return FilmPixel(FilmHalf(a.xyz, vec3(a.w, b.xy)), FilmHalf(vec3(b.zw, c.x), c.yzw));
}
#define LUCERNA_FILM_LOAD(buffer, pixel)                                                       \
  film_pixel(texelFetch(buffer, int(3u * (pixel))), texelFetch(buffer, int(3u * (pixel)) + 1), \
             texelFetch(buffer, int(3u * (pixel)) + 2))
#define LUCERNA_FILM_STORE(buffer, pixel, value)                                                              \
  LUCERNA_FILM_WRITE(buffer, int(3u * (pixel)), vec4((value).even.sum, (value).even.compensation.x));         \
  LUCERNA_FILM_WRITE(buffer, int(3u * (pixel)) + 1, vec4((value).even.compensation.yz, (value).odd.sum.xy));  \
  LUCERNA_FILM_WRITE(buffer, int(3u * (pixel)) + 2, vec4((value).odd.sum.z, (value).odd.compensation));

// Sums of a component at a pixel, before the mix.
FilmPixel film_load(uint component, uint pixel) {
  if (component == 0u) return LUCERNA_FILM_LOAD(film_primary, pixel);
  if (component == 1u) return LUCERNA_FILM_LOAD(film_secondary, pixel);
  if (component == 2u) return LUCERNA_FILM_LOAD(film_tertiary, pixel);
  return LUCERNA_FILM_LOAD(film_caustic, pixel);
}

// Factors of the halves of a pixel's components for the shown mix; 1 without compact groups, and where each is read unmixed.
struct FilmRatio {
  vec3 even, odd;
};
FilmRatio film_ratio(uint pixel) {
  vec3 even = vec3(0.0), odd = vec3(0.0), even_mixed = vec3(0.0), odd_mixed = vec3(0.0);
  uvec2 groups_pixels = light_mix_size();
  // lavapipe runs a loop once even with zero iterations: then all pixels read one texel.
  for (uint group = 0u; group < groups_pixels.x; ++group) {
    uvec4 sums = texelFetch(group_sums, int(groups_pixels.x > 0u ? group * groups_pixels.y + pixel : 0u));
    vec3 a = group_sum_value(GroupSum(sums.x, sums.y)), b = group_sum_value(GroupSum(sums.z, sums.w)), w = light_weight(group);
    even += a;
    odd += b;
    even_mixed += w * a;
    odd_mixed += w * b;
  }
  vec3 whole = light_mix_whole();
  bool of_groups = groups_pixels.x > 0u;
  return FilmRatio(of_groups ? group_ratio(even_mixed, even) : whole, of_groups ? group_ratio(odd_mixed, odd) : whole);
}

FilmHalf film_mixed(FilmHalf h, vec3 ratio) { return FilmHalf(ratio * h.sum, ratio * h.compensation); }
// Sums of a component at a pixel, with the mix of light groups.
FilmPixel film_load(uint component, uint pixel, FilmRatio ratio) {
  FilmPixel p = film_load(component, pixel);
  return FilmPixel(film_mixed(p.even, ratio.even), film_mixed(p.odd, ratio.odd));
}

#if LUCERNA_FILM_LAYER
// Sums of a layer by path expression, like those of a component.
uniform samplerBuffer film_layer;
#if LUCERNA_FILM_IMAGES
layout(rgba32f) uniform writeonly imageBuffer film_layer_out;
#else
layout(scalar) writeonly buffer FilmLayer { vec4 film_layer_out[]; };
#endif
#endif
#endif
