// Averages the pilot Hessians and irradiances of the records around each record, weighted by how well each serves there. A
// single pilot has few rays, and one chance hit would give its record an ellipse unlike its neighbours'. One invocation a
// record; the octree provides the neighbours.
#include "irradiance_cache/lookup.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PoolPush push; };
layout(scalar) writeonly buffer Pooled { vec4 pooled[]; };

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint own = push.first + index;
  int at = int(own * k_record_texels);
  vec3 x = texelFetch(record_texels, at).xyz, n = texelFetch(record_texels, at + 1).xyz, tangent, bitangent;
  make_basis(n, tangent, bitangent);
  vec4 sum = texelFetch(record_texels, at + 4);
  float weights = 1.0;
  OctreeRange range = octree_find(x);
  for (uint i = range.first; i < range.last; ++i) {
    uint other = octree_sphere(i);
    vec4 place = octree_copy(i), facing = texelFetch(record_texels, int(other * k_record_texels + 1u));
    vec4 hessian = texelFetch(record_texels, int(other * k_record_texels + 4u));
    float weight = other == own ? 0.0 : record_weight(x, n, place, facing, record_shape(other, place));
    // The neighbour's Hessian as a quadratic form on this record's plane.
    vec3 t, b;
    make_basis(facing.xyz, t, b);
    vec2 u = vec2(dot(tangent, t), dot(tangent, b)), v = vec2(dot(bitangent, t), dot(bitangent, b));
    mat2 h = mat2(hessian.x, hessian.y, hessian.y, hessian.z);
    sum += weight > 0.0 ? weight * vec4(dot(u, h * u), dot(u, h * v), dot(v, h * v), hessian.w) : vec4(0.0);
    weights += weight;
  }
  pooled[index] = sum / weights;
}
