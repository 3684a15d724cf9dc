// Visits the photons around the place that a pixel shows: calls photon_met(), which the including file defines, for each. If
// there are more than k_photons_around, every n-th counts n times.
#ifndef LUCERNA_PHOTONS_AROUND
#define LUCERNA_PHOTONS_AROUND
#include "photons/photon.glsl"
#include "photons/lookup.glsl"
#include "photons/area.glsl"
#include "shaders/shared/photons/inspect.h"

struct Around {
  float count, area, density;
  vec3 irradiance;
};

void photon_met(vec4 a, vec4 b, vec3 wi, float kernel);

Around photons_around(vec3 x, vec3 normal, bool looks) {
  Around sum = Around(0.0, 1.0, 0.0, vec3(0.0));
  float radius = photon_radius(x);
  looks = looks && photons.count > 0u;
  int lowest = photon_lowest_level(radius), highest = photon_highest_level(radius);
  uint candidates = looks ? photon_candidates(x, lowest, highest) : 0u;
  uint step = max(1u, (candidates + k_photons_around - 1u) / k_photons_around), skip = step / 2u;
  for (int level = lowest; looks && level <= highest; ++level) {
    ivec3 cell = ivec3(floor(x * photon_inverse_cell(level) - 0.5));
    for (uint k = 0u; k < k_photon_near_cells; ++k) {
      uvec2 range = photon_range(photon_entry(cell + (ivec3(k) >> ivec3(0, 1, 2) & 1), level));
      uint at = range.x + skip;
      for (; at < range.y; at += step) {
        vec4 a = texelFetch(photon_texels, int(k_photon_texels * at));
        vec3 away = a.xyz - x;
        float r = photon_radius(a.xyz), d2 = dot(away, away);
        if (d2 >= r * r) continue;
        vec4 b = texelFetch(photon_texels, int(k_photon_texels * at + 1u));
        vec3 wi = photon_direction(floatBitsToUint(a.w)), front = facet_unpack(floatBitsToUint(b.w) & k_photon_facet);
        vec3 side = dot(wi, front) > 0.0 ? front : -front;
        if (dot(side, normal) <= k_density_normals || abs(dot(away, front)) >= k_photon_slab * r) continue;
        float kernel = photon_kernel(d2, r);
        sum.count += 1.0;
        sum.density += kernel;
        sum.irradiance += kernel * b.rgb;
        photon_met(a, b, wi, kernel);
      }
      skip = at - range.y;
    }
  }
  sum.count *= float(step);
  sum.density *= float(step);
  sum.irradiance *= float(step);
  if (sum.count > 0.0) sum.area = photon_area(x, normal, radius);
  sum.density /= sum.area;
  sum.irradiance /= sum.area;
  return sum;
}
#endif
