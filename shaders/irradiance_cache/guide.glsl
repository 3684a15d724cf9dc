// Path guiding near edges, where paths gather. A crowded record stores no irradiance but the luminances of its first rays
// over k_guide_azimuths x k_guide_elevations cells of its hemisphere. Gathering paths draw half of their directions from
// this table and half from the cosine distribution: light from a small part of the hemisphere is found, and no direction has
// density 0. (Mixture as in J. Vorba, O. Karlik, M. Sik, T. Ritschel and J. Krivanek, "On-line Learning of Parametric
// Mixture Models for Light Transport Simulation", 2014; table of H. W. Jensen, "Importance Driven Path Tracing using the
// Photon Map", 1995.)
//
// Densities are relative to the cosine density; all cells have the same cosine probability.
#ifndef LUCERNA_IRRADIANCE_CACHE_GUIDE
#define LUCERNA_IRRADIANCE_CACHE_GUIDE
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/math.glsl"

const float k_guided_share = 0.5;  // of the directions

struct Guide {
  uint record;
  float total;      // sum over the cells; 0: no data, cosine sampling
  mat3 frame;       // tangent, bitangent, normal of the vertex, aligned with the record's
};

uvec4 guide_texel(uint record, uint texel) {
  return floatBitsToUint(texelFetch(irradiance_texels, int(record * k_part_count * k_part_texels + texel)));
}
uint sum_of_bytes(uvec4 words) {
  uvec4 pairs = (words & 0x00ff00ffu) + ((words >> 8u) & 0x00ff00ffu);
  uint sums = pairs.x + pairs.y + pairs.z + pairs.w;
  return (sums & 0xffffu) + (sums >> 16u);
}
uint guide_cell(uvec4 words, uint cell) { return words[cell >> 2u & 3u] >> 8u * (cell & 3u) & 255u; }

// Guide at a vertex with that shading normal. `record`: k_no_guide: none.
Guide make_guide(uint record, vec3 normal) {
  Guide guide;
  guide.record = record;
  uint total = 0u;
  vec3 tangent, bitangent;
  make_basis(normal, tangent, bitangent);
  if (record != k_no_guide) {
    for (uint t = 0u; t < k_guide_texels; ++t) total += sum_of_bytes(guide_texel(record, t));
    vec3 record_tangent, record_bitangent;
    make_basis(texelFetch(record_texels, int(record * k_record_texels + 1u)).xyz, record_tangent, record_bitangent);
    tangent = normalize(record_tangent - dot(record_tangent, normal) * normal);
    bitangent = cross(normal, tangent);
  }
  guide.total = float(total);
  guide.frame = mat3(tangent, bitangent, normal);
  return guide;
}

// Samples the mixture; a direction in world space.
vec3 guide_sample(Guide guide, vec2 u) {
  if (guide.total <= 0.0) return guide.frame * sample_cosine(u);
  if (u.x >= k_guided_share) return guide.frame * sample_cosine(vec2((u.x - k_guided_share) / (1.0 - k_guided_share), u.y));
  float rest = u.x / k_guided_share * guide.total;
  uint texel = 0u;
  uvec4 words = guide_texel(guide.record, 0u);
  float sum = float(sum_of_bytes(words));
  while (rest >= sum && texel + 1u < k_guide_texels) {
    rest -= sum;
    words = guide_texel(guide.record, ++texel);
    sum = float(sum_of_bytes(words));
  }
  uint cell = 0u;
  float share = float(guide_cell(words, 0u));
  while (rest >= share && cell < 15u) {
    rest -= share;
    share = float(guide_cell(words, ++cell));
  }
  cell += 16u * texel;
  float elevation = (float(cell % k_guide_elevations) + min(rest / max(share, 1.0), 1.0)) / float(k_guide_elevations);
  float phi = 2.0 * k_pi * (float(cell / k_guide_elevations) + u.y) / float(k_guide_azimuths);
  // Keeps the cosine above 0.
  return guide.frame * vec3(sqrt(elevation) * cos(phi), sqrt(elevation) * sin(phi), sqrt(max(1.0 - elevation, 1e-7)));
}

// Density of the mixture over the cosine density, for a world direction above the vertex.
float guide_density(Guide guide, vec3 direction) {
  if (guide.total <= 0.0) return 1.0;
  vec3 local = direction * guide.frame;  // transposed
  float turn = atan(local.y, local.x) / (2.0 * k_pi);
  uint azimuth = min(uint((turn < 0.0 ? turn + 1.0 : turn) * float(k_guide_azimuths)), k_guide_azimuths - 1u);
  uint elevation = min(uint(dot(local.xy, local.xy) * float(k_guide_elevations)), k_guide_elevations - 1u);
  uint cell = azimuth * k_guide_elevations + elevation;
  float share = float(guide_cell(guide_texel(guide.record, cell / 16u), cell % 16u)) / guide.total;
  return 1.0 - k_guided_share + k_guided_share * share * float(k_guide_azimuths * k_guide_elevations);
}
#endif
