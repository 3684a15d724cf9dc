// Emission of light paths: samples a light in proportion to its power, a place on it, and a direction, each by the light's
// own emission, so that paths carry equal flux except for textures. Densities: of places per area (for distant light on the
// disk that covers the scene; 1 for a point), of directions per solid angle (1 for a directional light). flux = radiance cos
// / (pmf pdf_place pdf_direction), with the corresponding quantity for points.
//
// With casters (lib/aim.glsl), a share of the paths is aimed at them, and the density is that of all strategies together
// (balance heuristic of E. Veach and L. Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995,
// for one sample):
//   share_0 pmf pdf_place pdf_direction + sum over casters  share_c pmf_in_group pdf_place pdf_towards_c
// in the same measure. Shares and boxes do not change the mean.
#ifndef LUCERNA_LIB_EMISSION
#define LUCERNA_LIB_EMISSION
#include "lib/variants.glsl"
#include "shaders/shared/emission.h"
#include "lib/surface.glsl"
#include "lib/lights.glsl"
#include "lib/aim.glsl"

layout(scalar) readonly buffer EmissionBlock { EmissionTable emission; };
#if LUCERNA_LIGHTS
uniform samplerBuffer emission_alias;
uniform samplerBuffer emission_strata;
uniform samplerBuffer emission_boxes;
uniform samplerBuffer emission_groups;
uniform samplerBuffer emission_members;
#endif

struct Emission {
  vec3 origin;
  vec3 direction;      // unit
  vec3 flux;           // [W] that a path alone would carry; 0: nothing is emitted there
  float pmf;           // of the light; this and the next two without aiming
  float pdf_place, pdf_direction;
  uint light;          // entry of emission_alias
  uint stratum;        // stratum of the sample
  float unaimed;       // unaimed share of its density, 0..1
  uint group;          // light group, if groups are separate
  bool afar;           // starts on the disk of the scene
  float radiance;      // luminance of what a ray meets there; 0: none meets it (points, directions)
  float sampling;      // density of light samples there: over the squared distance, or for distant light, the luminance of
                       // a sample over the flux of the path
};

// Random numbers of light path `index` of a round. All paths of a round share the sequences, so each decision is stratified
// over the round; rounds are independent. Pads as for vertices; depth 0 is the emission.
Sampler make_light_sampler(uint index, uint round, uint seed) {
  Sampler s;
  s.key = hash_combine(hash_mix(seed + 0x7c3a1f45u), round);
  s.index = index;
#if LUCERNA_COHERENT
  s.pixel_key = 0u;
#endif
  return s;
}

// A point on the disk across `direction` in front of the scene, which covers the whole scene. If there are distant outliers,
// a share of the points lies on the disk of the core, which would otherwise get few.
vec3 emission_disk(vec3 direction, vec2 u) {
  vec3 t, b;
  make_basis(direction, t, b);
  bool core = u.x < emission.core_share;
  u.x = core ? u.x / emission.core_share : (u.x - emission.core_share) / (1.0 - emission.core_share);
  vec2 d = sample_disk(u);
  if (!core) return emission.centre + emission.radius * (d.x * t + d.y * b - direction);
  vec3 through = emission.core_centre + emission.core_radius * (d.x * t + d.y * b);
  return through - direction * (dot(through - emission.centre, direction) + emission.radius);
}
// Density of that point per area.
float emission_disk_pdf(vec3 direction, vec3 origin) {
  float pdf = (1.0 - emission.core_share) / (k_pi * emission.radius * emission.radius);
  vec3 off = origin - emission.core_centre, across = off - dot(off, direction) * direction;
  bool core = emission.core_share > 0.0 && dot(across, across) <= emission.core_radius * emission.core_radius;
  return core ? pdf + emission.core_share / (k_pi * emission.core_radius * emission.core_radius) : pdf;
}

// Likewise, for a path through a box.
vec3 emission_from_afar(vec3 direction, vec2 u, bool aims, Box box) {
  vec3 through = aim_sample_afar(box, direction, u);
  vec3 aimed = through - direction * (dot(through - emission.centre, direction) + emission.radius);
  return aims ? aimed : emission_disk(direction, u);
}

#if LUCERNA_LIGHTS
// Direction of a spot in proportion to its intensity, in terms of 1 - cosine from the axis, which avoids cancellation.
vec3 emission_spot(vec3 axis, float cos_inner, float cos_outer, vec2 u, uint coin, out float solid_angle) {
  float width = max(cos_inner - cos_outer, 1e-4), reach = 1.0 - cos_outer;
  float ramp = min(1.0, reach / width), within = max(0.0, reach - width), beyond = width * ramp * ramp * ramp / 3.0;
  solid_angle = 2.0 * k_pi * (within + beyond);
  // In the ramp the intensity is the square of (cos - cos_outer) / width.
  float m = coin_below(coin, within / (within + beyond)) ? u.y * within : reach - width * ramp * pow(u.y, 1.0 / 3.0);
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

Box emission_box(uint caster) {
  return Box(texelFetch(emission_boxes, int(2u * caster)).xyz, texelFetch(emission_boxes, int(2u * caster + 1u)).xyz);
}

// Samples a light of a group, as alias_choose().
uint emission_choose_in(uint group, uvec2 bits) {
  uvec2 header = floatBitsToUint(texelFetch(emission_groups, int(group)).xy);
  uint i, fraction, more, lost, carry;
  umulExtended(bits.x, header.y, i, fraction);
  umulExtended(bits.y, header.y, more, lost);
  fraction = uaddCarry(fraction, more, carry);
  i += carry;
  vec4 member = texelFetch(emission_members, int(header.x + i));
  i = coin_below(fraction, member.x) ? i : floatBitsToUint(member.y);
  return floatBitsToUint(texelFetch(emission_groups, int(emission.groups + emission.count + header.x + i)).x);
}

// Stratum of path `random` in a round with `step` = 2^32 / paths. Strata are intervals of 0 ... 2^32, over which paths are
// spaced evenly from a random offset. Each stratum thus gets its exact share of paths, and its paths are consecutive, like
// well-distributed points.
uint emission_stratum(Sampler random, uint step) {
  uint at = random.index * step + hash_combine(random.key, 0x5bd1e995u);
  uint low = 0u, high = emission.groups * emission.casters;
  while (low < high) {
    uint middle = (low + high + 1u) >> 1;
    bool below = floatBitsToUint(texelFetch(emission_strata, int(middle)).x) > at;
    high = below ? middle - 1u : high;
    low = below ? low : middle;
  }
  return low;
}
float emission_share(uint stratum) { return texelFetch(emission_strata, int(stratum)).y; }

// Density of the path over that of unaimed emission: share_0 + ..., see above. `place`: where a local light emits; distant
// light passes through it in direction e.direction.
float emission_density(Emission e, bool afar, vec3 place) {
  uvec2 member = floatBitsToUint(texelFetch(emission_groups, int(emission.groups + e.light)).xy);
  uint first = floatBitsToUint(texelFetch(emission_groups, int(member.x)).x);
  float within = texelFetch(emission_members, int(first + member.y)).z, aimed = 0.0;
  for (uint c = 0u; c < emission.casters; ++c) {
    uint stratum = 1u + member.x * emission.casters + c;
    float share = emission_share(stratum);
    float density = afar ? aim_pdf_afar(emission_box(c), place, e.direction, stratum == e.stratum)
                         : aim_pdf(emission_box(c), place, e.direction, e.pdf_direction, stratum == e.stratum);
    aimed += share * density;
  }
  float own = afar ? e.pdf_place : e.pdf_direction;
  return emission_share(0u) + aimed * within / max(e.pmf * own, 1e-37);
}

// choice: which light, and a coin; u_place, u_direction, detail: 64 bits (environment). `stratum`: emission_stratum().
Emission sample_emission(uvec2 choice, vec2 u_place, vec2 u_direction, uvec2 detail, uint stratum) {
  Emission e;
  e.stratum = stratum;
  e.light = alias_choose(emission_alias, emission.count, uvec2(choice.x, hash_mix(choice.x)), e.pmf);
  Box box = Box(vec3(0.0), vec3(0.0));
  if (stratum > 0u) {
    uint group = (stratum - 1u) / emission.casters;
    box = emission_box((stratum - 1u) - group * emission.casters);
    e.light = emission_choose_in(group, uvec2(choice.x, hash_mix(choice.x)));
    e.pmf = texelFetch(emission_alias, int(e.light)).z;
  }
  uint coin = choice.y;
  bool sky = e.light == emission.sky;
  int at = int((sky ? 0u : e.light) * k_light_texels);
  vec4 a = texelFetch(scene_lights, at), b = texelFetch(scene_lights, at + 1), c = texelFetch(scene_lights, at + 2);
  e.group = 0u;
#if LUCERNA_LIGHT_GROUPS > 1
  e.group = group_of_light(at, sky);
#endif
  uint kind = sky ? k_light_environment : floatBitsToUint(a.w);
  // Point: uniform over the sphere.
  float z = 1.0 - 2.0 * u_direction.y, r = sqrt(max(0.0, 1.0 - z * z)), phi = 2.0 * k_pi * u_direction.x;
  e.origin = a.xyz;
  e.direction = normalize(vec3(r * cos(phi), r * sin(phi), z));
  e.pdf_place = 1.0;
  e.pdf_direction = 0.25 * k_inv_pi;
  e.radiance = 0.0;
  vec3 emitted = b.xyz;   // over all densities except the selection's
  float spread = 4.0 * k_pi;
  // Aimed: towards the caster, unless the light is inside its box.
  vec3 aimed_direction = e.direction;
  bool has_area = kind == k_light_triangle || (kind >= k_light_sphere && kind <= k_light_tube);
  bool aims = stratum > 0u && !has_area && aim_sample(box, a.xyz, u_direction, aimed_direction);
  vec3 place = a.xyz;
  if (kind == k_light_point) e.direction = aims ? aimed_direction : e.direction;
  if (kind == k_light_spot) {
    e.direction = emission_spot(c.xyz, b.w, c.w, u_direction, coin, spread);
    e.direction = aims ? aimed_direction : e.direction;
    e.pdf_direction = spot_share(dot(e.direction, c.xyz), b.w, c.w) / spread;
  }
#if LUCERNA_PROFILES
  if (kind == k_light_profile) {
    vec4 d = texelFetch(scene_lights, at + 3);
    Profile profile = light_profile(floatBitsToUint(d.w));
    vec3 own = sample_profile(profile, c.xyz, d.xyz, uvec2(coin, hash_mix(coin)), u_direction);
    e.direction = aims ? aimed_direction : own;
    float share = profile_share(profile, c.xyz, d.xyz, e.direction, e.pdf_direction);
    spread = e.pdf_direction > 0.0 ? share / e.pdf_direction : 0.0;
  }
#endif
#if LUCERNA_PICTURES
  if (kind == k_light_projector) {
    Picture picture = light_picture(b, c, texelFetch(scene_lights, at + 3));
    vec3 own = sample_picture(picture, uvec2(coin, hash_mix(coin)), u_direction);
    e.direction = aims ? aimed_direction : own;
    emitted *= picture_share(picture, e.direction, e.pdf_direction);
    spread = e.pdf_direction > 0.0 ? 1.0 / e.pdf_direction : 0.0;
  }
#endif
  bool afar = kind == k_light_directional || kind == k_light_environment;
  e.afar = afar;
  if (kind == k_light_directional) {
    e.direction = c.xyz;
    e.origin = emission_from_afar(e.direction, u_place, stratum > 0u, box);
    e.pdf_place = emission_disk_pdf(e.direction, e.origin);
    e.pdf_direction = 1.0;
    spread = 1.0 / e.pdf_place;
  }
#if LUCERNA_SHAPES
  if (is_shape(kind)) {
    LampShape shape = lamp_shape(a, b, c, texelFetch(scene_lights, at + 3));
    vec3 n, t, s;
    place = shape_place(shape, u_place, coin_below(coin, 0.5), n);
    make_basis(n, t, s);
    vec3 local = sample_cosine(u_direction);
    e.origin = place;
    e.direction = normalize(local.x * t + local.y * s + local.z * n);
    e.pdf_place = 1.0 / shape_area(shape);
    e.pdf_direction = local.z * k_inv_pi;
    if (stratum > 0u && aim_sample(box, place, u_direction, aimed_direction)) {
      e.direction = aimed_direction;
      e.pdf_direction = max(0.0, dot(e.direction, n)) * k_inv_pi;
    }
    emitted = shape.radiance;
    e.radiance = luminance(emitted);
    spread = k_pi * shape_area(shape);
  }
#endif
#if LUCERNA_EMISSIVE
  if (kind == k_light_triangle) {
    vec3 p0 = a.xyz, p1 = b.xyz, p2 = c.xyz;
    vec4 plain = texelFetch(scene_lights, at + 3);
    uint sides = floatBitsToUint(plain.w);
    bool both = (sides & k_light_both_sides) != 0u;
    // Uniform over the triangle (Heitz 2019), cosine-distributed about the side's normal.
    vec2 m = 0.5 * u_place;
    float offset = m.y - m.x;
    m += offset > 0.0 ? vec2(0.0, offset) : vec2(-offset, 0.0);
    vec3 n = cross(p1 - p0, p2 - p0);
    n = normalize(n / max(max3(abs(n)), 1e-37));
    vec3 front = (sides & k_light_flipped) != 0u ? -n : n;
    n = both && coin_below(coin, 0.5) ? -front : front;
    vec3 t, s;
    make_basis(n, t, s);
    vec3 local = sample_cosine(u_direction);
    e.direction = normalize(local.x * t + local.y * s + local.z * n);
    float halves = both ? 2.0 : 1.0;
    e.pdf_place = 1.0 / (b.w * halves);
    e.pdf_direction = local.z * k_inv_pi;
    Surface there;
    there.position = m.x * p0 + m.y * p1 + (1.0 - m.x - m.y) * p2;
    place = there.position;
    if (stratum > 0u && aim_sample(box, place, u_direction, aimed_direction)) {
      e.direction = aimed_direction;
      e.pdf_direction = max(0.0, dot(e.direction, n)) * k_inv_pi;
    }
    there.normal_g = n;
    there.offset = error_gamma(8.0) * (abs(p0) + abs(p1) + abs(p2)) + vec3(error_gamma(16.0) * max(max3(abs(p1 - p0)), max3(abs(p2 - p0))));
    e.origin = offset_origin(there, e.direction);
    emitted = emission_surface(floatBitsToUint(c.w), there.position, n, sqrt(b.w), plain.rgb);
    e.radiance = luminance(emitted);
    spread = k_pi * b.w * halves;
  }
#endif
#if LUCERNA_ENVIRONMENT_MAP
  if (kind == k_light_environment) {
    vec3 towards;
#if LUCERNA_SEPARATE_SKY
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
    e.radiance = luminance(emitted);
    e.direction = -towards;
    e.origin = emission_from_afar(e.direction, u_place, stratum > 0u, box);
    e.pdf_place = emission_disk_pdf(e.direction, e.origin);
    spread = e.pdf_direction > 0.0 ? 1.0 / (e.pdf_place * e.pdf_direction) : 0.0;
  }
#endif
  e.flux = emitted * (spread / max(e.pmf, 1e-30));
  e.unaimed = 1.0;
  // A light sample contributes f cos radiance cos / (pmf pdf_place distance^2), for points f cos intensity / (pmf
  // distance^2), for distant light f cos radiance / (pmf pdf_direction).
  e.sampling = afar ? e.pdf_place : e.pdf_direction;
  if (emission.casters > 0u) {
    float density = max(emission_density(e, afar, afar ? e.origin : place), 1e-30);
    // Paths aimed past the scene's disk are light that no unaimed path carries.
    vec3 off = e.origin - emission.centre;
    vec3 across = off - dot(off, e.direction) * e.direction;
    bool sent = e.pdf_direction > 0.0 && (!afar || dot(across, across) <= emission.radius * emission.radius);
    e.flux = sent ? e.flux / density : vec3(0.0);
    e.unaimed = emission_share(0u) / density;
    e.sampling *= density;
  }
  return e;
}

// Start of path `random`; `step`: see emission_stratum().
Emission sample_emission(Sampler random, uint step) {
  return sample_emission(sample_vertex_bits(random, 0u, k_pad_light_choice), sample_vertex(random, 0u, k_pad_light_uv),
                         sample_vertex(random, 0u, k_pad_direction), sample_vertex_bits(random, 0u, k_pad_light_detail),
                         emission_stratum(random, step));
}
#endif
#endif
