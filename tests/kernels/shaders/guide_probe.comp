// Directions that a record's guide gives for points of the unit square, and their densities.
#include "shaders/lib/invocation.glsl"
uniform samplerBuffer record_texels;
uniform samplerBuffer irradiance_texels;
#include "shaders/irradiance_cache/guide.glsl"
layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push {
  uint count, record;
  vec3 normal;
} push;
layout(scalar) readonly buffer Points { vec2 points[]; };
layout(scalar) writeonly buffer Drawn { vec4 drawn[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  Guide guide = make_guide(push.record, push.normal);
  vec3 direction = guide_sample(guide, points[i]);
  drawn[i] = vec4(direction, guide_density(guide, direction));
}
