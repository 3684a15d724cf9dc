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

// Of the record in place i of the octree's lists; 0: it does not serve there.
float weight_at(Reader r, uint i) {
  uint record = octree_sphere(i);
  vec4 place = octree_copy(i), facing = texelFetch(record_texels, int(record * k_record_texels + 1u));
  vec3 away = r.x - place.xyz;
  return dot(away, away) < square(place.w) ? record_weight(r.x, r.n, place, facing, record_shape(record, place)) : 0.0;
}
float weight_of_all(Reader r, OctreeRange range) {
  float sum = 0.0;
  for (uint i = range.first; i < range.last; ++i) sum += weight_at(r, i);
  return sum;
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.pixels) return;
  Reader one = reader(2u * pixel), other = reader(2u * pixel + 1u);
  bool both = one.there && other.there;
  float all_other = weight_of_all(other, cache_range(other.x, both));
  OctreeRange range = cache_range(one.x, both && all_other > 0.0);
  float all_one = weight_of_all(one, range);
  for (uint i = range.first; i < range.last; ++i) {
    float product = weight_at(one, i) * weight_at(other, i);
    if (product > 0.0)
      atomicAdd(sums[octree_sphere(i)], uint(product / (all_one * all_other) * float(k_worth_steps) + 0.5));
  }
}
