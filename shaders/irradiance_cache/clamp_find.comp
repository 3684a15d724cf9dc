// Neighbour clamping (Krivanek, Bouatouch, Pattanaik and Zara, "Making Radiance and Irradiance Caching Practical: Adaptive
// Caching and Neighbor Clamping", 2006). The rays of one record miss narrow geometry that a neighbour's rays hit. By the
// triangle inequality, the geometry nearest to record j, at distance d_j, is at most d_j + |x_i - x_j| away from record i.
// One invocation for each j that has had more rays since its radius was set; the octree lists every i that would serve at
// its place, including j itself.
#include "irradiance_cache/lookup.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ClampPush push; };
layout(scalar) buffer Bounds { uint bounds[]; };  // minimum of the radii, as bits: positive floats sort like their bits

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  int at = int(index * k_record_texels);
  vec3 x = texelFetch(record_texels, at).xyz, n = texelFetch(record_texels, at + 1).xyz;
  float nearest = texelFetch(record_texels, at + 2).y;
  OctreeRange range = octree_find(x);
  for (uint i = range.first; i < range.last; ++i) {
    uint record = octree_sphere(i);
    vec4 place = octree_copy(i), facing = texelFetch(record_texels, int(record * k_record_texels + 1u));
    vec4 shape = record_shape(record, place);
    float bound = push.near * (nearest + distance(x, place.xyz));
    if (bound < shape.w && record_weight(x, n, place, facing, shape) > 0.0) atomicMin(bounds[record], floatBitsToUint(bound));
  }
}
