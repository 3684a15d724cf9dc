// Ellipse of validity of a record, from the Hessian of its irradiance E (hessian.comp, pool.comp). Both come from pilot
// rays: with the record's own rays, a record that met much light by chance would get a smaller ellipse than one that missed
// it, and the interpolation would be biased towards dark. At offset (x, y) along the axes of the Hessian, extrapolation
// misses (|l1| x^2 + |l2| y^2) / 2. Its integral, relative to E, over an ellipse with axes R1/R2 = sqrt(l2/l1) is pi/4
// l1^1.5 l2^-0.5 R1^4 / E. Setting it to pi/4 reach^4 for every record gives
//
//   R1 = reach (E/l1)^(1/4) (l2/l1)^(1/8),   R2 likewise with l1 and l2 exchanged
//
// (Schwarzhaupt et al. 2012; equal errors need the fewest records). The bounds are those of radius.comp. E is at least
// `dark`:
// darker records may have the absolute error that brighter ones have.
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/invocation.glsl"
#include "irradiance_cache/ellipse.glsl"
#include "irradiance_cache/least_radius.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { EllipsePush push; };
uniform samplerBuffer record_texels;
layout(scalar) writeonly buffer Records { vec4 records[]; };
layout(scalar) writeonly buffer Spheres { vec4 spheres[]; };  // bounds in the octree

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
  // Depends on the geometry alone, not on the light.
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
