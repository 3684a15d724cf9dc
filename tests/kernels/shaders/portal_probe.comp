// shaders/lib/lights.glsl with portals, one query per invocation.
// TEST_ASK 0: draws a direction through a portal; 1: the density of a direction through it; 2: draws a light by power, and
// evaluates the density that weights a scattered ray which hits the same light.
#include "shaders/lib/invocation.glsl"
#include "shaders/lib/frame.glsl"
#include "shaders/lib/surface.glsl"
#include "shaders/lib/lights.glsl"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push {
  uint count;
  uint portal;
  vec3 position;
} push;
struct Answer {
  vec3 direction;
  float pdf, again;
  uint portal;  // one that the direction passes through
};
layout(scalar) readonly buffer Questions { vec4 questions[]; };
layout(scalar) writeonly buffer Answers { Answer answers[]; };

uint bits(uint i, uint k) { return hash_mix(hash_mix(8u * i + k) + 0x9e3779b9u * (k + 1u)); }

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  Answer a;
  a.direction = vec3(0.0);
  a.pdf = a.again = 0.0;
  a.portal = k_no_portal;
  vec2 u = vec2(uvec2(bits(i, 1u), bits(i, 2u)) >> 8) * (1.0 / 16777216.0);
  uvec2 detail = uvec2(bits(i, 3u), bits(i, 4u));
#if TEST_ASK == 0
  a.direction = sample_portal(push.portal, push.position, detail, u, a.pdf);
  a.again = portal_pdf(push.portal, push.position, a.direction);
#elif TEST_ASK == 1
  a.direction = questions[i].xyz;
  a.pdf = portal_pdf(push.portal, push.position, a.direction);
#else
  LightSample s = sample_light(push.position, vec3(0.0, 1.0, 0.0), bits(i, 0u), u, detail, 0.0);
  a.direction = s.direction;
  a.pdf = s.pdf;
  environment_radiance(s.direction, a.again);
  a.again = with_portals(a.again, push.position, s.direction, 0u, k_no_portal, 0.0);
  for (uint p = 0u; p < uint(LUCERNA_PORTALS); ++p)
    if (portal_pdf(p, push.position, s.direction) > 0.0) a.portal = p;
#endif
  answers[i] = a;
}
