// Marks the path slots that hold a candidate to collect, and counts the candidates by block and origin.
#include "shaders/shared/irradiance_cache/placement.h"
#include "shaders/shared/irradiance_cache/records.h"
#include "irradiance_cache/collect.glsl"
uniform samplerBuffer candidate_texels;
layout(scalar) writeonly buffer Taken { uint taken[]; };
layout(scalar) buffer CandidateCounts { uint counts[]; };  // three for each block, by k_origin_*

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  float origin_code = texelFetch(candidate_texels, int(slot_of(index) * k_candidate_texels)).w;
  uint origin = origin_code > 0.0 ? (uint(origin_code) - 1u) % k_candidate_media : 0u;
  taken[index] = origin_code > 0.0 && (origin != k_origin_screen || push.screen_too != 0u) ? 1u : 0u;
  if (origin_code > 0.0) atomicAdd(counts[index / (64u * push.samples) * 3u + origin], 1u);
}
