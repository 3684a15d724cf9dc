// Reads single records with their interpolation weights.
#ifndef LUCERNA_IRRADIANCE_CACHE_READING
#define LUCERNA_IRRADIANCE_CACHE_READING
#include "irradiance_cache/lookup.glsl"
#include "irradiance_cache/error_propagation.glsl"

uniform samplerBuffer record_error_texels;

// Weight that cache_lookup() gives the record at place `at` of the octree's lists; 0: not used.
float read_weight(vec3 x, vec3 n, uint media, uint at) {
  uint record = octree_sphere(at);
  vec4 place = octree_copy(at), facing = texelFetch(record_texels, int(record * k_record_texels + 1u));
  vec3 away = x - place.xyz;
  bool within = dot(away, away) < square(place.w) && !record_crowded(record);
#if LUCERNA_VOLUMES
  within = within && record_media(record) == media;
#endif
  return within ? record_weight(x, n, place, facing, record_shape(record, place)) : 0.0;
}

vec3 record_light(uint record, uint part) {
  return texelFetch(irradiance_texels, int((record * k_part_count + part) * k_part_texels)).rgb;
}
// Luminance of all parts of a record.
float record_luminance(uint record) {
  float light = 0.0;
  for (uint p = 0u; p < k_part_count; ++p) light += luminance(record_light(record, p));
  return light;
}
// Error of that luminance in lanes 4 group .. 4 group + 3.
vec4 record_errors(uint record, uint group) {
  return texelFetch(record_error_texels, int(record * (k_lookup_lanes / 4u) + group));
}
#endif
