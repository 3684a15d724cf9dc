// shaders/lib/lights.glsl with learned lights: draws a light from a row, and evaluates the density that weights a
// scattered ray which hits the same light.
#include "shaders/lib/invocation.glsl"
#include "shaders/lib/frame.glsl"
#include "shaders/lib/surface.glsl"
#include "shaders/lib/lights.glsl"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push {
  uint count;
  uint rows;
} push;
struct Pair {
  float drawn, met;   // densities
  uint cluster, kind; // 0: of the sky, 1: of a triangle, 2: a lamp
};
layout(scalar) writeonly buffer Pairs { Pair pairs[]; };

uint bits(uint i, uint k) { return hash_mix(hash_mix(8u * i + k) + 0x9e3779b9u * (k + 1u)); }

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  uint row = i % push.rows;
  vec3 position = vec3(0.3, 1.7, 0.4);
  vec2 u = vec2(uvec2(bits(i, 1u), bits(i, 2u)) >> 8) * (1.0 / 16777216.0);
  LightSample s = sample_light(position, vec3(0.0, 1.0, 0.0), bits(i, 0u), u, uvec2(bits(i, 3u), bits(i, 4u)), row);
  Pair p = Pair(s.pdf, s.pdf, s.cluster, 2u);
  if (s.primitive != k_no_hit) {
    p.kind = 1u;
    p.met = emissive_pdf(s.primitive, s.distance * s.distance, abs(dot(s.normal, s.direction))) * learned_ratio(row, emissive_cluster(s.primitive, s.uv));
  } else if (!s.delta) {
    p.kind = 0u;
    environment_radiance(s.direction, row, p.met);
#if LUCERNA_SKY_PORTALS
    p.met = with_portals(p.met, position, s.direction, row, k_no_portal, 0.0);
#endif
  }
  pairs[i] = p;
}
