// Pixels in the filter's buffers, and functions common to its kernels. Method: renderer/film/filter/README.md.
#ifndef LUCERNA_FILM_FILTER
#define LUCERNA_FILM_FILTER
#include "lib/math.glsl"
#include "film/preview.glsl"
#include "shaders/shared/filter.h"

// Light of a pixel over the colour of its surface: rgb of both halves of the film, the standard deviation of a half (root of the
// sum of the channels' variances), and that of the noise common to both halves (of lookups).
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

// Mean of the surfaces that the samples of a pixel have hit.
struct FilterSurface {
  float depth;     // [m]; 0: no surface
  vec3 normal;     // unit; 0: no surface
  vec3 albedo;     // divisor of the light; samples without a hit count as 1
  float covered;   // share of the samples with a hit
};
// The last 8 bits of the depth hold the coverage; 0 is kept for no hit at all.
vec4 filter_texel(FilterSurface s) {
  uint covered = uint(ceil(255.0 * clamp(s.covered, 0.0, 1.0)));
  return uintBitsToFloat(uvec4((floatBitsToUint(s.depth) & ~255u) | covered, packHalf2x16(s.normal.xy),
                               packHalf2x16(vec2(s.normal.z, s.albedo.r)), packHalf2x16(s.albedo.gb)));
}
float filter_depth(vec4 texel) { return uintBitsToFloat(floatBitsToUint(texel.x) & ~255u); }
FilterSurface filter_surface(vec4 texel) {
  uvec4 t = floatBitsToUint(texel);
  vec2 a = unpackHalf2x16(t.y), b = unpackHalf2x16(t.z), c = unpackHalf2x16(t.w);
  return FilterSurface(filter_depth(texel), vec3(a, b.x), vec3(b.y, c), float(t.x & 255u) / 255.0);
}

// Weight, along one axis, of a pixel `offset` away in the evidence for or against a fit.
float filter_judged_weight(int offset) { return exp2(-k_filter_judged_falloff * float(offset * offset)); }

// Slope of depth per pixel along one axis: the smaller of the two differences, so that an adjacent edge does not count.
float filter_slope(float before, float here, float after) {
  float a = here - before, b = after - here;
  if (before <= 0.0) a = b;
  if (after <= 0.0) b = a;
  return abs(a) < abs(b) ? a : b;
}

// Likeness of the surface of a pixel `offset` away, as its binary logarithm: 0 for equal surfaces, else below. `slope`: slope of
// depth per pixel at the first pixel.
float filter_log_alike(FilterSurface a, FilterSurface b, vec2 offset, vec2 slope) {
  float z = max(a.depth, 1e-20);
  float reach = 0.01 * z + 0.5 * (abs(slope.x * offset.x) + abs(slope.y * offset.y));
  float depth = (b.depth - a.depth - dot(slope, offset)) / reach;
  float facing = 1.0 - dot(a.normal, b.normal);
  vec3 colour = a.albedo - b.albedo;
  float cover = a.covered - b.covered;
  bool met = a.covered > 0.0 && b.covered > 0.0;
  float far = met ? depth * depth + facing * facing * 100.0 : 0.0;
  return -(far + 30.0 * dot(colour, colour) + 16.0 * cover * cover);
}
#endif
