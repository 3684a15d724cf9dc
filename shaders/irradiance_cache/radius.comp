// Radius of validity of a record: error bound times the harmonic mean of its ray distances (Ward 1988). At least some pixels
// as seen from the camera, and at most the nearest hit distance, so that nothing stands between a record and a point it
// serves.
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/invocation.glsl"
#include "irradiance_cache/least_radius.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { RadiusPush push; };
uniform samplerBuffer record_texels;
layout(scalar) writeonly buffer Records { vec4 records[]; };
layout(scalar) writeonly buffer Spheres { vec4 spheres[]; };  // bounds in the octree

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  int at = int((push.first + index) * k_record_texels);
  vec4 place = texelFetch(record_texels, at), facing = texelFetch(record_texels, at + 1);
  vec4 texel = texelFetch(record_texels, at + 2);
  float least = least_radius(place.xyz);
  float holds_nothing = push.near * texel.y;
  bool crowds = record_flagged_crowded(texel.w) || holds_nothing < push.crowd * least;
  float radius = crowds ? least : max(min(push.error * facing.w, min(push.most, holds_nothing)), least);
  records[at].w = radius;
  records[at + 3] = vec4(0.0, 0.0, 0.0, radius);
  spheres[push.first + index] = vec4(place.xyz, radius);
  records[at + 2].w = record_flags(texel.w, crowds);
}
