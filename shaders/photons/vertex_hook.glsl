// Photon density estimation at vertices of eye paths (H. W. Jensen 1996): discs of given radius, Epanechnikov's kernel,
// diffuse lobe only; the path traces the light of the other lobes.
//
// Bias of curved light: with E(x + d) = E + d.grad E + d.H d / 2 + ..., a kernel of second moment m = integral K d^2 adds m
// tr H / 4; m = r^2 / 3 for Epanechnikov's kernel, r^2 / 2 for the constant one. So twice the difference of the two
// estimates is the bias of Epanechnikov's. Among all functions of the disc's photons that estimate tr H it has the least
// variance: that of the estimate itself.
#ifndef LUCERNA_PHOTONS_VERTEX_HOOK
#define LUCERNA_PHOTONS_VERTEX_HOOK
#ifndef LUCERNA_PHOTON_DIRECT
#define LUCERNA_PHOTON_DIRECT 0  // 1: photons provide direct light, too
#endif
#include "transport/vertex_hook.glsl"
#include "photons/photon.glsl"
#include "photons/lookup.glsl"
#include "photons/area.glsl"
#include "shaders/shared/film.h"
#if LUCERNA_PHOTON_IRRADIANCE
#include "photons/irradiance.glsl"
#endif

layout(scalar) buffer PhotonImportance { uint photon_importance[]; };
layout(scalar) writeonly buffer PhotonLookups { PhotonLookup photon_lookups[]; };

struct photons_Vertex {
  uint phase;  // in which the path continues behind the diffuse lobe; k_phase_start: unchanged
};

// Not 0: pilot paths. Recorded paths are the picture's, whatever is being prepared.
uint photons_pilot_mask() { return LUCERNA_PATH_EVENTS != 0 ? 0u : photons.importance_mask; }

// Rotates w by the smallest rotation that maps unit vector a to b.
vec3 turn_along(vec3 w, vec3 a, vec3 b) {
  vec3 both = a + b;
  return w - both * (dot(both, w) / (1.0 + dot(a, b))) + b * (2.0 * dot(a, w));
}

// True if the disc around a point of a triangle lies within the triangle. Its area is then 1, whatever is near: other
// surfaces could only add to it (photon_areas() ends at 1). Most discs do, and the search for surfaces takes far longer.
bool disc_within_triangle(uint triangle, vec3 x, float radius) {
  uvec4 tri = floatBitsToUint(texelFetch(scene_triangles, int(triangle)));
  vec3 a = texelFetch(scene_vertices, int(2u * tri.x)).xyz - x, b = texelFetch(scene_vertices, int(2u * tri.y)).xyz - x,
       c = texelFetch(scene_vertices, int(2u * tri.z)).xyz - x;
  vec3 ab = b - a, bc = c - b, ca = a - c, to_ab = cross(ab, a), to_bc = cross(bc, b), to_ca = cross(ca, c);
  float r2 = radius * radius;
  return dot(to_ab, to_ab) >= r2 * dot(ab, ab) && dot(to_bc, to_bc) >= r2 * dot(bc, bc) && dot(to_ca, to_ca) >= r2 * dot(ca, ca);
}

photons_Vertex photons_read(VertexIn v, inout VertexOut o) {
  photons_Vertex vertex = photons_Vertex(k_phase_start);
  // Learned light sampling must not depend on which solver computes a component.
  uint word = v.again || frame.learning != 0u ? k_photon_no_components : photons.component[v.state];
  uint components = word & k_photon_no_components, only = word >> k_photon_unreachable_only_shift;  // bits, by part
  // Pilot paths record lookups and read no photons. Where only light is read that eye paths cannot find, the eye path
  // continues unchanged.
  bool reads = components != k_photon_no_components && only == 0u && photons_pilot_mask() == 0u;
  // Eye paths stop computing a component behind a lookup of it; before there is data they compute all.
  bool some = photons.count > 0u;
#if LUCERNA_PHOTON_IRRADIANCE
  some = some || irradiance.triangles > 0u;
#endif
  if (reads && some && phase_of(v.state) != k_phase_start) vertex.phase = k_phase_known;
#if LUCERNA_PHOTON_IRRADIANCE
  if (reads && reads_irradiance(v.state)) {
    bool known = irradiance_read(v, o);
    if (!known) vertex.phase = k_phase_fallback;
    // In a cell without data the path computes all light except the light that no eye path finds.
    if (known || irradiance.gathers == 0u) components = k_photon_no_components;
    only = 0xfu;  // all parts
  }
#endif
  vec3 x = v.surface.position;
  float radius = photon_radius(x);
  bool looks = components != k_photon_no_components && photons.count > 0u && max3(v.bsdf.diffuse + v.bsdf.transmitted) > 0.0;
  if (photons_pilot_mask() != 0u && components != k_photon_no_components) {
    float carried = luminance(v.path.throughput * (v.bsdf.diffuse + v.bsdf.transmitted));
    int level = photon_level(importance_radius(x));
    if (carried > 0.0)
      atomicAdd(photon_importance[photon_entry_of(ivec3(floor(x * photon_inverse_cell(level))), level, photons_pilot_mask())],
                uint(clamp(k_photon_importance_scale * carried, 1.0, float(k_photon_most_importance))));
    if (v.path.pixel < photons.lookups && is_component(components >> 4u * k_photon_caustic_part & 15u))
      photon_lookups[v.path.pixel] =
          PhotonLookup(x, luminance(v.path.throughput * v.bsdf.diffuse_albedo), facet_pack(v.side));
  }
  // Targets of useful light: diffuse vertices of the pilot's paths behind the first.
  if (photons_pilot_mask() != 0u && v.depth > 0u && v.depth <= photons.vertices && v.path.pixel < photons.lookups && !automaton_no_diffuse(v.state))
    photon_lookups[photons.lookups + v.path.pixel * photons.vertices + v.depth - 1u] =
        PhotonLookup(x, luminance(v.path.throughput * v.bsdf.diffuse_albedo), facet_pack(v.side));
  int lowest = photon_lowest_level(radius), highest = photon_highest_level(radius);
  uint candidates = looks ? photon_candidates(x, lowest, highest) : 0u;
  // If very many photons are near, every n-th is taken, from a random start.
  uint step = (candidates + photons.most_candidates - 1u) / max(photons.most_candidates, 1u);
  step = max(step, 1u);
  uint skip = step > 1u ? hash_combine(hash_combine(v.path.pixel, v.path.sample_index), v.depth) % step : 0u;
  vec3 found_0 = vec3(0.0), found_1 = vec3(0.0), found_2 = vec3(0.0), found_3 = vec3(0.0);  // by part
#if LUCERNA_GROUP_SUMS
  vec3 by_group[k_group_count];  // of all read light, by light group
  [[unroll]] for (uint g = 0u; g < k_group_count; ++g) by_group[g] = vec3(0.0);
#endif
  uint own_facet = facet_pack(v.surface.normal_g);
  vec3 found_flat = vec3(0.0);  // of all read parts, by the constant kernel
  for (int level = lowest; looks && level <= highest; ++level) {
    ivec3 cell = ivec3(floor(x * photon_inverse_cell(level) - 0.5));
    for (uint k = 0u; k < k_photon_near_cells; ++k) {
      uvec2 range = photon_range(photon_entry(cell + (ivec3(k) >> ivec3(0, 1, 2) & 1), level));
      uint at = range.x + skip;
      for (; at < range.y; at += step) {
        vec4 a = texelFetch(photon_texels, int(k_photon_texels * at));
        vec3 away = a.xyz - x;
        float r = photon_radius(a.xyz), d2 = dot(away, away);
        if (d2 >= r * r) continue;
        vec4 b = texelFetch(photon_texels, int(k_photon_texels * at + 1u));
        uint bits = floatBitsToUint(b.w), part = bits >> k_photon_part_shift & 3u;
        vec3 wi = photon_direction(floatBitsToUint(a.w));
        // Normal of the photon's facet; the vertex's own normal if both are equal within 22 bits.
        vec3 front = (bits & k_photon_facet) == own_facet ? v.surface.normal_g : facet_unpack(bits & k_photon_facet);
        // The photon arrives on the side that the path sees, or on the back of the same surface, transmitted.
        vec3 side = dot(wi, front) > 0.0 ? front : -front;
        bool reflected = dot(side, v.side) > 0.0;
        float agree = reflected ? dot(side, v.side) : dot(front, v.surface.normal_g);
        bool wanted = (only >> part & 1u) == 0u || (bits & k_photon_unreachable) != 0u;
        // Events of the whole path: the eye path's, this one, and the photon's.
        wanted = wanted && v.depth + 1u + (bits >> k_photon_events_shift & k_photon_most_events) <= frame.max_depth;
        if (!wanted || agree <= k_photon_normals || abs(dot(away, v.surface.normal_g)) >= k_photon_slab * r) continue;
        // The facet is rotated into this plane, so flux is divided by the cosine at the photon's own facet.
        wi = reflected ? turn_along(wi, side, v.side) : turn_along(wi, front, v.surface.normal_g);
        vec3 flux = diffuse_of_flux(v.bsdf, v.to_world, v.surface.normal_g, wi, reflected) * b.rgb;
#if LUCERNA_PARALLAX
        if (hidden_by_relief(v.surface, wi)) flux = vec3(0.0);
#endif
        vec3 light = flux * photon_kernel(d2, r);
#if LUCERNA_PATH_EVENTS
        uint to = components >> 4u * part & 15u;
        if (is_component(to)) ++o.served[to], o.reader[to] = k_path_photons;
#endif
        bool contributes = (LUCERNA_PHOTON_DIRECT != 0 || part > 0u) && is_component(components >> 4u * part & 15u);
        found_flat += contributes ? flux * photon_flat_kernel(r) : vec3(0.0);
#if LUCERNA_PHOTON_DIRECT
        found_0 += part == 0u ? light : vec3(0.0);
#endif
        found_1 += part == 1u ? light : vec3(0.0);
        found_2 += part == 2u ? light : vec3(0.0);
        found_3 += part == 3u ? light : vec3(0.0);
#if LUCERNA_GROUP_SUMS
        uint group = contributes ? bits >> k_photon_group_shift : k_group_count;
        [[unroll]] for (uint g = 0u; g < k_group_count; ++g) by_group[g] += group == g ? light : vec3(0.0);
#endif
      }
      skip = at >= range.y ? at - range.y : skip;
    }
  }
  vec3 weight = v.path.throughput * float(step);
  vec2 areas = vec2(1.0);
  // If deep light is looked up and no photon is found, its relative error is unknown.
  bool deep = (is_component(components >> 4 & 15u) && (only >> 1 & 1u) == 0u) ||
              (is_component(components >> 8 & 15u) && (only >> 2 & 1u) == 0u);
  if (deep && photons_pilot_mask() == 0u && max3(v.bsdf.diffuse + v.bsdf.transmitted) > 0.0 && max3(found_1 + found_2 + found_3) <= 0.0)
    o.bias += k_found_nothing;
  // Only if there is an error to correct.
  if (max3(found_0 + found_1 + found_2 + found_3) > 0.0 && !disc_within_triangle(v.hit.prim, x, radius))
    areas = photon_areas(x, v.surface.normal_g, radius);
  o.bias += 2.0 * luminance(weight * found_flat) / areas.y;
  weight /= areas.x;
  for (uint component = 0u; component < k_component_count; ++component) {
    vec3 light = ((components & 15u) == component ? found_0 : vec3(0.0)) +
                 ((components >> 4 & 15u) == component ? found_1 : vec3(0.0)) +
                 ((components >> 8 & 15u) == component ? found_2 : vec3(0.0)) +
                 ((components >> 12 & 15u) == component ? found_3 : vec3(0.0));
    o.radiance[lane_of(0u, component)] += weight * light;
    o.bias -= 2.0 * luminance(weight * light);
  }
#if LUCERNA_GROUP_SUMS
  [[unroll]] for (uint g = 0u; g < k_group_count; ++g) o.by_group[g] += weight * by_group[g];
#endif
  return vertex;
}
#define photons_HAS_STATE
uint photons_state(VertexIn v, photons_Vertex x, BsdfSample b, uint state) {
  return x.phase != k_phase_start && b.event == k_event_diffuse ? in_phase(state, x.phase) : state;
}
#endif
