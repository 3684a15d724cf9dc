// Which records would serve at another's place, and how far from their centres: one invocation for each record,
// at whose place the octree knows whoever may. LUCERNA_WRITE: 0 counts them, 1 writes them where the sum of the counts says.
#include "lib/variants.glsl"
#include "irradiance_cache/lookup.glsl"
#include "lib/invocation.glsl"
#include "shaders/shared/irradiance_cache/neighbours.h"
#include "shaders/shared/sort.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { NeighbourPush push; };
layout(scalar) buffer PairCounts { uint pair_counts[]; };
layout(scalar) readonly buffer PairsBefore { uint pairs_before[]; };
layout(scalar) writeonly buffer Pairs { SortEntry64 pairs[]; };

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  vec3 x = texelFetch(record_texels, int(index * k_record_texels)).xyz;
  vec3 n = texelFetch(record_texels, int(index * k_record_texels + 1u)).xyz;
  uint found = 0u;
#if LUCERNA_WRITE
  uint to = pairs_before[index];
#endif
  OctreeRange range = octree_find(x);
  for (uint i = range.first; i < range.last; ++i) {
    uint record = octree_sphere(i);
    vec4 place = octree_copy(i), facing = texelFetch(record_texels, int(record * k_record_texels + 1u));
    vec4 shape = record_shape(record, place);
    vec3 away = x - place.xyz;
    float far = record_far(away, place, shape);
    if (record == index || far >= 1.0 || record_weight(x, n, place, facing, shape) <= 0.0) continue;
#if LUCERNA_WRITE
    pairs[to + found] = SortEntry64(floatBitsToUint(far) | record << k_neighbour_distance_bits,
                                    record >> (32u - k_neighbour_distance_bits), index, 0u);
#endif
    ++found;
  }
#if !LUCERNA_WRITE
  pair_counts[index] = found;
#endif
}
