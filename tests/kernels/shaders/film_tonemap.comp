// The tone curves of shaders/shared/tone.h over a list of colours, as the device computes them.
#include "shaders/lib/invocation.glsl"
#include "shaders/shared/tone.h"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint count, curve; } push;
layout(scalar) readonly buffer Radiance { vec3 radiance[]; };
layout(scalar) buffer Shown { vec3 shown[]; };

void main() {
  uint i = global_index();
  if (i < push.count) shown[i] = tone_map(radiance[i], push.curve);
}
