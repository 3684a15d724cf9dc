// Counts its invocations, marks each index once, and writes the arguments of an indirect dispatch.
#include "shaders/lib/invocation.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint k_step = 1u;
layout(push_constant) uniform Push { uint count; uint next_groups; } push;
buffer Marks { uint marks[]; };
buffer Total { uint total; };
buffer Arguments { uvec3 arguments; };

void main() {
  uint i = global_index();
  if (i == 0u) arguments = indirect_groups(push.next_groups);
  if (i >= push.count) return;
  marks[i] += k_step;
  atomicAdd(total, 1u);
}
