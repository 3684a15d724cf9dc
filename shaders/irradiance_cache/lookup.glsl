// Irradiance at a point, interpolated from records: the weighted mean of their gradient extrapolations. A record's weight
// falls to 0 at the border of its validity, so no seam shows (E. Tabellion and A. Lamorlette, 2004).
// LUCERNA_CACHE_PARTS: bit p: part p is read. LUCERNA_CACHE_ELLIPSES: 1: records may be ellipses.
// LUCERNA_CACHE_GATHERS: 1: records may be crowded, so that paths gather (k_record_crowded).
#ifndef LUCERNA_IRRADIANCE_CACHE_LOOKUP
#define LUCERNA_IRRADIANCE_CACHE_LOOKUP
#include "lib/variants.glsl"
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/math.glsl"
#include "lib/octree.glsl"
#include "irradiance_cache/ellipse.glsl"
#include "irradiance_cache/least_radius.glsl"
#include "shaders/shared/facet.h"
#include "lib/reservoir.glsl"
#if LUCERNA_GROUP_SUMS
#include "irradiance_cache/groups.glsl"
#endif

uniform samplerBuffer record_texels;
uniform samplerBuffer irradiance_texels;
layout(scalar) writeonly buffer Candidates { vec4 candidates[]; };

#if LUCERNA_DIFFUSE_TRANSMISSION
const int k_cache_sides = 2;
#else
const int k_cache_sides = 1;
#endif

struct Cached {
  vec3 part[k_part_count];
  float weight;  // 0: no record serves here
  uint guide;    // nearest crowded record; k_no_guide: none, paths do not gather here
#if LUCERNA_PATH_EVENTS
  uint records;  // records that serve the place
  uint record;   // drawn one
#endif
#if LUCERNA_GROUP_SUMS
  vec3 group[k_group_count];  // all parts except k_part_direct, by light group; unbiased over `u`
#endif
};

// Distances to the nearest records whose discs contain the point: lit and crowded ones. Paths gather where the crowded one
// is nearer: wider records that reach the point ignore the near geometry.
struct Nearest {
  float lit, crowded;  // [m], k_infinity: none
};
Nearest nothing_near() { return Nearest(k_infinity, k_infinity); }
Nearest nearer(Nearest so_far, float weight, vec3 away, bool crowded) {
  float from = weight > 0.0 ? length(away) : k_infinity;
  return Nearest(min(so_far.lit, crowded ? k_infinity : from), min(so_far.crowded, crowded ? from : k_infinity));
}
bool paths_gather(Nearest n) { return n.crowded < n.lit; }

// Texel 3 of a record. Read only if records may be ellipses; spheres need only `place`.
vec4 record_shape(uint record, vec4 place) {
#if LUCERNA_CACHE_ELLIPSES
  return texelFetch(record_texels, int(record * k_record_texels + 3u));
#else
  return vec4(0.0, 0.0, 0.0, place.w);
#endif
}

uint record_media(uint record) { return floatBitsToUint(texelFetch(record_texels, int(record * k_record_texels + 5u)).x); }

bool record_crowded(uint record) {
  return record_flagged_crowded(texelFetch(record_texels, int(record * k_record_texels + 2u)).w);
}

// Largest distance of a served point from the plane midway between its own and the record's tangent plane [m]. `radius`:
// minor.
float record_off_plane(vec3 position, float radius) {
  return radius * (radius <= 1.001 * least_radius(position) ? cache.off_plane_least : cache.off_plane);
}

// Normalized distance of a point at offset `away` from the record's centre: 0 at the centre, 1 at the border of validity.
float record_far(vec3 away, vec4 place, vec4 shape) {
#if LUCERNA_CACHE_ELLIPSES
  return record_distance(away, shape);
#else
  return length(away) / place.w;
#endif
}

// Weight of a record, 0..1, at a point x with geometric normal n.
float record_weight(vec3 x, vec3 n, vec4 place, vec4 facing, vec4 shape) {
  vec3 away = x - place.xyz;
  float far = record_far(away, place, shape);
  float turned = sqrt(max(0.0, 1.0 - dot(n, facing.xyz)) / cache.normal_tolerance);
  // Two points of one smooth surface lie near the plane midway between their tangent planes; points off that plane belong to
  // another surface or to a step.
  bool level = abs(dot(away, n + facing.xyz)) <= 2.0 * record_off_plane(place.xyz, shape.w);
  return place.w > 0.0 && level ? max(0.0, 1.0 - max(far, turned)) : 0.0;
}

// True if a record on geometric normal n can serve a shading normal: the angle is small enough for rotational gradients.
bool cache_can_serve(vec3 n, vec3 shading) { return 1.0 - dot(n, shading) <= cache.normal_tolerance; }

#if LUCERNA_GROUP_SUMS
// One record, drawn with a probability proportional to its weighted luminance, provides the group shares for the whole
// lookup.
// Reading the shares of all records took a third of shading time on lavapipe.
struct RecordLot {
  Reservoir drawing;  // by weighted luminance
  uint record;
  vec3 light;   // the drawn record's light, scaled to the luminance of all
};
RecordLot draw_record(RecordLot lot, uint record, vec3 light) {
  float y = luminance(light), before = lot.drawing.total;
  bool drawn = reservoir_draw(lot.drawing, y);
  lot.record = drawn ? record : lot.record;
  lot.light = drawn ? light * (lot.drawing.total / y) : y > 0.0 ? lot.light * (lot.drawing.total / max(before, 1e-30)) : lot.light;
  return lot;
}
#endif

// Octree range of the records near x; empty if `enabled` is false or the cache has no complete records.
OctreeRange cache_range(vec3 x, bool enabled) {
  OctreeRange range = octree_find(x);
  return OctreeRange(range.first, enabled && cache.record_count > 0u ? range.last : range.first);
}

// One entry of the octree's lists, evaluated at a point.
struct Serving {
  uint record;
  vec4 place, facing;
  float weight;   // 0: the record does not serve the point
  bool crowded;   // it serves the point, but holds no light
};

// Advances `i` to the next record of the range whose sphere contains the point. About one record in ten does, and lanes wait
// for the longest list.
Serving next_serving(inout uint i, uint last, vec3 x, vec3 n, uint media) {
  Serving s;
  uint at = i;
  s.place = vec4(0.0);
  bool within = false;
  for (; i < last && !within; ++i) {
    at = i;
    s.place = octree_copy(i);
    vec3 off_centre = x - s.place.xyz;
    within = dot(off_centre, off_centre) < square(s.place.w);
#if LUCERNA_VOLUMES
    within = within && record_media(octree_sphere(i)) == media;
#endif
  }
  s.record = octree_sphere(at);
  s.facing = texelFetch(record_texels, int(s.record * k_record_texels + 1u));
  s.weight = within ? record_weight(x, n, s.place, s.facing, record_shape(s.record, s.place)) : 0.0;
#if LUCERNA_CACHE_GATHERS
  s.crowded = s.weight > 0.0 && record_crowded(s.record);
#else
  s.crowded = false;
#endif
  return s;
}

// Updates the nearest distances; `guide` becomes the nearest crowded record.
void meet(Serving s, vec3 x, inout Nearest nearest, inout uint guide) {
  float before = nearest.crowded;
  nearest = nearer(nearest, s.weight, x - s.place.xyz, s.crowded);
  guide = nearest.crowded < before ? s.record : guide;
}

// Extrapolation of a record's light to a point at offset `away` with normal `shading`.
struct Extrapolation {
  vec2 r, t;  // rotation and translation along tangent and bitangent
};
// Clamps an offset to the distance up to which the translational gradient holds.
vec2 slope_offset(vec2 t, float holds) { return t * min(1.0, holds / max(length(t), 1e-30)); }
Extrapolation extrapolation(vec3 normal, vec3 away, vec3 shading) {
  vec3 tangent, bitangent;
  make_basis(normal, tangent, bitangent);
  vec3 turn = cross(normal, shading);
  return Extrapolation(vec2(dot(turn, tangent), dot(turn, bitangent)), vec2(dot(away, tangent), dot(away, bitangent)));
}
vec3 record_part(uint record, uint part, Extrapolation by) {
  int from = int((record * k_part_count + part) * k_part_texels);
  vec4 a = texelFetch(irradiance_texels, from), b = texelFetch(irradiance_texels, from + 1);
  vec4 c = texelFetch(irradiance_texels, from + 2), d = texelFetch(irradiance_texels, from + 3);
  // Clamped to [0, 2 x record]: a clamp on one side alone would brighten noisy gradients.
  vec2 t = slope_offset(by.t, d.w);
  vec3 change = by.r.x * vec3(a.a, b.xy) + by.r.y * vec3(b.zw, c.x) + t.x * c.yzw + t.y * d.xyz;
  return a.rgb + clamp(change, -a.rgb, a.rgb);
}
bool part_is_read(uint part) { return (uint(LUCERNA_CACHE_PARTS) >> part & 1u) != 0u; }

Cached nothing_cached() {
  Cached found;
  for (uint p = 0u; p < k_part_count; ++p) found.part[p] = vec3(0.0);
  found.weight = 0.0;
  found.guide = k_no_guide;
#if LUCERNA_PATH_EVENTS
  found.records = found.record = 0u;
#endif
#if LUCERNA_GROUP_SUMS
  [[unroll]] for (uint g = 0u; g < k_group_count; ++g) found.group[g] = vec3(0.0);
#endif
  return found;
}

// Splits `light` by the record's group shares.
#if LUCERNA_GROUP_SUMS
void share_out(inout Cached found, uint record, vec3 light) {
  [[unroll]] for (uint t = 0u; t < k_group_texels; ++t) {
    uvec4 shares = texelFetch(record_group_texels, int(record * k_group_texels + t));
    [[unroll]] for (uint g = 4u * t; g < min(4u * t + 4u, k_group_count); ++g) found.group[g] = light * share_unpack(shares[g % 4u]);
  }
}
#endif

// Irradiance from all records that serve x. `n`: geometric normal, on the side that is lit. `shading`: shading normal;
// nothing is served if the rotational gradient cannot bridge the angle between the two. `media`: media around x, as in
// PathState; records in other media do not serve. `enabled` false: an empty result at no cost. `u`: [0, 1), draws a record
// for group shares.
Cached cache_lookup(vec3 x, vec3 n, vec3 shading, uint media, bool enabled, float u) {
  Cached found = nothing_cached();
#if LUCERNA_GROUP_SUMS
  RecordLot lot = RecordLot(Reservoir(u, 0.0), 0u, vec3(0.0));
#endif
  Nearest nearest = nothing_near();
  OctreeRange range = cache_range(x, enabled && cache_can_serve(n, shading));
  for (uint i = range.first; i < range.last;) {
    Serving s = next_serving(i, range.last, x, n, media);
    meet(s, x, nearest, found.guide);
    float weight = s.crowded ? 0.0 : s.weight;
    Extrapolation by = extrapolation(s.facing.xyz, x - s.place.xyz, shading);
    vec3 light = vec3(0.0);  // weighted, all groups
    for (uint p = 0u; p < k_part_count; ++p) {
      if (!part_is_read(p)) continue;
      vec3 part = record_part(s.record, p, by);
      part = weight > 0.0 ? weight * part : vec3(0.0);
      found.part[p] += part;
      if (p != k_part_direct) light += part;
    }
#if LUCERNA_GROUP_SUMS
    lot = draw_record(lot, s.record, light);
#endif
    found.weight += weight;
  }
  found.weight = paths_gather(nearest) ? 0.0 : found.weight;
  for (uint p = 0u; p < k_part_count; ++p) found.part[p] = found.weight > 0.0 ? found.part[p] / found.weight : vec3(0.0);
#if LUCERNA_GROUP_SUMS
  share_out(found, lot.record, found.weight > 0.0 ? lot.light / found.weight : vec3(0.0));
#endif
  return found;
}

// Likewise from one record, drawn in proportion to its weight: unbiased over `u`. Records that are valid at one point differ
// little, and reading the light of one instead of all saves a third of the lookup's time.
Cached cache_draw(vec3 x, vec3 n, vec3 shading, uint media, bool enabled, float u) {
  Cached found = nothing_cached();
  Reservoir drawing = Reservoir(u, 0.0);
  uint record = 0u;
  vec3 place = vec3(0.0), facing = vec3(0.0, 0.0, 1.0);
  Nearest nearest = nothing_near();
  OctreeRange range = cache_range(x, enabled && cache_can_serve(n, shading));
  for (uint i = range.first; i < range.last;) {
    Serving s = next_serving(i, range.last, x, n, media);
    meet(s, x, nearest, found.guide);
    bool drawn = reservoir_draw(drawing, s.crowded ? 0.0 : s.weight);
#if LUCERNA_PATH_EVENTS
    found.records += s.crowded || s.weight <= 0.0 ? 0u : 1u;
#endif
    record = drawn ? s.record : record;
    place = drawn ? s.place.xyz : place;
    facing = drawn ? s.facing.xyz : facing;
  }
  found.weight = paths_gather(nearest) ? 0.0 : drawing.total;
#if LUCERNA_PATH_EVENTS
  found.record = record;
#endif
  Extrapolation by = extrapolation(facing, x - place, shading);
  vec3 light = vec3(0.0);
  // A loop instead of a branch: on lavapipe a branch saves no reads for vertices without a lookup.
  for (uint once = 0u; once < (found.weight > 0.0 ? 1u : 0u); ++once) {
    for (uint p = 0u; p < k_part_count; ++p) {
      if (!part_is_read(p)) continue;
      found.part[p] = record_part(record, p, by);
      if (p != k_part_direct) light += found.part[p];
    }
#if LUCERNA_GROUP_SUMS
    share_out(found, record, light);
#endif
  }
  return found;
}
#endif
