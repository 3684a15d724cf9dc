// Tertiary light as a constant, wherever it is looked up (ambient.h).
#ifndef LUCERNA_TESTS_AMBIENT
#define LUCERNA_TESTS_AMBIENT
#include "transport/vertex_hook.glsl"

layout(scalar) readonly buffer AmbientBlock {
  uint component[k_automaton_states];  // component of the light looked up there, k_component_count: none
  float radiance;
} ambient_light;

struct ambient_Vertex { uint component; };

ambient_Vertex ambient_read(VertexIn v, inout VertexOut o) {
  ambient_Vertex x = ambient_Vertex(ambient_light.component[v.state]);
  if (x.component < k_component_count)
    o.radiance[lane_of(0u, x.component)] += v.path.throughput * (v.bsdf.diffuse_albedo + v.bsdf.transmitted_albedo) * ambient_light.radiance;
  return x;
}
vec3 ambient_cosine(VertexIn v, inout ambient_Vertex x, vec2 u, vec3 cosine) { return cosine; }
void ambient_weigh(VertexIn v, ambient_Vertex x, vec3 direction, inout BsdfSample b) {}
uint ambient_state(VertexIn v, ambient_Vertex x, BsdfSample b, uint state) { return state; }
void ambient_leave(VertexIn v, inout ambient_Vertex x, Leaving l, inout vec3 throughput, inout bool go_on) {}
void ambient_end(VertexIn v, ambient_Vertex x) {}
#endif
