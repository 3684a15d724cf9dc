// Stratification of a record's hemisphere: elevations x azimuths cells of equal cosine-weighted probability; sin^2 of the
// angle from the normal is uniform in 0..1. After J. Krivanek, P. Gautron, S. Pattanaik and K. Bouatouch, "Radiance Caching
// for Efficient Global Illumination Computation", 2005.
#ifndef LUCERNA_IRRADIANCE_CACHE_HEMISPHERE
#define LUCERNA_IRRADIANCE_CACHE_HEMISPHERE
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/math.glsl"
#include "lib/sampler.glsl"

uniform samplerBuffer record_texels;
layout(scalar) buffer RecordList { uint record_list[]; };

// Rays of one cell, over all records of a batch, are adjacent: nearly parallel and from nearby origins. Then azimuth by
// azimuth.
uint cell_slot(uint elevation, uint azimuth, uint record) {
  return (azimuth * push.elevations + elevation) * push.records + record;
}

// Inverse distance from a hit's texel; 0: no hit.
float inverse_distance(vec4 hit) {
  return floatBitsToUint(hit.y) == k_no_hit ? 0.0 : 1.0 / max(hit.x, 1e-30);
}

// Ray of a cell: sine and cosine of the angle from the normal, and azimuth from the tangent towards the bitangent.
struct CellRay {
  float sine, cosine, phi;
};
CellRay cell_ray(uint elevation, uint azimuth, uint record) {
  // Jitter by hashing alone: a low-discrepancy sequence would correlate with the order of the cells.
  uint sample_index = push.rays_before + azimuth * push.elevations + elevation;
  uint key = hash_combine(hash_combine(hash_mix(push.seed + (push.pilot != 0u ? 0x6d2b79f5u : 0x2c1b3c6du)), record), sample_index);
  vec2 jitter = to_unit(uvec2(key, hash_mix(key ^ 0x9e3779b9u)));
  // Cosine from the complement, so it never is 0.
  return CellRay(sqrt((float(elevation) + jitter.x) / float(push.elevations)),
                 sqrt((float(push.elevations - elevation) - jitter.x) / float(push.elevations)),
                 2.0 * k_pi * (float(azimuth) + jitter.y) / float(push.azimuths));
}
#endif
