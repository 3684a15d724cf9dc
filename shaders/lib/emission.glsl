// Light paths begin here: one light in proportion to its power, a place on it, and a direction, each with the distribution of
// the light's own emission, so that paths carry equal flux wherever the light has no texture. Densities: of places per area
// (on the disk that covers the scene for what comes from afar; 1 of a point), of directions per solid angle (1 of a
// directional light). flux = radiance cos / (pmf pdf_place pdf_direction), or what stands for the radiance of a point.
#ifndef LUCERNA_LIB_EMISSION
#define LUCERNA_LIB_EMISSION
#include "lib/variants.glsl"
#include "shaders/shared/emission.h"
#include "lib/surface.glsl"
#include "lib/lights.glsl"

layout(scalar) readonly buffer EmissionBlock { EmissionTable emission; };
#if LUCERNA_LIGHTS
uniform samplerBuffer emission_alias;
#endif

struct Emission {
  vec3 origin;
  vec3 direction;      // unit
  vec3 flux;           // [W] that a path alone would carry; 0: nothing is emitted there
  float pmf;           // of the light
  float pdf_place, pdf_direction;
  uint light;          // entry of emission_alias
};

// Random numbers of light path `index` of a round. All paths of a round share the sequences, so that each of their decisions
// is stratified over the round; rounds are independent of each other. Pads: those of a vertex, of which depth 0 is the
// emission.
Sampler make_light_sampler(uint index, uint round, uint seed) {
  Sampler s;
  s.key = hash_combine(hash_mix(seed + 0x7c3a1f45u), round);
  s.index = index;
#if LUCERNA_COHERENT
  s.pixel_key = 0u;
#endif
  return s;
}

// A point of the disk across `direction` that the whole scene can be seen through, before the scene.
vec3 emission_disk(vec3 direction, vec2 u) {
  vec3 t, b;
  make_basis(direction, t, b);
  vec2 d = sample_disk(u);
  return emission.centre + emission.radius * (d.x * t + d.y * b - direction);
}

#if LUCERNA_LIGHTS
// A spot's direction in proportion to its intensity, by 1 - cosine from the axis, of which nothing cancels.
vec3 emission_spot(vec3 axis, float cos_inner, float cos_outer, vec2 u, float coin, out float solid_angle) {
  float width = max(cos_inner - cos_outer, 1e-4), reach = 1.0 - cos_outer;
  float ramp = min(1.0, reach / width), within = max(0.0, reach - width), beyond = width * ramp * ramp * ramp / 3.0;
  solid_angle = 2.0 * k_pi * (within + beyond);
  // In the ramp the intensity is the square of (cos - cos_outer) / width.
  float m = coin * (within + beyond) < within ? u.y * within : reach - width * ramp * pow(u.y, 1.0 / 3.0);
  float s = sqrt(max(0.0, m * (2.0 - m))), phi = 2.0 * k_pi * u.x;
  vec3 t, b;
  make_basis(axis, t, b);
  return normalize(s * (cos(phi) * t + sin(phi) * b) + (1.0 - m) * axis);
}

#if LUCERNA_EMISSIVE
// Radiance of the triangle's side `n` at a point, with texture and coverage.
vec3 emission_surface(uint primitive, vec3 p, vec3 n, float size, vec3 plain) {
#if LUCERNA_LIGHT_SURFACE
  Ray ray;
  ray.origin = p + size * n;
  ray.direction = -n;
  ray.tmax = k_infinity;
  ray.slot = 0u;
  Hit hit;
  hit.t = size;
  hit.prim = primitive;
  hit.u = 0.0;
  hit.v = 0.0;
  Surface s = make_surface(ray, hit);
  return s.emission * surface_coverage(s);
#else
  return plain;
#endif
}
#endif

// choice: which light, and a coin; u_place, u_direction, detail: 64 bits (environment).
Emission sample_emission(uvec2 choice, vec2 u_place, vec2 u_direction, uvec2 detail) {
  Emission e;
  e.light = alias_choose(emission_alias, emission.count, uvec2(choice.x, hash_mix(choice.x)), e.pmf);
  float coin = float(choice.y >> 8) * (1.0 / 16777216.0);
  bool sky = e.light == emission.sky;
  int at = int((sky ? 0u : e.light) * k_light_texels);
  vec4 a = texelFetch(scene_lights, at), b = texelFetch(scene_lights, at + 1), c = texelFetch(scene_lights, at + 2);
  uint kind = sky ? k_light_environment : floatBitsToUint(a.w);
  float disk = k_pi * emission.radius * emission.radius;
  // Point: evenly over the sphere.
  float z = 1.0 - 2.0 * u_direction.y, r = sqrt(max(0.0, 1.0 - z * z)), phi = 2.0 * k_pi * u_direction.x;
  e.origin = a.xyz;
  e.direction = normalize(vec3(r * cos(phi), r * sin(phi), z));
  e.pdf_place = 1.0;
  e.pdf_direction = 0.25 * k_inv_pi;
  vec3 emitted = b.xyz;   // over all densities but the selection's
  float spread = 4.0 * k_pi;
  if (kind == k_light_spot) {
    e.direction = emission_spot(c.xyz, b.w, c.w, u_direction, coin, spread);
    float fade = clamp((dot(e.direction, c.xyz) - c.w) / max(b.w - c.w, 1e-4), 0.0, 1.0);
    e.pdf_direction = fade * fade / spread;
  }
  if (kind == k_light_directional) {
    e.direction = c.xyz;
    e.origin = emission_disk(e.direction, u_place);
    e.pdf_place = 1.0 / disk;
    e.pdf_direction = 1.0;
    spread = disk;
  }
#if LUCERNA_EMISSIVE
  if (kind == k_light_triangle) {
    vec3 p0 = a.xyz, p1 = b.xyz, p2 = c.xyz;
    vec4 plain = texelFetch(scene_lights, at + 3);
    uint sides = floatBitsToUint(plain.w);
    bool both = (sides & k_light_both_sides) != 0u;
    // Evenly over the triangle (Heitz 2019), by the cosine about the side's normal.
    vec2 m = 0.5 * u_place;
    float offset = m.y - m.x;
    m += offset > 0.0 ? vec2(0.0, offset) : vec2(-offset, 0.0);
    vec3 n = cross(p1 - p0, p2 - p0);
    n = normalize(n / max(max3(abs(n)), 1e-37));
    vec3 front = (sides & k_light_flipped) != 0u ? -n : n;
    n = both && coin < 0.5 ? -front : front;
    vec3 t, s;
    make_basis(n, t, s);
    vec3 local = sample_cosine(u_direction);
    e.direction = normalize(local.x * t + local.y * s + local.z * n);
    float halves = both ? 2.0 : 1.0;
    e.pdf_place = 1.0 / (b.w * halves);
    e.pdf_direction = local.z * k_inv_pi;
    Surface there;
    there.position = m.x * p0 + m.y * p1 + (1.0 - m.x - m.y) * p2;
    there.normal_g = n;
    there.offset = error_gamma(8.0) * (abs(p0) + abs(p1) + abs(p2)) + vec3(error_gamma(16.0) * max(max3(abs(p1 - p0)), max3(abs(p2 - p0))));
    e.origin = offset_origin(there, e.direction);
    emitted = emission_surface(floatBitsToUint(c.w), there.position, n, sqrt(b.w), plain.rgb);
    spread = k_pi * b.w * halves;
  }
#endif
#if LUCERNA_ENVIRONMENT_MAP
  if (kind == k_light_environment) {
    vec3 towards;
#if LUCERNA_SKY_APART
    towards = environment_in_cell(sky_or_sun_cell(sky, floatBitsToUint(b.x), detail), u_direction);
    Environment around = environment_radiance(towards);
    emitted = sky ? around.sky : around.sun;
    e.pdf_direction = sky ? around.pdf_sky : around.pdf_sun / max(emission.sun_pmf, 1e-30);
#else
    float texel_pmf;
    uint cells = frame.environment_width * frame.environment_height;
    towards = environment_in_cell(alias_choose(environment_alias, cells, detail, texel_pmf), u_direction);
    emitted = environment_radiance(towards, e.pdf_direction);
    e.pdf_direction /= max(frame.environment_light_pmf, 1e-30);
#endif
    e.direction = -towards;
    e.origin = emission_disk(e.direction, u_place);
    e.pdf_place = 1.0 / disk;
    spread = e.pdf_direction > 0.0 ? disk / e.pdf_direction : 0.0;
  }
#endif
  e.flux = emitted * (spread / max(e.pmf, 1e-30));
  return e;
}
#endif
#endif
