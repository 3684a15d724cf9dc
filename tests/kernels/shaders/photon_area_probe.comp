// shaders/photons/area.glsl: the surface area around points, one per invocation.
#include "photons/area.glsl"
#include "shaders/lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push { uint count; } push;

struct Place {
  vec3 position;
  float radius;
  vec3 normal;
};
layout(scalar) readonly buffer Places { Place places[]; };
layout(scalar) writeonly buffer Areas { vec2 areas[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  areas[i] = photon_areas(places[i].position, places[i].normal, places[i].radius);
}
