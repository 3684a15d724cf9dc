// Stores the positions of lookups (k_probe_reads), the two of each pixel side by side, in block order.
#include "shaders/shared/irradiance_cache/records.h"
#include "shaders/shared/facet.h"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ImportancePush push; };
uniform samplerBuffer candidate_texels;
layout(scalar) writeonly buffer Places { vec4 places[]; };

void main() {
  uint slot = global_index();
  if (slot >= 2u * push.pixels) return;
  vec4 place = texelFetch(candidate_texels, int(slot * k_candidate_texels));
  vec3 normal = texelFetch(candidate_texels, int(slot * k_candidate_texels + 1u)).xyz;
  bool there = place.w > 0.0;
  uint bits = there ? k_importance_place | facet_pack(normal) : 0u;
  places[2u * (push.first + slot % push.pixels) + slot / push.pixels] = vec4(place.xyz, uintBitsToFloat(bits));
}
