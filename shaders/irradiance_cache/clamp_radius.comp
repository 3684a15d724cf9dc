// Applies the bounds of clamp_find.comp to the radii and resets them.
#include "lib/invocation.glsl"
#include "irradiance_cache/shrink.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ClampPush push; };
layout(scalar) buffer Bounds { uint bounds[]; };
uniform samplerBuffer record_texels;

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  float bound = uintBitsToFloat(bounds[index]);
  bounds[index] = k_no_bound;
  int at = int(index * k_record_texels);
  vec4 place = texelFetch(record_texels, at), shape = texelFetch(record_texels, at + 3);
  if (bound >= shape.w) return;
  shrink_record(index, place, shape, bound / shape.w);
  float texel = texelFetch(record_texels, at + 2).w;
  bool crowds = index >= push.undecided && bound < push.crowd * least_radius(place.xyz);
  records[at + 2].w = record_flags(texel, crowds);
}
