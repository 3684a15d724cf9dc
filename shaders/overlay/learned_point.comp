// Finds the surface of one pixel and its row of learned lights. One invocation.
#include "lib/variants.glsl"
#include "lib/invocation.glsl"
#include "lib/learned_lights.glsl"
#include "overlay/seen.glsl"
#include "shaders/shared/learned_view.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { LearnedViewPush push; };
layout(scalar) writeonly buffer LearnedPoints { LearnedPoint learned_point; };

void main() {
  if (global_index() > 0u) return;
  Seen s = seen_at(push.pixel, push.width, push.height);
  learned_point.position = s.position;
  learned_point.solid = s.solid ? 1u : 0u;
  learned_point.normal = s.normal;
  learned_point.row = s.solid ? learned_row(s.position, s.normal) : 0u;
}
