// The film: for each component two half sums (even and odd samples, independently scrambled), each with the compensation
// of Neumaier's variant of Kahan's summation, so that a million samples of mixed magnitude add up without drift.
#ifndef LUCERNA_LIB_FILM
#define LUCERNA_LIB_FILM
#include "shaders/shared/film.h"
#include "lib/math.glsl"

layout(scalar) buffer FilmPrimary { FilmHalf film_primary[]; };     // pixel * 2 + half
layout(scalar) buffer FilmSecondary { FilmHalf film_secondary[]; };
layout(scalar) buffer FilmTertiary { FilmHalf film_tertiary[]; };
layout(scalar) buffer FilmCaustic { FilmHalf film_caustic[]; };
layout(scalar) buffer FilmAlbedo { vec4 film_albedo[]; };           // sums: albedo rgb, hits
layout(scalar) buffer FilmNormal { vec4 film_normal[]; };           // sums: normal xyz, depth
layout(scalar) buffer FilmCount { uint film_count[]; };             // samples

FilmHalf film_read(uint component, uint pixel, uint part) {
  uint i = 2u * pixel + part;
  if (component == 0u) return film_primary[i];
  if (component == 1u) return film_secondary[i];
  if (component == 2u) return film_tertiary[i];
  return film_caustic[i];
}
#endif
