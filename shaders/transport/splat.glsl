// Splats the light of paths connected to the camera: adds it to the sums of a pixel (shared/splat.h) instead of a path's
// radiance (LUCERNA_SPLATS_SUMMED in shadow.comp).
#ifndef LUCERNA_TRANSPORT_SPLAT
#define LUCERNA_TRANSPORT_SPLAT
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "lib/wide_sum.glsl"
#include "shaders/shared/splat.h"

layout(scalar) readonly buffer SplatBlock { SplatFrame splat_frame; };
layout(scalar) buffer SplatRed { LongSum splat_red[]; };
layout(scalar) buffer SplatGreen { LongSum splat_green[]; };
layout(scalar) buffer SplatBlue { LongSum splat_blue[]; };
#if LUCERNA_GROUP_SUMS
layout(scalar) buffer SplatOwnerList { SplatOwners splat_owners[]; };
#endif
#if LUCERNA_SPLATS_WEIGHED
layout(scalar) buffer SplatContributions { LongSum splat_contributions[]; };  // by stratum of emission
#endif

#if LUCERNA_GROUP_SUMS
// `exponential`: a random number from the exponential distribution of rate 1.
uint splat_owner(float exponential, float light, uint group) {
  uint bits = light > 0.0 ? floatBitsToUint(exponential / light) : 0xffffffffu;
  return bits >> k_splat_owner_bits << k_splat_owner_bits | group;
}
#endif

// `state`: lanes: pixel in the band; tag: stratum, if recorded. Values are rounded up or down at random, so that dim light
// is not lost; the path's own random numbers make this reproducible.
void add_splat(uint slot, ShadowState state) {
  vec3 units = state.diffuse / splat_frame.unit;
  bool fits = is_finite(units) && max3(units) < k_most_splat;
  if (!fits) atomicAdd(counters[k_counter_dropped], 1u);
  units = fits ? units : vec3(0.0);
  PathState path = load_path(slot);
  uint key = hash_combine(hash_combine(path.pixel, path.sample_index), splat_frame.first + state.lanes);
  vec3 coin = vec3(uvec3(key, hash_mix(key), hash_mix(key ^ 0x68bc21ebu)) >> 8u) * (1.0 / 16777216.0);
#if LUCERNA_GROUP_SUMS && !LUCERNA_SPLATS_WEIGHED
  // One random number for all channels: they then mostly belong to one path.
  float exponential = -log((float(hash_mix(key ^ 0x02e5be93u) >> 8u) + 0.5) * (1.0 / 16777216.0));
  atomicMin(splat_owners[state.lanes].red, splat_owner(exponential, units.r, path.light_group));
  atomicMin(splat_owners[state.lanes].green, splat_owner(exponential, units.g, path.light_group));
  atomicMin(splat_owners[state.lanes].blue, splat_owner(exponential, units.b, path.light_group));
#endif
  units += coin;
#if LUCERNA_SPLATS_WEIGHED
  uvec2 contribution = two_words(min(luminance(units), k_most_splat));
  ADD_TO_LONG_SUM(splat_contributions[state.tag], contribution.x, contribution.y);
#else
  uvec2 red = two_words(units.r), green = two_words(units.g), blue = two_words(units.b);
  ADD_TO_LONG_SUM(splat_red[state.lanes], red.x, red.y);
  ADD_TO_LONG_SUM(splat_green[state.lanes], green.x, green.y);
  ADD_TO_LONG_SUM(splat_blue[state.lanes], blue.x, blue.y);
#endif
}
#endif
