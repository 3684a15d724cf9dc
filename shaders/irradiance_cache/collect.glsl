// Order in which candidates are collected.
#ifndef LUCERNA_COLLECT_GLSL
#define LUCERNA_COLLECT_GLSL
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CollectPush push; };

// Block by block, so the order does not depend on how many blocks one dispatch covers. Slots are ordered sample by sample.
uint slot_of(uint index) {
  uint block = index / (64u * push.samples), within = index % (64u * push.samples);
  return within / 64u * (push.count / push.samples) + 64u * block + within % 64u;
}
#endif
