// Every invocation adds to one sum, some of them 0.
#include "shaders/lib/invocation.glsl"
#include "shaders/lib/wide_sum.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint count; uint each; } push;
buffer Sum { WideSum sum; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  ADD_TO_WIDE_SUM(sum, i % 3u == 0u ? 0u : push.each + i);
}
