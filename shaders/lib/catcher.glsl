// Shadow catchers: surfaces that look like what is behind them, darkened where other surfaces take light from them and
// brightened where those reflect or focus light onto them. Seen directly, also in mirrors and through glass, a catcher is a
// diffuse surface of the colour pi L / E: L is the environment's radiance behind it, E the irradiance of environment and lamps
// without anything in between; where nothing is in between, it shows L. To all other paths and to shadow rays it is not there,
// so that objects are lit from below by the environment's picture.
//
// E: the environment's by a table over normals, lamps' exactly, those with a shape as if from their middle. Emitting surfaces
// are objects: their light brightens the catcher.
#ifndef LUCERNA_LIB_CATCHER
#define LUCERNA_LIB_CATCHER
#include "lib/surface.glsl"
#include "lib/lights.glsl"

uniform samplerBuffer environment_irradiance;

vec3 unoccluded_environment(vec3 normal) {
#if LUCERNA_ENVIRONMENT_MAP
  ivec2 size = ivec2(k_irradiance_width, k_irradiance_height);
  vec2 at = environment_uv(normal) * vec2(size) - 0.5;
  ivec2 i = ivec2(floor(at));
  vec2 f = at - vec2(i);
  int x0 = (i.x + size.x) % size.x, x1 = (i.x + 1) % size.x;
  int y0 = clamp(i.y, 0, size.y - 1) * size.x, y1 = clamp(i.y + 1, 0, size.y - 1) * size.x;
  vec3 upper = mix(texelFetch(environment_irradiance, y0 + x0).rgb, texelFetch(environment_irradiance, y0 + x1).rgb, f.x);
  vec3 lower = mix(texelFetch(environment_irradiance, y1 + x0).rgb, texelFetch(environment_irradiance, y1 + x1).rgb, f.x);
  return frame.environment_radiance * mix(upper, lower, f.y);
#else
  return k_pi * frame.environment_radiance;
#endif
}

vec3 background(vec3 direction) {
#if LUCERNA_SEPARATE_SKY
  Environment e = environment_radiance(direction);
  return e.sky + e.sun;
#else
  float pdf;
  return environment_radiance(direction, pdf);
#endif
}

// Its colour, seen along `direction`.
vec3 catcher_color(Surface s, vec3 direction) {
  vec3 n = dot(s.normal_s, direction) > 0.0 ? -s.normal_s : s.normal_s;
  vec3 light = unoccluded_environment(n);
#if LUCERNA_LIGHTS
  for (uint lamp = frame.first_lamp; lamp < frame.first_lamp + frame.lamp_count; ++lamp) light += lamp_arrives(lamp, s.position, n, 0.0);
#endif
  return k_pi * background(direction) / max(light, vec3(1e-20)) * vec3(greaterThan(light, vec3(0.0)));
}
#endif
