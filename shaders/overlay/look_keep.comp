// Keeps what overlay/look.comp has found.
#include "shaders/shared/sight.h"
#include "lib/frame.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SeePush push; };
layout(scalar) readonly buffer Features { vec4 features[]; };
layout(scalar) writeonly buffer Surfaces { vec4 surfaces[]; };

void main() {
  uint slot = global_index();
  if (slot >= push.count) return;
  vec4 place = features[2u * slot], normal = features[2u * slot + 1u];
  uint at = (push.first + slot) * k_surface_texels;
  float depth = max(camera_depth(place.xyz - frame.camera_origin), 0.0);
  surfaces[at] = place.w > 0.0 ? vec4(place.xyz, depth) : vec4(0.0, 0.0, 0.0, k_surface_none);
  surfaces[at + 1u] = normal;
}
