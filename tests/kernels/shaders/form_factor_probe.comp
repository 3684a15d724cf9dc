// shaders/irradiance_cache/form_factor.glsl: one edge per invocation.
#include "shaders/lib/invocation.glsl"
#include "shaders/irradiance_cache/form_factor.glsl"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push { uint count; } push;

struct Edge {
  vec3 a;
  float near_a;
  vec3 b;
  float near_b;
};
layout(scalar) readonly buffer Edges { Edge edges[]; };
layout(scalar) writeonly buffer Terms { float terms[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  Edge e = edges[i];
  EdgeTerms t = edge_terms(e.a, e.near_a, e.b, e.near_b);
  terms[6u * i] = t.value;
  terms[6u * i + 1u] = t.gradient.x;
  terms[6u * i + 2u] = t.gradient.y;
  terms[6u * i + 3u] = t.hessian.x;
  terms[6u * i + 4u] = t.hessian.y;
  terms[6u * i + 5u] = t.hessian.z;
}
