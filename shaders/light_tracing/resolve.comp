// Converts the sums of a round to its picture and clears them. Alpha: bits of the light groups of the channels, four bits
// each.
#include "lib/variants.glsl"
#include "lib/invocation.glsl"
#include "shaders/shared/splat.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SplatPush push; };
layout(scalar) readonly buffer SplatBlock { SplatFrame splat_frame; };
layout(scalar) buffer SplatRed { LongSum splat_red[]; };
layout(scalar) buffer SplatGreen { LongSum splat_green[]; };
layout(scalar) buffer SplatBlue { LongSum splat_blue[]; };
#if LUCERNA_GROUP_SUMS
layout(scalar) buffer SplatOwnerList { SplatOwners splat_owners[]; };
#endif
layout(scalar) writeonly buffer SplatPicture { vec4 splat_pixels[]; };
layout(scalar) buffer SplatCounts { uint splat_counts[]; };

float in_units(LongSum sum) { return (float(sum.high) * 4294967296.0 + float(sum.middle)) * 4294967296.0 + float(sum.low); }

void main() {
  uint pixel = global_index();
  if (pixel >= push.count) return;
  vec3 light = vec3(in_units(splat_red[pixel]), in_units(splat_green[pixel]), in_units(splat_blue[pixel])) * splat_frame.unit;
  bool lit = light.r + light.g + light.b > 0.0;
  uint groups = 0u;
#if LUCERNA_GROUP_SUMS
  SplatOwners owners = splat_owners[pixel];
  const uint k_group = (1u << k_splat_owner_bits) - 1u;
  groups = (owners.red & k_group) | (owners.green & k_group) << k_splat_owner_bits |
           (owners.blue & k_group) << 2u * k_splat_owner_bits;
#endif
  splat_pixels[pixel] = vec4(light, uintBitsToFloat(lit ? groups : 0u));
  if (!lit) return;
#if LUCERNA_GROUP_SUMS
  splat_owners[pixel] = SplatOwners(0xffffffffu, 0xffffffffu, 0xffffffffu);
#endif
  atomicAdd(splat_counts[k_splats_pixels], 1u);
  LongSum none = LongSum(0u, 0u, 0u);
  splat_red[pixel] = splat_green[pixel] = splat_blue[pixel] = none;
}
