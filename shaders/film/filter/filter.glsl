// What the filter's kernels share: pixels as they lie in its buffers. Method: renderer/film/filter/README.md.
#ifndef LUCERNA_FILM_FILTER
#define LUCERNA_FILM_FILTER
#include "lib/math.glsl"
#include "film/preview.glsl"
#include "shaders/shared/filter.h"

// Light of a pixel over the colour of its surface, in the two halves of the film: rgb of one half, rgb of the other, standard
// deviation of a half (root of the sum of the channels' variances), and that of what both halves have alike (of records).
struct FilterLight {
  vec3 even, odd;
  float deviation, in_both;
};
FilterLight filter_light(vec4 texel) {
  uvec4 t = floatBitsToUint(texel);
  vec2 a = unpackHalf2x16(t.x), b = unpackHalf2x16(t.y), c = unpackHalf2x16(t.z);
  return FilterLight(vec3(a, b.x), vec3(b.y, c), unpackHalf2x16(t.w).x, unpackHalf2x16(t.w).y);
}
vec4 filter_texel(FilterLight l) {
  const float k_largest = 60000.0;
  vec3 a = min(l.even, vec3(k_largest)), b = min(l.odd, vec3(k_largest));
  return uintBitsToFloat(uvec4(packHalf2x16(a.xy), packHalf2x16(vec2(a.z, b.x)), packHalf2x16(b.yz),
                               packHalf2x16(min(vec2(l.deviation, l.in_both), vec2(k_largest)))));
}

// What the samples of a pixel have met, in the mean.
struct FilterSurface {
  float depth;     // [m]; 0: nothing
  vec3 normal;     // unit; 0: nothing
  vec3 albedo;     // of what was met and what was not (1), as light is divided by it
  float covered;   // share of the samples that have met something
};
vec4 filter_texel(FilterSurface s) {
  return vec4(s.depth, uintBitsToFloat(preview_normal(s.normal)), uintBitsToFloat(packHalf2x16(s.albedo.rg)),
              uintBitsToFloat(packHalf2x16(vec2(s.albedo.b, s.covered))));
}
FilterSurface filter_surface(vec4 texel) {
  vec2 rg = unpackHalf2x16(floatBitsToUint(texel.z)), b = unpackHalf2x16(floatBitsToUint(texel.w));
  return FilterSurface(texel.x, b.y > 0.0 ? preview_normal(floatBitsToUint(texel.y)) : vec3(0.0), vec3(rg, b.x), b.y);
}

// Weight of a pixel `offset` away, on either axis, in what speaks for a fit or against it.
float filter_judged_weight(int offset) { return exp2(-k_filter_judged_falloff * float(offset * offset)); }

// How depth changes from pixel to pixel: the smaller of the two differences on each axis, so that an edge beside does not count.
float filter_slope(float before, float here, float after) {
  float a = here - before, b = after - here;
  if (before <= 0.0) a = b;
  if (after <= 0.0) b = a;
  return abs(a) < abs(b) ? a : b;
}

// Whether a pixel `offset` away shows the same surface: 0..1. `slope`: of depth by pixel, at the first.
float filter_alike(FilterSurface a, FilterSurface b, vec2 offset, vec2 slope) {
  float z = max(a.depth, 1e-20);
  float reach = 0.01 * z + 0.5 * (abs(slope.x * offset.x) + abs(slope.y * offset.y));
  float depth = (b.depth - a.depth - dot(slope, offset)) / reach;
  float facing = 1.0 - dot(a.normal, b.normal);
  vec3 colour = a.albedo - b.albedo;
  float cover = a.covered - b.covered;
  bool met = a.covered > 0.0 && b.covered > 0.0;
  float far = met ? depth * depth + facing * facing * 100.0 : 0.0;
  float other = far + 30.0 * dot(colour, colour) + 16.0 * cover * cover;
  return exp2(-other);
}
#endif
