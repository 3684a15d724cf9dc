// What the first rays of a relighting say of how much the light has changed, pooled over many records: of one alone a few
// rays say next to nothing.
#ifndef LUCERNA_LIGHT_CHANGE_GLSL
#define LUCERNA_LIGHT_CHANGE_GLSL
#include "lib/light_change.glsl"
#include "lib/math.glsl"
#include "shaders/shared/irradiance_cache/records.h"

// Of a cluster of records, or of all: sums over them, each weighing by the light it had, so that bright ones do not say it
// all.
struct LightSums {
  vec3 now, before;
  float spread;  // of (now - ratio * before) squared, luminance, where the ratio is that of the cluster's sums
  float noise;   // the part of it that the rays tell of their noise
  float expected;  // ... that so few rays are expected to bring where the light has not changed
};

// `tertiary`: of that part; else of all others.
LightSums light_sums(samplerBuffer texels, uint cluster, bool tertiary) {
  int at = int(k_light_sums_texels * cluster + (tertiary ? 2u : 0u));
  vec4 a = texelFetch(texels, at), b = texelFetch(texels, at + 1);
  vec4 noise = texelFetch(texels, int(k_light_sums_texels * cluster) + 4);
  return LightSums(a.xyz, b.xyz, a.w, tertiary ? noise.y : noise.x, b.w);
}

// By channel; where a channel had no light, as the luminance.
vec3 light_ratio(LightSums s) {
  float before = luminance(s.before), all = before > 0.0 ? luminance(s.now) / before : 1.0;
  vec3 ratio = mix(vec3(all), s.now / max(s.before, vec3(1e-20)), greaterThan(s.before, vec3(1e-3 * before)));
  return min(ratio, vec3(k_most_light_ratio));
}

uniform samplerBuffer ray_noise_texels;  // four records each

// Of a record, the variance of one ray over the square of its light, as its many rays have told before. Where few rays find
// what is bright, those that find nothing seem to be without noise.
float ray_noise(uint record) { return texelFetch(ray_noise_texels, int(record / 4u))[record % 4u]; }

// How far such sums are believed where `known` is what is known without them.
float light_belief(LightSums s, vec3 known) {
  float off = square(luminance(s.now - known * s.before)), expected = square(min(luminance(known), 1.0)) * s.expected;
  return light_belief(vec4(off), vec4(s.spread), vec4(expected)).x;
}
#endif
