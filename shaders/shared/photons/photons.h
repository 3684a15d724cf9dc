// Photons and their lookup structure. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_PHOTONS_H
#define LUCERNA_SHARED_PHOTONS_H
#include "shaders/shared/facet.h"
#include "shaders/shared/transport.h"
LUCERNA_SHARED_BEGIN

/// Flux arriving at a surface with a diffuse lobe. Two texels.
struct Photon {
  vec3 position;   ///< world space [m]
  uint direction;  ///< direction towards its origin, unit: octahedral, 16 + 16 bits
  vec3 flux;       ///< its share of the round's light [W]
  uint bits;       ///< 0-21 geometric normal of the surface's front (facet.h), k_photon_*
};
LUCERNA_CONST uint k_photon_texels = 2u;
LUCERNA_CONST uint k_photon_facet = 0x3fffffu;
LUCERNA_CONST uint k_photon_part_shift = 22u;    ///< 2 bits: part, by its events (paths::k_part_count)
LUCERNA_CONST uint k_photon_events_shift = 24u;  ///< 3 bits: scattering events since its light, 7 and more are 7
LUCERNA_CONST uint k_photon_most_events = 7u;
/// Light that no eye path finds: of a point, spot or directional light, with a specular first event.
LUCERNA_CONST uint k_photon_unreachable = 1u << 27;
LUCERNA_CONST uint k_photon_group_shift = 28u;   ///< 4 bits: group of its light if groups are separate, else the lowest
                                                 ///< bits of its light's number

// Photons are found by cells. The radius of a photon's disc is a function of its position, independent of other photons. The
// levels of cells are each sqrt(2) times as wide as the one before; a photon lies in the level whose cells are just wider than
// its disc, so the eight cells around a point contain all photons that reach it. Cells share entries of a hash table, but never
// two of the eight, nor two of adjacent levels: a lookup visits a photon at most once, and photons of colliding cells are too
// far away. Lower bits of an entry's number: 0-2 position of the cell among the eight, 3-4 lowest bits of its level; above them
// the hash of the rest.
LUCERNA_CONST uint k_photon_near_cells = 8u;
LUCERNA_CONST uint k_photon_entry_bits = 5u;
LUCERNA_CONST float k_photon_slack = 1.0002f;     ///< factor by which cells are wider than necessary, against rounding
LUCERNA_CONST float k_photon_most_slope = 0.25f;  ///< maximum radius over the distance from the eye
/// Minimum radius over the largest coordinate of the position: 64 units in its last place, so that rounding of positions and
/// cells is invisible.
LUCERNA_CONST float k_photon_least_radius = 1.0f / 131072.0f;
/// Approximate maximum of candidates that a lookup evaluates, selected at random, each weighted for several. (lavapipe ends the
/// loops of eight neighbouring invocations after 65535 iterations in total.)
LUCERNA_CONST uint k_photon_most_candidates = 4096u;
/// ... if many lookups are averaged: those of records' rays and of gathering paths.
LUCERNA_CONST uint k_photon_standing_candidates = 384u;
LUCERNA_CONST float k_photon_slab = 0.25f;  ///< half the thickness of a photon's disc, in radii
LUCERNA_CONST float k_photon_normals = 0.9f;  ///< minimum cosine between the normals of photon and point
// Surface area around a point (photons/area.glsl).
LUCERNA_CONST uint k_photon_most_visits = 2048u;        ///< maximum visited nodes of a lookup; beyond, the area counts as full
LUCERNA_CONST float k_photon_least_area = 1.0f / 64.0f; ///< minimum area over that of the full disc
LUCERNA_CONST float k_photon_turned_slab = 0.125f;      ///< share of the slab for triangles with the opposite orientation

/// Parameters of lookups.
struct PhotonFrame {
  vec3 eye;         ///< origin of the distances that determine radii [m]
  float slope;      ///< radius over the distance from the eye
  float base;       ///< constant part of the radius, for orthographic cameras [m]
  float most;       ///< maximum radius [m]; 0: before the first pass
  uint count;       ///< number of photons
  uint mask;        ///< entries of the table minus 1
  uint round;
  uint most_candidates;  ///< approximate maximum of evaluated candidates
  uint most_visits;      ///< maximum visited nodes of the index of surfaces
  uint surface_nodes;    ///< nodes of the index of surfaces; 0: borders are not corrected
  uint importance_mask;  ///< entries of the table of importance minus 1; 0: lookups note none
  // Parameters of radii of the noted importance, and its use for storing photons.
  vec3 importance_eye;
  float importance_slope, importance_base;
  uint importance_counts;  ///< 0: all photons are stored
  uint lookups;            ///< entries of PhotonLookups, one a pixel, for lookups of caustics; 0: not noted
  uint vertices;           ///< further entries per pixel: vertices after the first diffuse one
  uint stores_radiance;     ///< 1: photons store the radiance that eye paths would carry (PhotonRadiances)
  uint stores_surface;      ///< 1: photons store their triangle and position (PhotonSurfaces)
  uint unreachable_parts;  ///< bit p: of part p only photons with k_photon_unreachable are stored; k_photon_ends_reachable
  uint skips_unreachable;  ///< 1: photons with k_photon_unreachable are not stored
  /// By state of the eye path. Bits 4p to 4p+3: the component to which part p contributes. Bit 16+p: of part p only photons
  /// with k_photon_unreachable count, because paths from the eye compute the rest of it.
  uint component[k_automaton_states];
};
LUCERNA_CONST uint k_photon_unreachable_only_shift = 16u;
LUCERNA_CONST uint k_photon_ends_reachable = 1u << 31;  ///< only these are stored: other paths end
LUCERNA_CONST uint k_photon_no_components = 0xffffu;  ///< no component, in the lower bits of PhotonFrame::component
LUCERNA_CONST uint k_photon_no_component = 15u;

/// Radius at x, `wanted` limited to `most` and to the precision of float coordinates [m].
LUCERNA_INLINE float photon_radius_of(float wanted, float most, vec3 x) {
  vec3 a = abs(x);
  float coordinate = a.x > a.y ? a.x : a.y;
  coordinate = a.z > coordinate ? a.z : coordinate;
  float least = k_photon_least_radius * coordinate + 1e-20f, radius = wanted < most ? wanted : most;
  return radius > least ? radius : least;
}
LUCERNA_CONST uint k_photon_caustic_part = 3u;  ///< paths::k_caustic_part

struct PhotonContributionPush {
  uint count;      ///< photons
  uint step;
  uint first;      ///< number of the first one in the map
};
struct PhotonListPush {
  uint count;      ///< photons
};
/// Number of a photon in its round, independent of the order of storage: of its path, then of its events.
LUCERNA_CONST uint k_photon_id_events = 8u;          ///< number of bits, for k_most_light_events

// Importance: positions of lookups of eye paths, weighted by their contribution to the picture. A table of sums by cell, with
// cells as for photons.
LUCERNA_CONST uint k_photon_importance_entries = 1u << 18;
LUCERNA_CONST float k_photon_importance_scale = 256.0f;  ///< importance of a path with throughput 1
LUCERNA_CONST uint k_photon_most_importance = 4096u;     ///< maximum of one lookup
/// Share of photons stored where no lookup has been noted, with a larger weight: gaps in the table cause noise, but no bias.
LUCERNA_CONST float k_photon_unseen_share = 0.25f;

/// Contribution of a pilot's photon to the picture, and its origin.
struct PhotonContribution {
  uint stratum;      ///< stratum of its path's emission
  uint light;        ///< entry of emission_alias of its path
  uint id;           ///< k_photon_id_events
  float contribution;       ///< to the picture, up to a common factor; 0: direct light of other solvers
  vec3 position;     ///< [m]
  float importance;  ///< importance of the lookups around it, an area, up to a common factor
  // For caustics, if radiance is stored:
  float flux;        ///< luminance; 0: no caustic
  float radiance;    ///< radiance that an eye path would carry which hits the same light by the same events
  uint facet;        ///< side of the surface on which it arrives
  uint unreachable;  ///< 1: k_photon_unreachable
};
/// Caustics lookup of a pilot's eye path.
struct PhotonLookup {
  vec3 position;     ///< [m]
  float carried;     ///< luminance of its throughput times the diffuse albedo; 0: no lookup
  uint facet;        ///< visible side of the surface
};
/// Position of a photon on its triangle.
struct PhotonSurface {
  uint side;         ///< triangle << 1, plus 1 if it arrives at the back
  uint barycentric;  ///< Hit::u and v, 16 bits each
};
LUCERNA_CONST float k_radiance_unmet = 1e30f;  ///< radiance that no eye path finds

// PhotonCounts, uint each.
LUCERNA_CONST uint k_photons_stored = 0u;    ///< number so far, including those without room
LUCERNA_CONST uint k_photons_capacity = 1u;  ///< maximum number
LUCERNA_CONST uint k_photons_spared = 2u;    ///< photons not stored because no lookup is near
LUCERNA_CONST uint k_photons_by_part = 3u;   ///< [4]: stored photons by part
LUCERNA_CONST uint k_photon_counts = 7u;

/// Selection and display of drawn photons.
struct PhotonPointsPush {
  uint count;       ///< photons
  uint step;        ///< one of `step` photons is drawn
  uint by;          ///< k_photons_by_*
  uint round;
};
LUCERNA_CONST uint k_photons_by_flux = 1u;
LUCERNA_CONST uint k_photons_by_bounce = 2u;
LUCERNA_CONST uint k_photons_by_map = 3u;    ///< part that uses it
LUCERNA_CONST uint k_photons_by_light = 4u;
LUCERNA_CONST uint k_photons_by_round = 5u;

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::Photon) == 32);
#endif
#endif
