// The ellipse within which a record serves, from the Hessian of the irradiance E (hessian.comp, pool.comp). Both are of pilot
// rays: with the record's own a record that has met much light by chance would reach less far than one that has missed it, and
// what is interpolated would be too dark. At an offset of (x, y) along
// the Hessian's axes extrapolation misses (|l1| x^2 + |l2| y^2) / 2. The integral of that, relative to E, over an ellipse
// with axes R1/R2 = sqrt(l2/l1) is pi/4 l1^1.5 l2^-0.5 R1^4 / E. Held to pi/4 reach^4 for every record it gives
//
//   R1 = reach (E/l1)^(1/4) (l2/l1)^(1/8),   R2 likewise with l1 and l2 exchanged
//
// (Schwarzhaupt et al. 2012; the same error for every record is what costs the fewest records). Bounded as radius.comp has
// it. What is darker than `dark` is held against that: it may miss as much as would be seen elsewhere.
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/invocation.glsl"
#include "irradiance_cache/ellipse.glsl"
#include "irradiance_cache/least_radius.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { EllipsePush push; };
uniform samplerBuffer record_texels;
layout(scalar) writeonly buffer Records { vec4 records[]; };
layout(scalar) writeonly buffer Spheres { vec4 spheres[]; };  // of the octree

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint record = push.first + index;
  int at = int(record * k_record_texels);
  vec4 place = texelFetch(record_texels, at), bends = texelFetch(record_texels, at + 4);
  vec3 normal = texelFetch(record_texels, at + 1).xyz;
  vec4 texel = texelFetch(record_texels, at + 2);
  float holds_nothing = texelFetch(record_texels, at + 5).y;
  Principal p = principal_curvatures(bends.xyz);

  float least = least_radius(place.xyz);
  float bends_by = p.strongest / max(max(bends.w, push.dark), 1e-30);
  float minor = bends_by > 0.0 ? push.reach * inversesqrt(sqrt(bends_by * p.ratio)) : push.most;
  minor = min(minor, holds_nothing > 0.0 ? push.near * holds_nothing : push.near_tried * texel.y);
  // By what is near alone, so that it does not hang on the light.
  bool crowds = record_flagged_crowded(texel.w) || push.near * texel.y < push.crowd * least;
  float major = crowds ? least : clamp(p.ratio * minor, least, push.most);
  minor = crowds ? least : clamp(minor, least, push.most);
  vec3 tangent, bitangent;
  make_basis(normal, tangent, bitangent);
  vec3 along = p.along.x * tangent + p.along.y * bitangent;
  records[at].w = major;
  records[at + 3] = vec4(along * sqrt(max(0.0, 1.0 / square(minor) - 1.0 / square(major))), minor);
  spheres[record] = vec4(place.xyz, major);
  records[at + 2].w = record_flags(texel.w, crowds);
}
