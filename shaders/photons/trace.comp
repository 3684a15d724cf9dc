// One vertex of every live light path: stores a photon if an eye path can read it, then continues the path.
#include "shaders/shared/photons/photons.h"
#include "transport/light_vertex.glsl"
#include "lib/emission.glsl"
#include "photons/importance.glsl"

layout(scalar) writeonly buffer PhotonList { Photon photon_list[]; };  // in order of arrival ...
layout(scalar) writeonly buffer PhotonIds { uint photon_ids[]; };      // ... and the keys of their final order
layout(scalar) writeonly buffer PhotonRadiances { float photon_radiances[]; };
layout(scalar) writeonly buffer PhotonSurfaces { PhotonSurface photon_surfaces[]; };
layout(scalar) buffer PhotonCounts { uint photon_counts[]; };
layout(scalar) buffer LightPathCounts { uint light_path_counts[]; };

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = push.use_queue != 0u ? queue[index] : index;
  Ray ray = load_ray(slot);
  Hit hit = load_hit(slot);
  PathState path = load_path(slot);
  if (path.pixel == 0xffffffffu) return;
  if (hit.prim == k_no_hit) {
    atomicAdd(light_path_counts[k_light_paths_escaped], 1u);
    return;
  }
  uint state = path_automaton(path), depth = path_depth(path);
  Sampler random = make_light_sampler(path.pixel, path.sample_index, frame.seed);
  LightVertex v = light_vertex(path, ray, hit, random);
  uint part = automaton_component(state);
  bool unreachable = path.pdf == 0.0 && depth > 1u;
  // Events of the whole path as seen from the eye, including this surface's.
  bool wanted = depth <= frame.max_depth && v.lit && is_component(part) && max3(v.bsdf.diffuse_albedo + v.bsdf.transmitted_albedo) > 0.0;
  if (wanted && !is_finite(v.arriving)) {
    atomicAdd(counters[k_counter_dropped], 1u);
    wanted = false;
  }
  if (wanted && (unreachable ? photons.skips_unreachable != 0u : (photons.unreachable_parts >> part & 1u) != 0u)) wanted = false;
  // Importons (I. Peter and G. Pietrek, "Importance Driven Construction of Photon Maps", 1998), as Russian roulette.
  float share = 1.0;
  if (wanted && photons.importance_counts != 0u && importance_around(v.surface.position) == 0u) share = k_photon_unseen_share;
  if (wanted && sample_vertex(random, depth, k_pad_light_uv).x >= share) {
    atomicAdd(photon_counts[k_photons_spared], 1u);
    wanted = false;
  }
  if (wanted) {
    Photon p;
    p.position = v.surface.position;
    p.direction = photon_pack_direction(-ray.direction);
    p.flux = v.arriving / share;
    p.bits = facet_pack(v.surface.normal_g) | part << k_photon_part_shift |
             min(depth - 1u, k_photon_most_events) << k_photon_events_shift | path.light_group << k_photon_group_shift |
             (unreachable ? k_photon_unreachable : 0u);
    uint at = atomicAdd(photon_counts[k_photons_stored], 1u);
    atomicAdd(photon_counts[k_photons_by_part + part], 1u);
    if (at < photon_counts[k_photons_capacity]) {
      photon_list[at] = p;
      photon_ids[at] = path.pixel << k_photon_id_events | (depth & k_most_light_events);
      if (photons.stores_radiance != 0u)
        photon_radiances[at] = min(luminance(v.arriving) / max(path.pdf, 1e-37), k_radiance_unmet);
      if (photons.stores_surface != 0u)
        photon_surfaces[at] = PhotonSurface(hit.prim << 1 | (dot(ray.direction, v.surface.normal_g) > 0.0 ? 1u : 0u), barycentric_pack(hit));
    }
  }
  if ((photons.unreachable_parts & k_photon_ends_reachable) != 0u && path.pdf > 0.0) return;
  light_continue(slot, v, path, ray, path.travelled + hit.t, min(frame.max_depth, k_most_light_events) - 1u, random);
}
