// Share of each light group in the light of a batch of records (groups.glsl). One invocation per record and four groups.
// Runs before gather.comp, while the stored irradiance is still that of the levels before.
#define LUCERNA_PUSH RecordPush
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/wavefront.glsl"
#include "irradiance_cache/hemisphere.glsl"
#include "irradiance_cache/groups.glsl"

uniform samplerBuffer irradiance_texels;
layout(scalar) writeonly buffer RecordGroups { uvec4 record_groups[]; };

vec3 light_of_part(uint slot, uint part) { return texelFetch(radiance_texels, int(radiance_texel(slot, lane_of(0u, part)))).rgb; }
bool wanted(uint part) { return (push.parts >> part & 1u) != 0u; }

void main() {
  uint index = global_index();
  if (index >= push.records * k_group_texels) return;
  uint entry = index % push.records, first = index / push.records * 4u;
  uint record = record_list[push.first + entry];
  uint m = push.elevations, n = push.azimuths;
  vec3 all = vec3(0.0), of_group[4];
  for (uint i = 0u; i < 4u; ++i) of_group[i] = vec3(0.0);
  for (uint cell = 0u; cell < m * n; ++cell) {
    uint slot = cell_slot(cell % m, cell / m, entry);
    for (uint p = k_part_direct + 1u; p < k_part_count; ++p)
      if (wanted(p)) all += light_of_part(slot, p);
    uint lit = groups_lit(slot);
    // Direct sky light also belongs to the sky's group.
    vec3 direct = wanted(k_part_direct) ? light_of_part(slot, k_part_direct) : vec3(0.0);
    for (uint i = 0u; i < 4u; ++i) {
      uint group = first + i;
      vec3 light = (lit >> group & 1u) != 0u ? group_light(slot, group) : vec3(0.0);
      of_group[i] += group == frame.sky_group ? max(light - direct, vec3(0.0)) : light;
    }
  }
  // Weighted mean with earlier levels, by ray counts.
  float cells = float(m * n), now = cells / (float(push.rays_before) + cells);
  vec3 before = vec3(0.0);
  uvec4 shares = uvec4(0u);
  if (push.rays_before > 0u) {
    for (uint p = k_part_direct + 1u; p < k_part_count; ++p)
      before += (1.0 - now) * texelFetch(irradiance_texels, int((record * k_part_count + p) * k_part_texels)).rgb;
    shares = texelFetch(record_group_texels, int(record * k_group_texels + first / 4u));
  }
  vec3 irradiance = now * k_pi / cells * all + before;
  for (uint i = 0u; i < 4u; ++i) {
    vec3 light = now * k_pi / cells * of_group[i] + share_unpack(shares[i]) * before;
    shares[i] = share_pack(mix(vec3(0.0), light / irradiance, greaterThan(irradiance, vec3(0.0))));
  }
  record_groups[record * k_group_texels + first / 4u] = shares;
}
