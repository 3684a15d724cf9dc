// Every invocation adds the same number to one sum.
#include "shaders/lib/invocation.glsl"
#include "shaders/lib/wide_sum.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint count; float each; } push;
buffer Sum { LongSum sum; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  uvec2 words = two_words(push.each);
  ADD_TO_LONG_SUM(sum, words.x, words.y);
}
