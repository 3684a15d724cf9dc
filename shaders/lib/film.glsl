// The film: for each component two half sums (even and odd samples, independently scrambled), each with the compensation
// of Neumaier's variant of Kahan's summation, so that a million samples of mixed magnitude add up without drift.
//
// It lies in texel buffers, of which the largest hold 16 times what a storage buffer may on lavapipe. A pixel's two halves
// are three texels. In one dispatch a pixel is read before it is written, by one invocation.
#ifndef LUCERNA_LIB_FILM
#define LUCERNA_LIB_FILM
#include "shaders/shared/film.h"
#include "lib/math.glsl"

uniform samplerBuffer film_primary, film_secondary, film_tertiary, film_caustic;
uniform samplerBuffer film_albedo;   // sums: albedo rgb, hits
uniform samplerBuffer film_normal;   // sums: normal xyz, depth
layout(rgba32f) uniform writeonly imageBuffer film_primary_image, film_secondary_image, film_tertiary_image, film_caustic_image;
layout(rgba32f) uniform writeonly imageBuffer film_albedo_image, film_normal_image;
layout(scalar) buffer FilmCount { uint film_count[]; };  // samples

struct FilmPixel {
  FilmHalf even, odd;
};

FilmPixel film_pixel(vec4 a, vec4 b, vec4 c) {
  return FilmPixel(FilmHalf(a.xyz, vec3(a.w, b.xy)), FilmHalf(vec3(b.zw, c.x), c.yzw));
}
#define LUCERNA_FILM_LOAD(buffer, pixel)                                                       \
  film_pixel(texelFetch(buffer, int(3u * (pixel))), texelFetch(buffer, int(3u * (pixel)) + 1), \
             texelFetch(buffer, int(3u * (pixel)) + 2))
#define LUCERNA_FILM_STORE(image, pixel, value)                                                               \
  imageStore(image, int(3u * (pixel)), vec4((value).even.sum, (value).even.compensation.x));                  \
  imageStore(image, int(3u * (pixel)) + 1, vec4((value).even.compensation.yz, (value).odd.sum.xy));           \
  imageStore(image, int(3u * (pixel)) + 2, vec4((value).odd.sum.z, (value).odd.compensation));

FilmPixel film_load(uint component, uint pixel) {
  if (component == 0u) return LUCERNA_FILM_LOAD(film_primary, pixel);
  if (component == 1u) return LUCERNA_FILM_LOAD(film_secondary, pixel);
  if (component == 2u) return LUCERNA_FILM_LOAD(film_tertiary, pixel);
  return LUCERNA_FILM_LOAD(film_caustic, pixel);
}
#endif
