// Photons and how they are found. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_PHOTONS_H
#define LUCERNA_SHARED_PHOTONS_H
#include "shaders/shared/facet.h"
#include "shaders/shared/transport.h"
LUCERNA_SHARED_BEGIN

/// Flux that arrives at a surface with a diffuse lobe. Two texels.
struct Photon {
  vec3 position;   ///< world space [m]
  uint direction;  ///< whence it comes, unit: octahedral, 16 + 16 bits
  vec3 flux;       ///< its share of the round's light [W]
  uint bits;       ///< 0-21 geometric normal of the surface's front (facet.h), k_photon_*
};
LUCERNA_CONST uint k_photon_texels = 2u;
LUCERNA_CONST uint k_photon_facet = 0x3fffffu;
LUCERNA_CONST uint k_photon_part_shift = 22u;    ///< 2 bits: by which events it came (paths::k_part_count)
LUCERNA_CONST uint k_photon_events_shift = 24u;  ///< 3 bits: scattering events since its light, 7 and more are 7
LUCERNA_CONST uint k_photon_most_events = 7u;
/// Light that no path from the eye finds: of a point, a spot or a directional light, whose first event is specular.
LUCERNA_CONST uint k_photon_unreachable = 1u << 27;
LUCERNA_CONST uint k_photon_group_shift = 28u;   ///< 4 bits: the group of its light, where groups are kept apart, else of
                                                 ///< its light's number the lowest

// Photons are found by cells. The radius within which one counts is a function of the place where it lies, so that the places
// that it counts for are known without asking the others. Cells come in levels, each sqrt(2) times as wide as the one before;
// a photon lies in the level whose cells are just wider than its disc, so that the eight cells around a place hold all that
// can reach it. Cells share entries of a hash table, but never two of the eight, nor two of neighbouring levels: a photon is
// met at most once, and one that is met by chance is too far away. Lower bits of an entry's number: 0-2 where the cell lies
// among the eight, 3-4 its level's lowest bits; above them the hash of the rest.
LUCERNA_CONST uint k_photon_near_cells = 8u;
LUCERNA_CONST uint k_photon_entry_bits = 5u;
LUCERNA_CONST float k_photon_slack = 1.0002f;     ///< cells are so much wider than they must be, against rounding
LUCERNA_CONST float k_photon_most_slope = 0.25f;  ///< of the radius over the distance from the eye
/// A radius is at least so large a part of the place's largest coordinate: 64 units in its last place, so that the rounding of
/// places and of their cells does not show.
LUCERNA_CONST float k_photon_least_radius = 1.0f / 131072.0f;
/// Of candidates that a lookup meets it looks at no more than about so many, at random, each counting for several. (All loops
/// of eight neighbouring invocations together end after 65535 iterations on lavapipe.)
LUCERNA_CONST uint k_photon_most_candidates = 4096u;
/// ... where many lookups make one figure: those of records' rays, and of paths that gather.
LUCERNA_CONST uint k_photon_standing_candidates = 384u;
LUCERNA_CONST float k_photon_slab = 0.25f;  ///< half the thickness of what a photon's disc counts for, in radii
LUCERNA_CONST float k_photon_normals = 0.9f;  ///< least cosine between the normals of photon and place
// How much surface there is around a place (photons/area.glsl).
LUCERNA_CONST uint k_photon_most_visits = 2048u;        ///< nodes that a lookup meets; beyond it is taken for whole
LUCERNA_CONST float k_photon_least_area = 1.0f / 64.0f; ///< of the whole disc
LUCERNA_CONST float k_photon_turned_slab = 0.125f;      ///< of the slab, for what is wound the other way round

/// What lookups read besides the photons.
struct PhotonFrame {
  vec3 eye;         ///< from which radii are measured [m]
  float slope;      ///< radius over the distance from there
  float base;       ///< ... and beside it, where the camera is orthographic [m]
  float most;       ///< the radius is at most that [m]; 0: there has been no pass
  uint count;       ///< photons; 0: none
  uint mask;        ///< entries of the table, less 1
  uint round;
  uint most_candidates;  ///< that a lookup looks at, about
  uint most_visits;      ///< nodes of the index of surfaces that it meets
  uint surface_nodes;    ///< of the index of surfaces; 0: borders are not corrected
  uint importance_mask;  ///< entries of the table of importance, less 1; 0: lookups note none
  // By whose radii importance was noted, and whether photons are stored by it.
  vec3 importance_eye;
  float importance_slope, importance_base;
  uint importance_counts;  ///< 0: all photons are stored
  uint lookups;            ///< entries of PhotonLookups, one a pixel, in which caustics' lookups are noted; 0: none is
  uint vertices;           ///< behind those, so many a pixel: where its path goes on from the first diffuse vertex
  uint stores_radiance;     ///< 1: stored photons tell what paths from the eye would bring (PhotonRadiances)
  uint stores_surface;      ///< 1: stored photons tell where on which triangle they lie (PhotonSurfaces)
  uint unreachable_parts;  ///< bit p: of part p only photons with k_photon_unreachable are stored; k_photon_ends_reachable
  uint skips_unreachable;  ///< 1: photons with k_photon_unreachable are not stored
  /// By state of the eye path. Bits 4p to 4p+3: the component to which part p contributes. Bit 16+p: of part p only photons
  /// with k_photon_unreachable count, because paths from the eye compute the rest of it.
  uint component[k_automaton_states];
};
LUCERNA_CONST uint k_photon_unreachable_only_shift = 16u;
LUCERNA_CONST uint k_photon_ends_reachable = 1u << 31;  ///< no others are stored: paths that leave none end
LUCERNA_CONST uint k_photon_no_components = 0xffffu;  ///< of PhotonFrame::component, without the bits above
LUCERNA_CONST uint k_photon_no_component = 15u;

/// `wanted` as a place's radius: what a float can say of places there, and of how wide pixels are, are its bounds. [m]
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
  uint first;      ///< of them in the map
};
struct PhotonListPush {
  uint count;      ///< photons
};
/// Number of a photon in its round, whatever the order in which photons are stored: of its path, then of its events.
LUCERNA_CONST uint k_photon_id_events = 8u;          ///< bits, of k_most_light_events

// Importance: where lookups of eye paths take place, and how much of the picture hangs on them. A table of sums by cell, in
// which lookups lie by the rules of photons.
LUCERNA_CONST uint k_photon_importance_entries = 1u << 18;
LUCERNA_CONST float k_photon_importance_scale = 256.0f;  ///< of a path that carries everything
LUCERNA_CONST uint k_photon_most_importance = 4096u;     ///< of one lookup
/// Of photons where no lookup has been noted so many are stored, each for several: whatever the table misses costs noise,
/// never light.
LUCERNA_CONST float k_photon_unseen_share = 0.25f;

/// Of a photon of a pilot: what it brings to the picture, and where it comes from.
struct PhotonContribution {
  uint stratum;      ///< of its path's emission
  uint light;        ///< ... entry of emission_alias
  uint id;           ///< k_photon_id_events
  float contribution;       ///< what it brings to the picture, up to a factor; 0: light straight from a lamp
  vec3 position;     ///< [m]
  float importance;  ///< how much of the picture hangs on lookups around it, an area, up to a factor
  // Of caustics, where radiance is told:
  float flux;        ///< luminance; 0: no caustic
  float radiance;    ///< that arrives as a path from the eye would bring it, which meets the same light the same way
  uint facet;        ///< side of the surface on which it arrives
  uint unreachable;  ///< 1: k_photon_unreachable
};
/// Where a path of the pilot from the eye looks caustics up.
struct PhotonLookup {
  vec3 position;     ///< [m]
  float carried;     ///< luminance of its throughput times the diffuse albedo; 0: there is none
  uint facet;        ///< side of the surface that it sees
};
/// Where a photon lies.
struct PhotonSurface {
  uint side;         ///< triangle << 1, and 1 where it arrives at the back
  uint barycentric;  ///< Hit::u and v, 16 bits each
};
LUCERNA_CONST float k_radiance_unmet = 1e30f;  ///< that no path from the eye could meet

// PhotonCounts, uint each.
LUCERNA_CONST uint k_photons_stored = 0u;    ///< so far, or wanted to be
LUCERNA_CONST uint k_photons_capacity = 1u;  ///< for which there is room
LUCERNA_CONST uint k_photons_spared = 2u;    ///< photons left out because nobody looks where they lie
LUCERNA_CONST uint k_photons_by_part = 3u;   ///< [4]: of those that are stored
LUCERNA_CONST uint k_photon_counts = 7u;

/// Which photons are drawn, and how.
struct PhotonPointsPush {
  uint count;       ///< photons
  uint step;        ///< every so-manyth is drawn
  uint by;          ///< k_photons_by_*
  uint round;
};
LUCERNA_CONST uint k_photons_by_flux = 1u;
LUCERNA_CONST uint k_photons_by_bounce = 2u;
LUCERNA_CONST uint k_photons_by_map = 3u;    ///< by part
LUCERNA_CONST uint k_photons_by_light = 4u;
LUCERNA_CONST uint k_photons_by_round = 5u;

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::Photon) == 32);
#endif
#endif
