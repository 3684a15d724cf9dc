// Tertiary light as a constant, wherever it is looked up (ambient.h).
#include "transport/vertex_hook.glsl"

layout(scalar) readonly buffer AmbientBlock {
  uint component[k_automaton_states];  // component of the light looked up there; k_component_count or more: none
  float radiance;
} ambient_light;

struct ambient_Vertex { uint component; };

ambient_Vertex ambient_read(VertexIn v, inout VertexOut o) {
  ambient_Vertex x = ambient_Vertex(ambient_light.component[v.state]);
  if (is_component(x.component))
    o.radiance[lane_of(0u, x.component)] += v.path.throughput * (v.bsdf.diffuse_albedo + v.bsdf.transmitted_albedo) * ambient_light.radiance;
  return x;
}
