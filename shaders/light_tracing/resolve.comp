// A round's picture of its sums, which begin again at nothing.
#include "lib/invocation.glsl"
#include "shaders/shared/splat.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SplatPush push; };
layout(scalar) readonly buffer SplatBlock { SplatFrame splat_frame; };
layout(scalar) buffer SplatSums { SplatSum splat_sums[]; };
layout(scalar) writeonly buffer SplatPicture { vec4 splat_pixels[]; };
layout(scalar) buffer SplatCounts { uint splat_counts[]; };

float in_units(LongSum sum) { return (float(sum.high) * 4294967296.0 + float(sum.middle)) * 4294967296.0 + float(sum.low); }

void main() {
  uint pixel = global_index();
  if (pixel >= push.count) return;
  SplatSum sum = splat_sums[pixel];
  vec3 light = vec3(in_units(sum.red), in_units(sum.green), in_units(sum.blue)) * splat_frame.unit;
  splat_pixels[pixel] = vec4(light, 0.0);
  bool lit = light.r + light.g + light.b > 0.0;
  if (!lit) return;
  atomicAdd(splat_counts[k_splats_pixels], 1u);
  LongSum none = LongSum(0u, 0u, 0u);
  splat_sums[pixel] = SplatSum(none, none, none);
}
