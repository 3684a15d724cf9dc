// Radii as clamp_find.comp bounds them; what it reads is made ready for the next time.
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
  float told = texelFetch(record_texels, at + 2).w, least = least_radius(place.xyz, told);
  if (least == 0.0 && index < push.settled) return;
  shrink_record(index, place, shape, least, bound / shape.w);
  bool crowds = index >= push.settled && bound < push.crowd * least;
  records[at + 2].w = record_flags(told, crowds);
}
