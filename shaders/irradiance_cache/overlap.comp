// Histogram of the number of records that serve a visible diffuse surface, over pixels. Integer sums: the order does not
// matter.
#include "lib/invocation.glsl"
#include "irradiance_cache/lookup.glsl"
#include "overlay/lookup_place.glsl"
#include "shaders/shared/irradiance_cache/inspect.h"
#include "lib/wide_sum.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OverlapPush push; };
layout(scalar) buffer Overlap { OverlapCounts counts; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  LookupPlace a = lookup_place(pixel, push.width, push.grid, seen_at(pixel, push.width, push.height));
  uint overlap = 0u;
  Nearest nearest = nothing_near();
  OctreeRange range = cache_range(a.position, a.answerable);
  for (uint i = range.first; i < range.last; ++i) {
    uint record = octree_sphere(i);
    int at = int(record * k_record_texels);
    vec4 place = texelFetch(record_texels, at), facing = texelFetch(record_texels, at + 1);
    float weight = record_weight(a.position, a.normal, place, facing, record_shape(record, place));
    bool crowds = record_crowded(record);
    nearest = nearer(nearest, weight, a.position - place.xyz, crowds);
    overlap += weight > 0.0 && !crowds ? 1u : 0u;
  }
  bool gathers = paths_gather(nearest);
  if (gathers) overlap = 0u;
  if (!a.diffuse) return;
  atomicAdd(counts.pixels[min(overlap, k_overlap_bins - 1u)], 1u);
  if (gathers) atomicAdd(counts.gathered, 1u);
  ADD_TO_WIDE_SUM(counts.records, overlap);
  ADD_TO_WIDE_SUM(counts.listed, range.last - range.first);
  atomicMax(counts.most, overlap);
}
