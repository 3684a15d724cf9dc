// Irradiance of the surface cell on which a vertex lies (solvers/photons/irradiance_cells.h). Even and odd samples read two
// maps made of different photons, so the difference of the picture's halves includes the noise of the maps.
#ifndef LUCERNA_PHOTONS_IRRADIANCE
#define LUCERNA_PHOTONS_IRRADIANCE
#include "transport/vertex_hook.glsl"
#include "photons/photon.glsl"
#include "shaders/shared/photons/irradiance.h"

layout(scalar) readonly buffer IrradianceBlock { IrradianceFrame irradiance; };
uniform usamplerBuffer irradiance_roots;  // nodes of a triangle: front and back in the first map, front and back in the second
uniform samplerBuffer irradiance_nodes;
#if LUCERNA_GROUP_SUMS
const uint k_irradiance_texels = 1u + k_group_count;
#else
const uint k_irradiance_texels = 1u;
#endif

bool reads_irradiance(uint state) { return (irradiance.states[state >> 5] >> (state & 31u) & 1u) != 0u; }

// Adds the tertiary light of the diffuse lobe; true if the cell has data. Light transmitted through the surface has no data.
bool irradiance_read(VertexIn v, inout VertexOut o) {
  if (irradiance.triangles == 0u || max3(v.bsdf.transmitted) > 0.0) return false;
  if (v.depth != k_irradiance_events && frame.max_depth < k_deep_paths) return false;
  uvec4 roots = texelFetch(irradiance_roots, int(v.hit.prim));
  uint side = dot(v.side, v.surface.normal_g) > 0.0 ? 0u : 1u, node = roots[2u * (v.path.sample_index & 1u) + side];
  uint packed = barycentric_pack(v.hit);
  uvec2 at = uvec2(packed & 0xffffu, packed >> 16);
  vec4 found = texelFetch(irradiance_nodes, int(k_irradiance_texels * node));
  uint link = floatBitsToUint(found.w);
  for (uint depth = 0u; depth < k_irradiance_depth && link >= k_irradiance_first; ++depth) {
    uvec3 quarter = irradiance_quarter(at);
    at = quarter.xy;
    node = link + quarter.z;
    found = texelFetch(irradiance_nodes, int(k_irradiance_texels * node));
    link = floatBitsToUint(found.w);
  }
  if (link != k_irradiance_known) return false;
  vec3 weight = v.path.throughput * v.bsdf.diffuse_albedo * k_inv_pi;
#if LUCERNA_PATH_EVENTS
  o.reader[k_irradiance_component] = k_path_photons;
#endif
  o.radiance[lane_of(0u, k_irradiance_component)] += weight * found.rgb;
#if LUCERNA_GROUP_SUMS
  for (uint g = 0u; g < k_group_count; ++g)
    o.by_group[g] += weight * texelFetch(irradiance_nodes, int(k_irradiance_texels * node + 1u + g)).rgb;
#endif
  return true;
}
#endif
