// Replaces the records' own pilot results with those of pool.comp.
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PoolPush push; };
uniform samplerBuffer pooled_texels;
layout(scalar) writeonly buffer Records { vec4 records[]; };

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  records[(push.first + index) * k_record_texels + 4u] = texelFetch(pooled_texels, int(index));
}
