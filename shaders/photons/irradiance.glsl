// Irradiance at places where photons lie, and the one that is nearest to a vertex (P. H. Christensen, "Faster Photon Map Global
// Illumination", Journal of Graphics Tools 4:3, 1999).
#ifndef LUCERNA_PHOTONS_IRRADIANCE
#define LUCERNA_PHOTONS_IRRADIANCE
#include "transport/vertex_hook.glsl"
#include "photons/photon.glsl"
#if LUCERNA_GROUP_SUMS
#include "lib/group_shares.glsl"
uniform usamplerBuffer irradiance_group_texels;  // of a place: shares in the light of all parts
#endif

layout(scalar) readonly buffer IrradianceBlock { PhotonFrame irradiance; };  // places lie in cells as photons of its radius do
uniform samplerBuffer place_irradiance_texels;                               // k_photon_place_texels a place
uniform usamplerBuffer place_table;                                          // two entries a texel

uvec2 place_range(ivec3 cell, int level) {
  uint entry = photon_entry_of(cell, level, irradiance.mask);
  uvec4 two = texelFetch(place_table, int(entry >> 1));
  return (entry & 1u) != 0u ? two.zw : two.xy;
}

// Brings what is known at the nearest place on the side that the path sees; false where there is none near enough, or light
// comes through the surface as well.
bool irradiance_read(VertexIn v, inout VertexOut o) {
  uint components = irradiance.component[v.state];
  if (components == 0xffffu || irradiance.count == 0u || max3(v.bsdf.transmitted) > 0.0 || max3(v.bsdf.diffuse) <= 0.0) return false;
  vec3 x = v.surface.position;
  float radius = irradiance.base, nearest2 = radius * radius;
  int level = photon_level(radius);
  ivec3 cell = ivec3(floor(x * photon_inverse_cell(level) - 0.5));
  uint nearest = 0xffffffffu, candidates = 0u;
  for (uint k = 0u; k < k_photon_near_cells; ++k) {
    uvec2 range = place_range(cell + (ivec3(k) >> ivec3(0, 1, 2) & 1), level);
    candidates += range.y - range.x;
  }
  // Where very many lie together the nearest of every so-manyth is near enough.
  uint step = (candidates + irradiance.most_candidates - 1u) / max(irradiance.most_candidates, 1u);
  step = max(step, 1u);
  uint skip = step > 1u ? hash_combine(hash_combine(v.path.pixel, v.path.sample_index), v.depth) % step : 0u;
  for (uint k = 0u; k < k_photon_near_cells; ++k) {
    uvec2 range = place_range(cell + (ivec3(k) >> ivec3(0, 1, 2) & 1), level);
    uint at = range.x + skip;
    for (; at < range.y; at += step) {
      vec4 place = texelFetch(place_irradiance_texels, int(k_photon_place_texels * at));
      vec3 away = place.xyz - x;
      float d2 = dot(away, away);
      bool counts = d2 < nearest2 && dot(facet_unpack(floatBitsToUint(place.w)), v.side) > k_photon_normals &&
                    abs(dot(away, v.surface.normal_g)) < k_photon_slab * radius;
      nearest = counts ? at : nearest;
      nearest2 = counts ? d2 : nearest2;
    }
    skip = at >= range.y ? at - range.y : skip;
  }
  if (nearest == 0xffffffffu) return false;
  vec3 weight = v.path.throughput * v.bsdf.diffuse_albedo * k_inv_pi, all = vec3(0.0);
  for (uint part = 1u; part < 4u; ++part) {
    uint component = components >> 4u * part & 15u;
    if (component >= k_component_count) continue;
    vec3 light = weight * texelFetch(place_irradiance_texels, int(k_photon_place_texels * nearest + part)).rgb;
    o.radiance[lane_of(0u, component)] += light;
    all += light;
  }
#if LUCERNA_GROUP_SUMS
  for (uint t = 0u; t < k_group_texels; ++t) {
    uvec4 shares = texelFetch(irradiance_group_texels, int(k_group_texels * nearest + t));
    for (uint i = 0u; i < 4u && 4u * t + i < k_group_count; ++i) o.by_group[4u * t + i] += all * share_unpack(shares[i]);
  }
#endif
  return true;
}
#endif
