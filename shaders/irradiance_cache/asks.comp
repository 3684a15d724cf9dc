// Which path slots hold a candidate that is to be collected, and how many ask by origin.
#include "shaders/shared/placement.h"
#include "shaders/shared/irradiance_cache.h"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CollectPush push; };
uniform samplerBuffer candidate_texels;
layout(scalar) writeonly buffer Taken { uint taken[]; };
layout(scalar) buffer Asked { uint asked[]; };  // by k_origin_*

void main() {
  uint slot = global_index();
  if (slot >= push.count) return;
  float told = texelFetch(candidate_texels, int(slot * k_candidate_texels)).w;
  uint origin = told > 0.0 ? uint(told) - 1u : 0u;
  taken[slot] = told > 0.0 && (origin != k_origin_screen || push.screen_too != 0u) ? 1u : 0u;
  if (told > 0.0) atomicAdd(asked[origin], 1u);
}
