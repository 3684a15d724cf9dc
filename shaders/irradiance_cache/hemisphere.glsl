// The strata of a record's hemisphere: elevations x azimuths cells of equal probability under the cosine's distribution,
// in which sin^2 of the angle from the normal is even in 0..1. After J. Krivanek, P. Gautron, S. Pattanaik and
// K. Bouatouch, "Radiance Caching for Efficient Global Illumination Computation", 2005.
#ifndef LUCERNA_IRRADIANCE_CACHE_HEMISPHERE
#define LUCERNA_IRRADIANCE_CACHE_HEMISPHERE
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/math.glsl"
#include "lib/sampler.glsl"

uniform samplerBuffer record_texels;
layout(scalar) buffer RecordList { uint record_list[]; };

// The rays of one cell of all records of a batch are neighbours: nearly parallel, from records that lie near each other.
// Cells of one azimuth follow each other.
uint cell_slot(uint elevation, uint azimuth, uint record) {
  return (azimuth * push.elevations + elevation) * push.records + record;
}

// Of a hit's texel; 0 where there is none.
float inverse_distance(vec4 hit) {
  return floatBitsToUint(hit.y) == k_no_hit ? 0.0 : 1.0 / max(hit.x, 1e-30);
}

// The ray of a cell: sine and cosine of its angle from the normal, and its azimuth from the tangent towards the bitangent.
struct CellRay {
  float sine, cosine, phi;
};
CellRay cell_ray(uint elevation, uint azimuth, uint record) {
  // Jitter inside the cell by hashing alone: a low-discrepancy sequence would correlate with the cells' order.
  uint sample_index = push.rays_before + azimuth * push.elevations + elevation;
  uint key = hash_combine(hash_combine(hash_mix(push.seed + (push.pilot != 0u ? 0x6d2b79f5u : 0x2c1b3c6du)), record), sample_index);
  vec2 jitter = to_unit(uvec2(key, hash_mix(key ^ 0x9e3779b9u)));
  // The cosine from what is missing to 1, so that it is never 0.
  return CellRay(sqrt((float(elevation) + jitter.x) / float(push.elevations)),
                 sqrt((float(push.elevations - elevation) - jitter.x) / float(push.elevations)),
                 2.0 * k_pi * (float(azimuth) + jitter.y) / float(push.azimuths));
}
#endif
