// shaders/lib/lights.glsl, one query per invocation.
// TEST_ASK 0: draws a light and a direction to it; 1: the environment's radiance and density; 2: the density of a
// direction to a triangle; 3: an entry of an alias table; 4: distance (x) and density of a direction (xyz) to the lamp with a
// shape of that number (w).
#include "shaders/lib/invocation.glsl"
#include "shaders/lib/frame.glsl"
#include "shaders/lib/surface.glsl"
#include "shaders/lib/lights.glsl"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push {
  uint count;
  uint seed;
  vec3 position;
} push;

struct Draw {
  vec3 direction;
  float distance;
  vec3 radiance;
  float pdf;
  vec3 target;
  uint primitive;
  vec3 normal;
  uint delta;
  vec2 uv;
};
struct Answer {
  vec3 value;
  float pdf;
};
layout(scalar) readonly buffer Questions { vec4 questions[]; };
layout(scalar) writeonly buffer Draws { Draw draws[]; };
layout(scalar) writeonly buffer Answers { Answer answers[]; };

// Independent uniform bits from a separate generator.
uint scramble(uint x) {
  x = (x ^ (x >> 17)) * 0xed5ad4bbu;
  x = (x ^ (x >> 11)) * 0xac4c1b51u;
  x = (x ^ (x >> 15)) * 0x31848babu;
  return x ^ (x >> 14);
}
uint bits(uint i, uint k) { return scramble(scramble(scramble(8u * i + k) + push.seed) + 0x9e3779b9u * (k + 1u)); }

void main() {
  uint i = global_index();
  if (i >= push.count) return;
#if TEST_ASK == 0
  vec2 u = vec2(uvec2(bits(i, 1u), bits(i, 2u)) >> 8) * (1.0 / 16777216.0);
  LightSample s = sample_light(push.position, vec3(0.0, 1.0, 0.0), bits(i, 0u), u, uvec2(bits(i, 3u), bits(i, 4u)), frame.environment_light_pmf);
  Draw d;
  d.direction = s.direction;
  d.distance = s.distance;
  d.radiance = s.radiance;
  d.pdf = s.pdf;
  d.target = s.target;
  d.primitive = s.primitive;
  d.normal = s.normal;
  d.delta = s.delta ? 1u : s.sky ? 2u : 0u;
  d.uv = s.uv;
  draws[i] = d;
#else
  Answer a;
  a.value = vec3(0.0);
  vec4 q = questions[i];
#if TEST_ASK == 1
#if LUCERNA_SEPARATE_SKY
  // Of the sky, or of the sun.
  Environment e = environment_radiance(q.xyz);
  a.value = q.w > 0.0 ? e.sun : e.sky;
  a.pdf = q.w > 0.0 ? e.pdf_sun * (1.0 - frame.environment_light_pmf) : e.pdf_sky * frame.environment_light_pmf;
#else
  a.value = environment_radiance(q.xyz, a.pdf);
#endif
#elif TEST_ASK == 2
  a.pdf = emissive_pdf(floatBitsToUint(q.x), q.y, q.z);
#elif TEST_ASK == 4
#if LUCERNA_SHAPES
  LampShape shape = load_shape(frame.first_shape + uint(q.w));
  a.value = vec3(shape_hit(shape, push.position, q.xyz), 0.0, 0.0);
  a.pdf = shape_pdf(shape, push.position, q.xyz);
#endif
#else
  a.value.x = float(alias_choose(light_alias, frame.light_count, uvec2(bits(i, 0u), bits(i, 1u)), a.pdf));
#endif
  answers[i] = a;
#endif
}
