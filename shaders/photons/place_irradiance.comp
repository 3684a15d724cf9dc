// Irradiance at places where photons lie, by part: a density estimate over the photons around, as lookups make it
// (photons/vertex_hook.glsl), of those that are no places. A place's own photon would bring too much, and the gap around a lookup,
// in which there is no nearer one, too little; of the others places know nothing.
#include "lib/variants.glsl"
#include "photons/photon.glsl"
#include "photons/lookup.glsl"
#include "photons/area.glsl"
#include "lib/invocation.glsl"
#if LUCERNA_GROUP_SUMS
#include "lib/group_shares.glsl"
layout(scalar) writeonly buffer PlaceGroups { uvec4 place_groups[]; };
#endif

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonListPush push; };  // places
uniform samplerBuffer place_texels;                                   // Photon each
layout(scalar) writeonly buffer PlaceIrradiance { vec4 place_irradiance[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  vec4 own = texelFetch(place_texels, int(k_photon_texels * i));
  vec3 x = own.xyz, normal = facet_unpack(floatBitsToUint(texelFetch(place_texels, int(k_photon_texels * i + 1u)).w) & k_photon_facet);
  vec3 seen = dot(photon_direction(floatBitsToUint(own.w)), normal) > 0.0 ? normal : -normal;
  float radius = photon_radius(x);
  int lowest = photon_lowest_level(radius), highest = photon_highest_level(radius);
  uint candidates = 0u;
  for (int level = lowest; level <= highest; ++level) {
    ivec3 cell = ivec3(floor(x * photon_inverse_cell(level) - 0.5));
    for (uint k = 0u; k < k_photon_near_cells; ++k) {
      uvec2 range = photon_range(photon_entry(cell + (ivec3(k) >> ivec3(0, 1, 2) & 1), level));
      candidates += range.y - range.x;
    }
  }
  uint step = max((candidates + k_photon_most_candidates - 1u) / k_photon_most_candidates, 1u), skip = hash_combine(i, photons.round) % step;
  vec3 found[3] = vec3[](vec3(0.0), vec3(0.0), vec3(0.0));
#if LUCERNA_GROUP_SUMS
  vec3 by_group[k_group_count];
  for (uint g = 0u; g < k_group_count; ++g) by_group[g] = vec3(0.0);
#endif
  for (int level = lowest; level <= highest; ++level) {
    ivec3 cell = ivec3(floor(x * photon_inverse_cell(level) - 0.5));
    for (uint k = 0u; k < k_photon_near_cells; ++k) {
      uvec2 range = photon_range(photon_entry(cell + (ivec3(k) >> ivec3(0, 1, 2) & 1), level));
      uint at = range.x + skip;
      for (; at < range.y; at += step) {
        vec4 a = texelFetch(photon_texels, int(k_photon_texels * at));
        vec3 away = a.xyz - x;
        float r = photon_radius(a.xyz), d2 = dot(away, away);
        if (d2 >= r * r || photon_of_place(at / k_photon_place_step) == at) continue;
        vec4 b = texelFetch(photon_texels, int(k_photon_texels * at + 1u));
        uint bits = floatBitsToUint(b.w), part = bits >> k_photon_part_shift & 3u;
        vec3 front = facet_unpack(bits & k_photon_facet), side = dot(photon_direction(floatBitsToUint(a.w)), front) > 0.0 ? front : -front;
        bool counts = part > 0u && dot(side, seen) > k_photon_normals && abs(dot(away, normal)) < k_photon_slab * r;
        vec3 light = counts ? photon_kernel(d2, r) * b.rgb : vec3(0.0);
        for (uint p = 0u; p < 3u; ++p) found[p] += part == p + 1u ? light : vec3(0.0);
#if LUCERNA_GROUP_SUMS
        for (uint g = 0u; g < k_group_count; ++g) by_group[g] += g == bits >> k_photon_group_shift ? light : vec3(0.0);
#endif
      }
      skip = at >= range.y ? at - range.y : skip;
    }
  }
  const float k_others = float(k_photon_place_step) / float(k_photon_place_step - 1u);
  float weight = k_others * float(step) / photon_area(x, normal, radius);
  place_irradiance[k_photon_place_texels * i] = vec4(x, uintBitsToFloat(facet_pack(seen)));
  for (uint p = 0u; p < 3u; ++p) place_irradiance[k_photon_place_texels * i + 1u + p] = vec4(weight * found[p], 0.0);
#if LUCERNA_GROUP_SUMS
  vec3 all = found[0] + found[1] + found[2];
  for (uint t = 0u; t < k_group_texels; ++t) {
    uvec4 shares = uvec4(0u);
    for (uint k = 0u; k < 4u && 4u * t + k < k_group_count; ++k)
      shares[k] = share_pack(mix(vec3(0.0), by_group[4u * t + k] / all, greaterThan(all, vec3(0.0))));
    place_groups[k_group_texels * i + t] = shares;
  }
#endif
}
