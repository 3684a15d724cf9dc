// Importance of records: for the two lookups of a pixel the product of each record's shares, summed over the pixels. The
// next lookups along the paths count too, scaled by their part of the irradiance at the first. One invocation a pixel. Sums
// are integers, so the order does not matter.
#include "irradiance_cache/reading.glsl"
#include "lib/invocation.glsl"
#include "lib/wide_sum.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ImportancePush push; };
uniform samplerBuffer place_texels, next_place_texels;  // position; bits: normal, k_importance_place
layout(scalar) buffer Sums { WideSum sums[]; };  // per record

// Assumed albedo of the surfaces that a record's rays hit.
const float k_returned = 0.5;

struct Reader {
  vec3 x, n;
  bool there;
};
Reader reader(vec4 place) {
  uint bits = floatBitsToUint(place.w);
  return Reader(place.xyz, facet_unpack(bits), (bits & k_importance_place) != 0u);
}

// Weight of the record at place i of the octree's lists; 0: it does not serve.
float weight_at(Reader r, uint i) {
  uint record = octree_sphere(i);
  vec4 place = octree_copy(i), facing = texelFetch(record_texels, int(record * k_record_texels + 1u));
  vec3 away = r.x - place.xyz;
  bool within = dot(away, away) < square(place.w) && !record_crowded(record);
  return within ? record_weight(r.x, r.n, place, facing, record_shape(record, place)) : 0.0;
}
struct Read {
  float weights;  // sum over the records that serve; 0: none
  float light;    // luminance of the irradiance
};
Read read_at(Reader r, OctreeRange range) {
  Read all = Read(0.0, 0.0);
  for (uint i = range.first; i < range.last; ++i) {
    float weight = weight_at(r, i);
    all.weights += weight;
    all.light += weight > 0.0 ? weight * record_luminance(octree_sphere(i)) : 0.0;
  }
  all.light /= max(all.weights, 1e-30);
  return all;
}

// `scale`: multiplies the product of the two shares.
void add(Reader one, Read all_one, OctreeRange range, Reader other, Read all_other, float scale) {
  for (uint i = range.first; i < range.last; ++i) {
    float product = weight_at(one, i) * weight_at(other, i);
    if (product <= 0.0) continue;
    uint steps = uint(scale * product / (all_one.weights * all_other.weights) * float(k_importance_steps) + 0.5);
    ADD_TO_WIDE_SUM(sums[octree_sphere(i)], steps);
  }
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.pixels) return;
  Reader one = reader(texelFetch(place_texels, int(2u * pixel))), other = reader(texelFetch(place_texels, int(2u * pixel + 1u)));
  bool both = one.there && other.there;
  Read all_other = read_at(other, cache_range(other.x, both));
  OctreeRange range = cache_range(one.x, both && all_other.weights > 0.0);
  Read all_one = read_at(one, range);
  add(one, all_one, range, other, all_other, 1.0);
  if (push.next == 0u || all_one.weights <= 0.0 || all_other.weights <= 0.0) return;
  Reader next = reader(texelFetch(next_place_texels, int(2u * pixel))),
         next_other = reader(texelFetch(next_place_texels, int(2u * pixel + 1u)));
  bool both_next = next.there && next_other.there;
  Read all_next_other = read_at(next_other, cache_range(next_other.x, both_next));
  range = cache_range(next.x, both_next && all_next_other.weights > 0.0);
  Read all_next = read_at(next, range);
  float ratio = min(k_returned * all_next.light / max(all_one.light, 1e-30), k_importance_most);
  float other_ratio = min(k_returned * all_next_other.light / max(all_other.light, 1e-30), k_importance_most);
  add(next, all_next, range, next_other, all_next_other, ratio * other_ratio);
}
