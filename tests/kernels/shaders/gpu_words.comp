// Copies the words of a texel buffer.
#include "shaders/lib/invocation.glsl"

layout(local_size_x = 32) in;
layout(push_constant) uniform Push { uint count; } push;
uniform usamplerBuffer words;
buffer Result { uvec4 result[]; };

void main() {
  uint i = global_index();
  if (i < push.count) result[i] = texelFetch(words, int(i));
}
