// shaders/lib/surface.glsl: reads the base-colour texture of material `index` at a list of coordinates.
#include "shaders/lib/invocation.glsl"
#include "shaders/lib/surface.glsl"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push { uint count, materials; } push;
layout(scalar) readonly buffer Coordinates { vec2 coordinates[]; };
layout(scalar) writeonly buffer Texels { vec4 texels[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  int material = int(i % push.materials * k_material_texels);
  texels[i] = read_use(material, k_use_base, LUCERNA_BASE_BUCKETS, coordinates[i], vec2(0.0), vec4(7.0));
}
