// The shares that every record has in the two lookups of a pixel, multiplied, and added up over the pixels: one invocation a
// pixel. In whole steps, so that no order matters.
#include "irradiance_cache/lookup.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { WorthPush push; };
uniform samplerBuffer place_texels;   // position; bits: normal, k_worth_there
layout(scalar) buffer Sums { uint sums[]; };

struct Reader {
  vec3 x, n;
  bool there;
};
Reader reader(uint at) {
  vec4 place = texelFetch(place_texels, int(at));
  uint bits = floatBitsToUint(place.w);
  return Reader(place.xyz, facet_unpack(bits), (bits & k_worth_there) != 0u);
}

float weight_at(Reader r, uint record, vec4 place, vec4 facing, vec4 shape) {
  vec3 away = r.x - place.xyz;
  return dot(away, away) < square(place.w) ? record_weight(r.x, r.n, place, facing, shape) : 0.0;
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.pixels) return;
  Reader one = reader(2u * pixel), other = reader(2u * pixel + 1u);
  bool both = one.there && other.there;
  float all_other = 0.0;
  OctreeRange range = cache_range(other.x, both);
  for (uint i = range.first; i < range.last; ++i) {
    vec4 place = octree_copy(i);
    uint record = octree_sphere(i);
    vec4 facing = texelFetch(record_texels, int(record * k_record_texels + 1u));
    all_other += weight_at(other, record, place, facing, record_shape(record, place));
  }
  range = cache_range(one.x, both && all_other > 0.0);
  float all_one = 0.0;
  for (uint i = range.first; i < range.last; ++i) {
    vec4 place = octree_copy(i);
    uint record = octree_sphere(i);
    vec4 facing = texelFetch(record_texels, int(record * k_record_texels + 1u));
    all_one += weight_at(one, record, place, facing, record_shape(record, place));
  }
  for (uint i = range.first; i < range.last; ++i) {
    vec4 place = octree_copy(i);
    uint record = octree_sphere(i);
    vec4 facing = texelFetch(record_texels, int(record * k_record_texels + 1u)), shape = record_shape(record, place);
    float share = weight_at(one, record, place, facing, shape) * weight_at(other, record, place, facing, shape);
    if (share > 0.0) atomicAdd(sums[record], uint(share / (all_one * all_other) * float(k_worth_steps) + 0.5));
  }
}
