// The environment as two emitters, for records with sky light (shared/scene.h): each texel belongs to the sky or the sun.
// For lib/lights.glsl.
#ifndef LUCERNA_LIB_SKY
#define LUCERNA_LIB_SKY
#include "lib/variants.glsl"

#if LUCERNA_SUN
uniform samplerBuffer sun_cells;
uniform samplerBuffer sun_density;
#endif

// Radiance arriving from a direction. Densities per solid angle: of the sky's samples, without the selection probability of
// the sky, which depends on the vertex; of the sun's, including its probability among the lights other than the sky.
struct Environment {
  vec3 sky, sun;
  float pdf_sky, pdf_sun;
};
Environment environment_radiance(vec3 d) {
  EnvironmentTexels t = environment_texels_at(d);
  Environment e;
  e.pdf_sky = abs(t.density);
#if LUCERNA_SUN
  bvec4 sun = lessThan(floatBitsToInt(vec4(t.a.w, t.b.w, t.c.w, t.d.w)), ivec4(0));
  vec3 none = vec3(0.0);
  e.sky = environment_mix(sun.x ? none : t.a.rgb, sun.y ? none : t.b.rgb, sun.z ? none : t.c.rgb, sun.w ? none : t.d.rgb, t.f);
  e.sun = environment_mix(sun.x ? t.a.rgb : none, sun.y ? t.b.rgb : none, sun.z ? t.c.rgb : none, sun.w ? t.d.rgb : none, t.f);
  e.pdf_sun = texelFetch(sun_density, t.texel >> 2)[t.texel & 3];
#else
  e.sky = environment_mix(t.a.rgb, t.b.rgb, t.c.rgb, t.d.rgb, t.f);
  e.sun = vec3(0.0);
  e.pdf_sun = 0.0;
#endif
  return e;
}

// A cell of the sky, or one of the sun's `count`.
uint sky_or_sun_cell(bool sky, uint count, uvec2 bits) {
  float pmf;
  uint cell = alias_choose(environment_alias, frame.environment_width * frame.environment_height, bits, pmf);
#if LUCERNA_SUN
  uint of_sun = alias_choose(sun_cells, sky ? 1u : count, bits, pmf);
  of_sun = floatBitsToUint(texelFetch(sun_cells, int(sky ? 0u : count + of_sun)).x);
  return sky ? cell : of_sun;
#else
  return cell;
#endif
}
#endif
