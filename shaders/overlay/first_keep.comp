// Stores the surface found by overlay/first.comp: normal on the visible side, depth along the view axis [m], 0 for none.
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
  vec4 place = features[2u * slot];
  float depth = max(camera_depth(place.xyz - frame.camera_origin), 0.0);
  surfaces[push.first + slot] = vec4(features[2u * slot + 1u].xyz, place.w > 0.0 ? depth : 0.0);
}
