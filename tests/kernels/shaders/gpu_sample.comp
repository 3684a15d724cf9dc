// One texel of a texel buffer, and one sample of a texture array, for each invocation.
#include "shaders/lib/invocation.glsl"

layout(local_size_x = 32) in;
layout(push_constant) uniform Push { uint count; } push;
uniform samplerBuffer texels;
uniform sampler2DArray images;
buffer Where { vec3 where[]; };
buffer Result { vec4 result[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  result[2u * i] = texelFetch(texels, int(i));
  result[2u * i + 1u] = textureLod(images, where[i], 0.0);
}
