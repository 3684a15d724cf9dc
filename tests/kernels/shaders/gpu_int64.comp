// 64-bit fixed-point sums: the order of additions does not matter.
#include "shaders/lib/invocation.glsl"

layout(local_size_x = 64) in;
buffer Sum { uint64_t sum; };

void main() { atomicAdd(sum, uint64_t(1) << (global_index() & 31u)); }
