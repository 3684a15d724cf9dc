// Which path slots hold a candidate that is to be collected, in the order of collecting, and how many ask, by block and
// origin.
#include "shaders/shared/irradiance_cache/placement.h"
#include "shaders/shared/irradiance_cache/records.h"
#include "irradiance_cache/collect.glsl"
uniform samplerBuffer candidate_texels;
layout(scalar) writeonly buffer Taken { uint taken[]; };
layout(scalar) buffer Asked { uint asked[]; };  // three of each block, by k_origin_*

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  float told = texelFetch(candidate_texels, int(slot_of(index) * k_candidate_texels)).w;
  uint origin = told > 0.0 ? (uint(told) - 1u) % k_candidate_media : 0u;
  taken[index] = told > 0.0 && (origin != k_origin_screen || push.screen_too != 0u) ? 1u : 0u;
  if (told > 0.0) atomicAdd(asked[index / (64u * push.samples) * 3u + origin], 1u);
}
