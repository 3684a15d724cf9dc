// Finds the photons around a place, and their kernel weights.
#ifndef LUCERNA_PHOTONS_LOOKUP
#define LUCERNA_PHOTONS_LOOKUP
#include "photons/photon.glsl"

uniform samplerBuffer photon_texels;
uniform usamplerBuffer photon_table;  // two entries a texel

// Photons of a table entry: first, and one past the last.
uvec2 photon_range(uint entry) {
  uvec4 two = texelFetch(photon_table, int(entry >> 1));
  return (entry & 1u) != 0u ? two.zw : two.xy;
}

// Levels of the cells that may contain photons reaching a place of that radius; few, because the radius changes slowly.
int photon_lowest_level(float radius) { return photon_level(radius / (1.0 + photons.slope) * (2.0 - k_photon_slack)); }
int photon_highest_level(float radius) { return photon_level(radius / (1.0 - photons.slope) * k_photon_slack); }

// Number of photons in the cells of these levels around a place.
uint photon_candidates(vec3 x, int lowest, int highest) {
  uint candidates = 0u;
  for (int level = lowest; level <= highest; ++level) {
    ivec3 cell = ivec3(floor(x * photon_inverse_cell(level) - 0.5));
    for (uint k = 0u; k < k_photon_near_cells; ++k) {
      uvec2 range = photon_range(photon_entry(cell + (ivec3(k) >> ivec3(0, 1, 2) & 1), level));
      candidates += range.y - range.x;
    }
  }
  return candidates;
}

// Epanechnikov's kernel over the disc of radius r, at a squared distance below r^2 [1/m^2].
float photon_kernel(float d2, float r) { return 2.0 * k_inv_pi * (1.0 - d2 / (r * r)) / (r * r); }
// Constant kernel over the disc [1/m^2].
float photon_flat_kernel(float r) { return k_inv_pi / (r * r); }
#endif
