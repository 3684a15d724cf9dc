// target = source * factor + OFFSET, and one resource of each kind that is declared but not used.
#include "lib/gpu_offset.glsl"
#include "shaders/lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
  uint count;
  float factor;
} push;
buffer Unused { float unused[]; };
uniform samplerBuffer unused_texels;
layout(set = 0, binding = 0) readonly buffer Source { float source[]; };
buffer Target { float target[]; };

float never_called(int i) { return unused[i] + texelFetch(unused_texels, i).x; }

void store(uint i, float value) { target[i] = value; }

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  store(i, source[i] * push.factor + k_offset);
}
