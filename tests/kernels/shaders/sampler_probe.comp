// One point of shaders/lib/sampler.glsl per invocation, by pad or by vertex and purpose.
#include "shaders/lib/invocation.glsl"
#ifndef TEST_VERTEX
#define TEST_VERTEX 0
#endif
#ifndef TEST_UNIT
#define TEST_UNIT 0
#endif
#include "shaders/lib/sampler.glsl"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push { uint count; } push;

struct Place {
  uint pixel, sample_index, seed, pad, width;
};
struct Point {
  uvec2 bits;
  vec2 unit;
};
layout(scalar) readonly buffer Places { Place places[]; };
layout(scalar) writeonly buffer Points { Point points[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  Place p = places[i];
  Sampler s = make_sampler(p.pixel, p.width, p.sample_index, p.seed);
  Point result;
#if TEST_VERTEX
  // pad: depth * 256 + purpose
  result.bits = sample_vertex_bits(s, p.pad >> 8, p.pad & 255u);
  result.unit = sample_vertex(s, p.pad >> 8, p.pad & 255u);
#elif TEST_UNIT
  result.bits = uvec2(p.pixel, p.sample_index);
  result.unit = to_unit(result.bits);
#else
  result.bits = sample_2d_bits(s, p.pad);
  result.unit = sample_2d(s, p.pad);
#endif
  points[i] = result;
}
