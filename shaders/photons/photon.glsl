// Packing, radius and cell of a photon (shared/photons/photons.h).
#ifndef LUCERNA_PHOTONS_PHOTON
#define LUCERNA_PHOTONS_PHOTON
#include "shaders/shared/photons/photons.h"
#include "shaders/shared/ray.h"
#include "lib/math.glsl"
#include "lib/sampler.glsl"

layout(scalar) readonly buffer PhotonBlock { PhotonFrame photons; };

// Octahedral map, 16 bits an axis (Cigolle et al. 2014).
uint photon_pack_direction(vec3 d) {
  uvec2 q = uvec2(clamp((facet_flatten(d) * 0.5 + 0.5) * 65535.0 + 0.5, vec2(0.0), vec2(65535.0)));
  return q.x | q.y << 16;
}
vec3 photon_direction(uint bits) {
  return normalize(facet_raise(vec2(bits & 0xffffu, bits >> 16) * (2.0 / 65535.0) - 1.0));
}

// Barycentric coordinates of a hit, 16 bits each.
uint barycentric_pack(Hit hit) {
  uvec2 q = uvec2(clamp(vec2(hit.u, hit.v) * 65535.0 + 0.5, vec2(0.0), vec2(65535.0)));
  return q.x | q.y << 16;
}

// Radius within which a photon at x counts [m]. Changes by at most `slope` per metre; rounding bounds it by
// k_photon_least_radius.
float photon_radius(vec3 x) { return photon_radius_of(photons.base + photons.slope * distance(x, photons.eye), photons.most, x); }

// Level whose cells fit a photon of that radius.
int photon_level(float radius) { return int(ceil(2.0 * log2(2.0 * k_photon_slack * radius))); }
// 2^(-level / 2).
float photon_inverse_cell(int level) { return ldexp((level & 1) != 0 ? 0.70710678 : 1.0, -(level >> 1)); }

// Table entry of a cell. `mask`: number of entries minus 1.
uint photon_entry_of(ivec3 cell, int level, uint mask) {
  uvec3 above = uvec3(cell >> 1);
  uint hash = hash_combine(hash_combine(hash_combine(uint(level >> 2), above.x), above.y), above.z);
  uint low = uint(cell.x & 1) | uint(cell.y & 1) << 1 | uint(cell.z & 1) << 2 | uint(level & 3) << 3;
  return (hash << k_photon_entry_bits | low) & mask;
}
uint photon_entry(ivec3 cell, int level) { return photon_entry_of(cell, level, photons.mask); }

// The frame whose radii importance was recorded with.
float importance_radius(vec3 x) {
  return photon_radius_of(photons.importance_base + photons.importance_slope * distance(x, photons.importance_eye), photons.most, x);
}
#endif
