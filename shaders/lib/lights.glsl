// Light sampling: selects a light by its probability mass (alias method, Walker 1977; Vose 1991), then a point on it.
// Densities are per solid angle at the shaded point and include the selection.
//
// Among many lamps only few light a given point, and power does not identify them. A selected lamp is therefore resampled from
// several candidates, by their unoccluded contribution (resampled importance sampling, J. Talbot, D. Cline and P. Egbert
// 2005): for candidates x_i of density p and contributions q, x_i is selected in proportion to q(x_i) / p(x_i), with the
// effective density q(x) M / sum q(x_i) / p(x_i). Unbiased for any q > 0 where light arrives; evenly spaced instead of
// independent candidates do not change the mean.
#ifndef LUCERNA_LIB_LIGHTS
#define LUCERNA_LIB_LIGHTS
#include "lib/variants.glsl"
#include "lib/frame.glsl"
#include "lib/reservoir.glsl"
#include "lib/sampler.glsl"
#include "lib/hash.glsl"
#if LUCERNA_SHAPES
#include "lib/shapes.glsl"
#endif
#if LUCERNA_PROFILES
#include "lib/profiles.glsl"
#endif
#if LUCERNA_PICTURES
#include "lib/pictures.glsl"
#endif

#if LUCERNA_LIGHTS
uniform samplerBuffer scene_lights;
uniform samplerBuffer light_alias;
#endif
#if LUCERNA_EMISSIVE
layout(scalar) readonly buffer PrimitiveLightPmf { float primitive_light_pmf[]; };  // pmf / area [1/m^2]
#endif
#if LUCERNA_LEARNED
#include "lib/learned_lights.glsl"
#endif
#if LUCERNA_ENVIRONMENT_MAP
uniform samplerBuffer environment_texels;
uniform samplerBuffer environment_alias;
#endif

#if LUCERNA_LIGHT_GROUPS > 1 && (LUCERNA_EMISSIVE || LUCERNA_UNLIT)
uniform samplerBuffer emissive_groups;  // a byte a primitive
uint emissive_group(uint primitive) {
  uvec4 words = floatBitsToUint(texelFetch(emissive_groups, int(primitive >> 4)));
  return words[primitive >> 2 & 3u] >> 8u * (primitive & 3u) & 0xffu;
}
#endif

struct LightSample {
  vec3 direction;    // unit, towards the light
  float distance;    // metres; infinite for directional lights and the environment
  vec3 radiance;     // for point and directional lights: irradiance on a facing plane; for triangles: without textures
  float pdf;         // per solid angle, including the selection; for delta lights: (effective) probability of the selection
  bool delta;
  uint primitive;    // emissive triangle, or k_no_hit
  vec2 uv;           // barycentrics there
  vec3 target;       // point on the triangle
  vec3 normal;       // of the triangle, unit, towards the shaded point
  vec3 offset;       // error bound of target, as Surface::offset
  bool sky;          // sample of a separate sky
  uint group;        // light group
#if LUCERNA_LEARNED || LUCERNA_SHAPES
  float factor;      // weight of the sample: pdf over its effective density after resampling
#endif
#if LUCERNA_PATH_EVENTS
  uint entry;        // of the light table
#endif
#if LUCERNA_LEARNED
  uint cluster;      // light cluster
  float chosen;      // probability of that
#if LUCERNA_SKY_PORTALS
  float own;         // of a sample of the sky: density of the cluster alone, without that of other clusters
#endif
#endif
};

// `bits`: 64 uniform random bits, higher ones first. They select the entry, and the remainder decides between it and its
// alias: 32 bits would leave only 8 for a table of 10^7 entries, and the rounding would affect a sun's probability.
uint alias_choose(samplerBuffer table, uint begin, uint count, uvec2 bits, out float pmf) {
  uint i, fraction, more, lost, carry;
  umulExtended(bits.x, count, i, fraction);
  umulExtended(bits.y, count, more, lost);
  fraction = uaddCarry(fraction, more, carry);
  i += carry;
  vec4 e = texelFetch(table, int(begin + i));
  bool first = coin_below(fraction, e.x);
  pmf = first ? e.z : e.w;
  return first ? i : floatBitsToUint(e.y);
}
uint alias_choose(samplerBuffer table, uint count, uvec2 bits, out float pmf) { return alias_choose(table, 0u, count, bits, pmf); }

#if LUCERNA_ENVIRONMENT_MAP
// u = 0.5 + atan2(z, x) / 2pi, v = acos(y) / pi from the top; the map is rotated counter-clockwise seen from above, which
// takes a direction at azimuth phi = atan2(z, x) to phi - rotation.
vec2 environment_uv(vec3 d) {
  float phi = atan(d.z, d.x) + frame.environment_rotation;
  return vec2(fract(0.5 + phi * (0.5 * k_inv_pi)), atan(length(d.xz), d.y) * k_inv_pi);
}
vec3 environment_direction(vec2 uv) {
  float phi = (uv.x - 0.5) * 2.0 * k_pi - frame.environment_rotation, theta = uv.y * k_pi;
  return vec3(sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi));
}
#endif

#if LUCERNA_ENVIRONMENT_MAP
// The map in a direction: the four texels around it, and the texel that contains it.
struct EnvironmentTexels {
  vec4 a, b, c, d;  // upper left and right, lower left and right
  vec2 f;           // from a to d
  int texel;
  float density;    // sampling density of its directions, per solid angle
  float u;          // across the map
};
EnvironmentTexels environment_texels_at(vec3 direction) {
  EnvironmentTexels t;
  ivec2 size = ivec2(frame.environment_width, frame.environment_height);
  vec2 uv = environment_uv(direction);
  vec2 at = uv * vec2(size) - 0.5;
  ivec2 i = ivec2(floor(at));
  t.f = at - vec2(i);
  int x0 = (i.x + size.x) % size.x, x1 = (i.x + 1) % size.x;
  int y0 = clamp(i.y, 0, size.y - 1), y1 = clamp(i.y + 1, 0, size.y - 1);
  t.a = texelFetch(environment_texels, y0 * size.x + x0), t.b = texelFetch(environment_texels, y0 * size.x + x1);
  t.c = texelFetch(environment_texels, y1 * size.x + x0), t.d = texelFetch(environment_texels, y1 * size.x + x1);
  ivec2 cell = clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1);
  t.texel = cell.y * size.x + cell.x;
  // The containing texel is one of the four.
  vec2 column = cell.x == x0 ? vec2(t.a.w, t.c.w) : vec2(t.b.w, t.d.w);
  t.density = cell.y == y0 ? column.x : column.y;
  t.u = uv.x;
  return t;
}
vec3 environment_mix(vec3 a, vec3 b, vec3 c, vec3 d, vec2 f) {
  return frame.environment_radiance * mix(mix(a, b, f.x), mix(c, d, f.x), f.y);
}
// A uniform direction within a texel of the map, by sin^2 of half the angle to the nearer pole: near a pole all cosines
// round to 1.
vec3 environment_in_cell(uint cell, vec2 u) {
  uint column = cell % frame.environment_width, row = cell / frame.environment_width;
  bool lower = 2u * row >= frame.environment_height;
  uint from_pole = lower ? frame.environment_height - 1u - row : row;
  float half_row = 0.5 * k_pi / float(frame.environment_height);
  float s = mix(square(sine(half_row * float(from_pole))), square(sine(half_row * float(from_pole + 1u))), lower ? 1.0 - u.y : u.y);
  float y = lower ? 2.0 * s - 1.0 : 1.0 - 2.0 * s;
  float sin_theta = 2.0 * sqrt(max(0.0, s * (1.0 - s)));
  float phi = ((float(column) + u.x) / float(frame.environment_width) - 0.5) * 2.0 * k_pi - frame.environment_rotation;
  return vec3(sin_theta * cos(phi), y, sin_theta * sin(phi));
}
#endif

#if LUCERNA_SEPARATE_SKY
#include "lib/sky.glsl"
#else
// Radiance arriving from direction -d, and the density with which sample_light samples d, without portals.
vec3 environment_radiance(vec3 d, out float pdf) {
  pdf = 0.0;
#if LUCERNA_ENVIRONMENT_MAP
  EnvironmentTexels t = environment_texels_at(d);
  pdf = frame.environment_light_pmf * t.density;
  return environment_mix(t.a.rgb, t.b.rgb, t.c.rgb, t.d.rgb, t.f);
#else
  return frame.environment_radiance;
#endif
}
#if LUCERNA_LEARNED && LUCERNA_ENVIRONMENT_MAP
// ... with light selection by the row of a place.
vec3 environment_radiance(vec3 d, uint row, out float pdf) {
  EnvironmentTexels t = environment_texels_at(d);
  pdf = frame.environment_light_pmf * t.density * learned_ratio(row, sky_cluster(d, uint(t.texel), t.u));
  return environment_mix(t.a.rgb, t.b.rgb, t.c.rgb, t.d.rgb, t.f);
}
#endif
#if LUCERNA_SKY_PORTALS
#include "lib/portals.glsl"
// Density with which sample_light samples a direction at `position`: the sum over all strategies that sample it. `pdf`:
// that of environment_radiance(). `portal`: one whose own density is known.
float with_portals(float pdf, vec3 position, vec3 direction, uint row, uint portal, float own) {
  float sum = 0.0;
  for (uint i = 0u; i < uint(LUCERNA_PORTALS); ++i) {
    // A loop instead of a branch: most directions pass through no portal or one.
    for (uint once = 0u; once < (i == portal || portal_near(i, position, direction) ? 1u : 0u); ++once) {
      float share = portal_share(i);
#if LUCERNA_LEARNED
      share *= learned_ratio(row, frame.sky_clusters - uint(LUCERNA_PORTALS) + i);
#endif
      sum += share * (i == portal ? own : portal_pdf(i, position, direction));
    }
  }
  return (1.0 - k_portal_share) * pdf + k_portal_share * frame.environment_light_pmf * sum;
}
#endif
#endif

#if LUCERNA_EMISSIVE
// Density with which sample_light samples the direction to a point on an emissive triangle.
float emissive_pdf(uint primitive, float distance2, float cos_light) {
  return primitive_light_pmf[primitive] * distance2 / max(cos_light, 1e-30);
}
#endif

#if LUCERNA_LIGHTS
// Falloff of a spot at that cosine to its axis: glTF's recommended one between the cones.
float spot_share(float cosine, float cos_inner, float cos_outer) {
  float fade = clamp((cosine - cos_outer) / max(cos_inner - cos_outer, 1e-4), 0.0, 1.0);
  return fade * fade;
}

#if LUCERNA_LIGHT_GROUPS > 1
// Group of the light whose texels begin at `at`, or of the sky.
uint group_of_light(int at, bool sky) {
  return sky ? frame.sky_group : floatBitsToUint(texelFetch(scene_lights, at + 3).w) >> k_light_group_shift & k_light_group_mask;
}
#endif

// Unoccluded light of a lamp on a surface with that normal [W/m^2], of lamps with a shape about as if from their middle.
// `least`: of the cosine.
vec3 lamp_arrives(uint lamp, vec3 position, vec3 normal, float least) {
  int at = int(lamp * k_light_texels);
  vec4 a = texelFetch(scene_lights, at), b = texelFetch(scene_lights, at + 1), c = texelFetch(scene_lights, at + 2);
  uint kind = floatBitsToUint(a.w);
  vec3 to = a.xyz - position;
  float d2 = max(dot(to, to), 1e-20);
  bool directional = kind == k_light_directional;
  vec3 direction = directional ? -c.xyz : to * inversesqrt(d2);
#if LUCERNA_SHAPES
  if (is_shape(kind)) {
    LampShape shape = lamp_shape(a, b, c, texelFetch(scene_lights, at + 3));
    float extent2 = dot(shape.half_size, shape.half_size);
    return b.xyz * (shape_facing(shape, -direction) / (d2 + extent2) * max(dot(direction, normal), least));
  }
#endif
#if LUCERNA_PROFILES
  if (kind == k_light_profile) {
    vec4 d = texelFetch(scene_lights, at + 3);
    float density, share = profile_share(light_profile(floatBitsToUint(d.w)), c.xyz, d.xyz, -direction, density);
    return b.xyz * (share / d2 * max(dot(direction, normal), least));
  }
#endif
#if LUCERNA_PICTURES
  if (kind == k_light_projector) {
    float density;
    vec3 share = picture_share(light_picture(b, c, texelFetch(scene_lights, at + 3)), -direction, density);
    return b.xyz * share * (max(dot(direction, normal), least) / d2);
  }
#endif
  float fall = directional ? 1.0 : (kind == k_light_spot ? spot_share(dot(-direction, c.xyz), b.w, c.w) : 1.0) / d2;
  return b.xyz * (fall * max(dot(direction, normal), least));
}
// Its luminance; a little even from behind, where surfaces may transmit light.
float lamp_sends(uint lamp, vec3 position, vec3 normal) { return luminance(lamp_arrives(lamp, position, normal, 0.05)); }

// Replaces a lamp by one resampled from candidates evenly spaced in the table of lamps, from `choice` on; u: in [0, 1). pmf:
// (effective) probability of the light.
uint draw_lamp(uint light, vec3 position, vec3 normal, uint choice, float u, inout float pmf) {
  const uint candidates = uint(LUCERNA_LAMP_CANDIDATES);
  bool is_lamp = light - frame.first_lamp < frame.lamp_count;
  uint drawn = light;
  float sends_drawn = 0.0;
  Reservoir drawing = Reservoir(u, 0.0);
  for (uint k = 0u; k < (is_lamp ? candidates : 0u); ++k) {
    uint bits = choice + k * (0xffffffffu / max(candidates, 1u));
    float p;
    uint lamp = frame.first_lamp + alias_choose(light_alias, frame.light_count, frame.lamp_count, uvec2(bits, hash_mix(bits)), p);
    float sends = lamp_sends(lamp, position, normal);
    bool taken = reservoir_draw(drawing, sends / max(p, 1e-30));
    // If no candidate contributes, one of these is used: another draw might find one that does.
    drawn = taken || drawing.total <= 0.0 ? lamp : drawn;
    sends_drawn = taken ? sends : sends_drawn;
  }
  pmf = drawing.total > 0.0 ? frame.lamp_pmf * sends_drawn * float(candidates) / drawing.total : pmf;
  return drawn;
}

#if LUCERNA_LEARNED
// Likewise within a cluster, with the probabilities without learning; a lamp's pmf is then multiplied by the cluster's
// ratio.
uint draw_lamp_of(LightCluster cluster, uint light, vec3 position, vec3 normal, uint choice, float u, float ratio, inout float pmf) {
  const uint candidates = uint(LUCERNA_LAMP_CANDIDATES);
  bool is_lamp = light - frame.first_lamp < frame.lamp_count;
  uint drawn = light;
  float sends_drawn = 0.0;
  Reservoir drawing = Reservoir(u, 0.0);
  for (uint k = 0u; k < (is_lamp && cluster.count > 1u ? candidates : 0u); ++k) {
    uint bits = choice + k * (0xffffffffu / max(candidates, 1u));
    uint lamp = cluster_member(cluster, uvec2(bits, hash_mix(bits)));
    float sends = lamp_sends(lamp, position, normal);
    bool taken = reservoir_draw(drawing, sends / max(texelFetch(light_alias, int(lamp)).z, 1e-30));
    drawn = taken || drawing.total <= 0.0 ? lamp : drawn;
    sends_drawn = taken ? sends : sends_drawn;
  }
  pmf = drawing.total > 0.0 ? ratio * sends_drawn * float(candidates) / drawing.total : pmf;
  return drawn;
}
#endif

#if LUCERNA_LEARNED && LUCERNA_TRIANGLE_CANDIDATES
#include "shaders/shared/facet.h"
uniform samplerBuffer light_facets;

// Unoccluded contribution of a small emissive triangle of power 1, up to a factor; 0 only if its emitting side is not
// visible from there: its normal is accurate to a thousandth.
float facet_sends(uint triangle, vec3 position, vec3 normal) {
  vec4 f = texelFetch(light_facets, int(triangle));
  uint bits = floatBitsToUint(f.w);
  vec3 n = facet_raise(vec2(bits & 0xfffu, bits >> 12 & 0xfffu) * (2.0 / 4095.0) - 1.0);
  vec3 to = f.xyz - position;
  float d2 = max(dot(to, to), 1e-20), scale = inversesqrt(d2);
  float faces = -dot(n, to) * scale * inversesqrt(dot(n, n));
  faces = max((bits >> 31) != 0u ? abs(faces) : faces, -0.004) + 0.004;
  float area = exp2(float(bits >> 24 & 0x7fu) - 64.0);
  return faces * max(dot(normal, to) * scale, 0.05) / (d2 + area);
}

// Replaces a triangle of a cluster by one resampled from candidates, like draw_lamp_of(). Rays may hit it too, and MIS uses
// the density without candidates; `factor`: that over the effective density.
uint draw_triangle_of(LightCluster cluster, uint light, vec3 position, vec3 normal, uvec2 choice, float ratio, inout float pmf, out float factor) {
  const uint candidates = uint(LUCERNA_TRIANGLE_CANDIDATES);
  bool small = cluster.of_triangles && cluster.count > 1u;
  uint drawn = light;
  float sends_drawn = 0.0;
  Reservoir drawing = Reservoir(to_unit(choice).y, 0.0);
  for (uint k = 0u; k < (small ? candidates : 0u); ++k) {
    uint bits = choice.x + k * (0xffffffffu / max(candidates, 1u));
    uint triangle = cluster_member(cluster, uvec2(bits, hash_mix(bits)));
    float sends = facet_sends(triangle, position, normal);
    bool taken = reservoir_draw(drawing, sends);
    drawn = taken ? triangle : drawn;
    sends_drawn = taken ? sends : sends_drawn;
  }
  factor = small ? drawing.total / (float(candidates) * max(sends_drawn, 1e-37)) : 1.0;
  factor = drawing.total > 0.0 || !small ? factor : 0.0;
  pmf = small ? ratio * texelFetch(light_alias, int(drawn)).z : pmf;
  return drawn;
}
#endif

#if LUCERNA_SHAPES
LampShape load_shape(uint light) {
  int at = int(light * k_light_texels);
  return lamp_shape(texelFetch(scene_lights, at), texelFetch(scene_lights, at + 1), texelFetch(scene_lights, at + 2),
                    texelFetch(scene_lights, at + 3));
}
#if LUCERNA_LEARNED
// Cluster of a lamp with a shape.
uint shape_cluster(uint light) { return floatBitsToUint(texelFetch(shape_clusters, int(light - frame.first_shape)).x); }
#endif
#endif

// Selects by `choice` (32 bits), places by u; detail: 64 further bits (environment). A separate sky has probability
// sky_share; the other lights share the rest. `normal`: of the surface, unit, on the visible side. Requires lib/surface.glsl
// before it.
#if LUCERNA_LEARNED
// `row`: learned_row() of the place.
LightSample sample_light(vec3 position, vec3 normal, uint choice, vec2 u, uvec2 detail, uint row) {
  const float sky_share = 0.0;
#else
LightSample sample_light(vec3 position, vec3 normal, uint choice, vec2 u, uvec2 detail, float sky_share) {
#endif
  LightSample s;
  s.primitive = k_no_hit;
  s.uv = vec2(0.0);
  s.target = vec3(0.0);
  s.normal = vec3(0.0);
  s.offset = vec3(0.0);
  s.delta = true;
  s.sky = false;
  s.group = 0u;
#if LUCERNA_LEARNED || LUCERNA_SHAPES
  s.factor = 1.0;
#endif
  float pmf;
  float of_lamp = u.x;  // for choosing among candidates
#if LUCERNA_SHAPES
  of_lamp = to_unit(uvec2(hash_mix(detail.y ^ 0x2545f491u), 0u)).x;  // u is needed for the place
#endif
#if LUCERNA_LEARNED
  float ratio;
  s.cluster = alias_choose(learned_rows, row * frame.light_clusters, frame.light_clusters, uvec2(choice, hash_mix(choice)), ratio);
  LightCluster cluster = light_cluster(s.cluster);
  s.chosen = ratio * cluster.plain;
  uint member = cluster_member(cluster, detail);
#if LUCERNA_SKY_PORTALS
  // Portals are the last clusters of the sky.
  uint portal = s.cluster + uint(LUCERNA_PORTALS) - frame.sky_clusters;
  if (portal >= uint(LUCERNA_PORTALS)) portal = k_no_portal;
#endif
  // The environment is the last light.
  uint light = s.cluster < frame.sky_clusters ? frame.light_count - 1u : member;
  pmf = ratio * texelFetch(light_alias, int(light)).z;
#if LUCERNA_LAMP_CANDIDATES
  light = draw_lamp_of(cluster, light, position, normal, detail.x, of_lamp, ratio, pmf);
#endif
#if LUCERNA_SKY_PORTALS
  s.own = 0.0;
#endif
#if LUCERNA_TRIANGLE_CANDIDATES
  light = draw_triangle_of(cluster, light, position, normal, detail, ratio, pmf, s.factor);
#endif
  u = cluster.corner + cluster.side * u;
#else
  uint light = alias_choose(light_alias, frame.light_count, uvec2(choice, hash_mix(choice)), pmf);
#endif
#if LUCERNA_LAMP_CANDIDATES && !LUCERNA_LEARNED
  // Uses random numbers that lamps do not need otherwise, so they are equally well distributed.
  light = draw_lamp(light, position, normal, detail.x, of_lamp, pmf);
#endif
#if LUCERNA_SEPARATE_SKY
  uint sky_end = uint(sky_share * 4294967040.0);
  s.sky = detail.y < sky_end || sky_share >= 1.0;
  // The remainder of the number is uniform again.
  float rest = s.sky ? float(detail.y) / float(sky_end) : float(detail.y - sky_end) / float(0xffffffffu - sky_end);
  detail.y = uint(min(rest, 1.0) * 4294967040.0);
  pmf *= 1.0 - sky_share;
#endif
#if LUCERNA_PATH_EVENTS
  s.entry = s.sky ? 0xffffffffu : light;
#endif
  int at = int(light * k_light_texels);
  vec4 a = texelFetch(scene_lights, at), b = texelFetch(scene_lights, at + 1), c = texelFetch(scene_lights, at + 2);
  uint kind = floatBitsToUint(a.w);
#if LUCERNA_LIGHT_GROUPS > 1
  s.group = group_of_light(at, s.sky);
#endif
#if LUCERNA_SEPARATE_SKY
  if (s.sky) kind = k_light_environment;
#endif
  // Point and spot: irradiance I/d^2.
  vec3 to = a.xyz - position;
  float d2 = max(dot(to, to), 1e-20);
  s.distance = sqrt(d2);
  s.direction = to / s.distance;
  s.radiance = b.xyz / d2 * (kind == k_light_spot ? spot_share(dot(-s.direction, c.xyz), b.w, c.w) : 1.0);
  s.pdf = pmf;
  if (kind == k_light_directional) {
    s.direction = -c.xyz;
    s.distance = k_infinity;
    s.radiance = b.xyz;
  }
#if LUCERNA_PROFILES
  if (kind == k_light_profile) {
    vec4 d = texelFetch(scene_lights, at + 3);
    float density;
    s.radiance *= profile_share(light_profile(floatBitsToUint(d.w)), c.xyz, d.xyz, -s.direction, density);
  }
#endif
#if LUCERNA_PICTURES
  if (kind == k_light_projector) {
    float density;
    s.radiance *= picture_share(light_picture(b, c, texelFetch(scene_lights, at + 3)), -s.direction, density);
  }
#endif
#if LUCERNA_SHAPES
  if (is_shape(kind)) {
    // Rays may meet it too: MIS uses the density without candidates.
#if LUCERNA_LAMP_CANDIDATES
    float plain = texelFetch(light_alias, int(light)).z;
#if LUCERNA_LEARNED
    plain *= ratio;
#elif LUCERNA_SEPARATE_SKY
    plain *= 1.0 - sky_share;
#endif
    s.factor = plain / max(pmf, 1e-37);
    pmf = plain;
#endif
    LampShape shape = lamp_shape(a, b, c, texelFetch(scene_lights, at + 3));
    float density;
    s.direction = sample_shape(shape, position, u, density, s.distance);
    s.radiance = s.distance > 0.0 ? shape.radiance : vec3(0.0);
    s.distance *= 1.0 - k_shape_gap;
    s.pdf = pmf * density;
    s.delta = false;
  }
#endif
#if LUCERNA_EMISSIVE
  if (kind == k_light_triangle) {
    vec3 p0 = a.xyz, p1 = b.xyz, p2 = c.xyz;
    // Uniform in area (low-distortion map, Heitz 2019).
    vec2 m = 0.5 * u;
    float offset = m.y - m.x;
    m += offset > 0.0 ? vec2(0.0, offset) : vec2(-offset, 0.0);
    vec3 p = m.x * p0 + m.y * p1 + (1.0 - m.x - m.y) * p2;
    s.uv = vec2(m.y, 1.0 - m.x - m.y);
    to = p - position;
    d2 = max(dot(to, to), 1e-20);
    s.distance = sqrt(d2);
    s.direction = to / s.distance;
    vec3 n = cross(p1 - p0, p2 - p0);
    n = normalize(n / max(max3(abs(n)), 1e-37));
    s.normal = dot(n, s.direction) > 0.0 ? -n : n;
    s.target = p;
    s.offset = error_gamma(8.0) * (abs(p0) + abs(p1) + abs(p2)) + vec3(error_gamma(16.0) * max(max3(abs(p1 - p0)), max3(abs(p2 - p0))));
    s.pdf = pmf * d2 / max(abs(dot(n, s.direction)) * b.w, 1e-30);
    s.delta = false;
    s.primitive = floatBitsToUint(c.w);
    vec4 emission = texelFetch(scene_lights, at + 3);
    uint sides = floatBitsToUint(emission.w);
    bool front = (dot(n, s.direction) < 0.0) != ((sides & k_light_flipped) != 0u);
    s.radiance = front || (sides & k_light_both_sides) != 0u ? emission.rgb : vec3(0.0);
  }
#endif
#if LUCERNA_ENVIRONMENT_MAP
  if (kind == k_light_environment) {
    s.distance = k_infinity;
    s.delta = false;
#if LUCERNA_SEPARATE_SKY
    s.direction = environment_in_cell(sky_or_sun_cell(s.sky, floatBitsToUint(b.x), detail), u);
    Environment e = environment_radiance(s.direction);
    s.radiance = s.sky ? e.sky : e.sun;
    s.pdf = s.sky ? e.pdf_sky * sky_share : e.pdf_sun * (1.0 - sky_share);
#else
#if LUCERNA_SKY_PORTALS
#if !LUCERNA_LEARNED
    const uint row = 0u;
    uint portal = choose_portal(detail.y);
#endif
    float own = 0.0;
    vec3 through = vec3(0.0);
    for (uint once = 0u; once < (portal != k_no_portal ? 1u : 0u); ++once) through = sample_portal(portal, position, detail, u, own);
#endif
#if LUCERNA_LEARNED
    s.direction = environment_in_cell(member, u);
#else
    uint cells = frame.environment_width * frame.environment_height;
    float texel_pmf;
    s.direction = environment_in_cell(alias_choose(environment_alias, cells, detail, texel_pmf), u);
#endif
#if LUCERNA_SKY_PORTALS
    if (portal != k_no_portal) s.direction = through;
#endif
#if LUCERNA_LEARNED
    s.radiance = environment_radiance(s.direction, row, s.pdf);
#else
    s.radiance = environment_radiance(s.direction, s.pdf);
#endif
#if LUCERNA_SKY_PORTALS
#if LUCERNA_LEARNED
    s.own = portal == k_no_portal ? (1.0 - k_portal_share) * s.pdf / max(s.chosen, 1e-30) : own;
#endif
    s.pdf = with_portals(s.pdf, position, s.direction, row, portal, own);
    // Nothing is seen through that portal.
    if (portal != k_no_portal && !(own > 0.0)) s.pdf = 0.0;
#endif
#endif
  }
#endif
  return s;
}
#endif

#endif
