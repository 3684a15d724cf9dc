// Importance of lookups around a place: how much they contribute to the picture (shared/photons/photons.h).
#ifndef LUCERNA_PHOTONS_IMPORTANCE
#define LUCERNA_PHOTONS_IMPORTANCE
#include "photons/photon.glsl"

layout(scalar) readonly buffer PhotonImportance { uint photon_importance[]; };

uint importance_around(vec3 x) {
  int level = photon_level(importance_radius(x));
  ivec3 cell = ivec3(floor(x * photon_inverse_cell(level) - 0.5));
  uint sum = 0u;
  for (uint k = 0u; k < k_photon_near_cells; ++k)
    sum += photon_importance[photon_entry_of(cell + (ivec3(k) >> ivec3(0, 1, 2) & 1), level, k_photon_importance_entries - 1u)];
  return sum;
}
#endif
