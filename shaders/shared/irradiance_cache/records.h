// The records of an irradiance cache: layout and kernel parameters. Read by C++ and GLSL.
//
// A record stores the irradiance at a surface point in parts, so that components stay separate wherever it is read. Parts
// have the numbers of the components of a path that begins with ED: direct light, light over one diffuse event, over more,
// or over mirrors and glass alone.
#ifndef LUCERNA_SHARED_IRRADIANCE_CACHE_RECORDS_H
#define LUCERNA_SHARED_IRRADIANCE_CACHE_RECORDS_H
#include "shaders/shared/compat.h"
#include "shaders/shared/film.h"
#include "shaders/shared/irradiance_cache/discontinuity.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_part_direct = 0u;     ///< L: in a cache only the sky's (E_env; lib/sky.glsl)
LUCERNA_CONST uint k_part_secondary = 1u;  ///< [SG]*DL
LUCERNA_CONST uint k_part_tertiary = 2u;   ///< the rest
LUCERNA_CONST uint k_part_caustic = 3u;    ///< [SG]+L
LUCERNA_CONST uint k_part_count = 4u;
// The shares of light groups in them are stored separately (irradiance_cache/groups.glsl).

/// Version of the texels below, as files store them.
LUCERNA_CONST uint k_record_layout = 5u;
// record_texels: k_record_texels a record.
//   0: position xyz [m], moved off its surface by the error bound; radius of validity, the greater one of an
//   ellipse [m], 0: none yet
//   1: normal xyz, unit, on the lit side; harmonic mean of the distances to its rays' hits [m]
//   2: bits of the number of rays so far, minimum distance [m], standard error of the luminance of the sum of
//   all parts (irradiance), bits k_record_*
//   3: the ellipse of validity: direction of its greater axis with length sqrt(1/r^2 - 1/R^2) (0 for a circle);
//   its lesser radius r [m]
//   4: with metric `hessian`: estimate from the pilot rays of this record and its neighbours, which determines
//   the ellipse: Hessian of the irradiance's luminance in tangent and bitangent, xx, xy, yy [1/m^2], and that
//   luminance
//   5: bits of the media that contain the record, as in PathState; with metric `hessian` the greatest r at which
//   such an ellipse contains no hit [m], 0: unknown; 0; 0
LUCERNA_CONST uint k_record_texels = 6u;
/// Maximum ratio of the greater radius to the lesser.
LUCERNA_CONST float k_record_ratio = 2.0f;
LUCERNA_CONST uint k_record_pass = 0x7fu;  ///< mask: the pass that placed it, from 0
/// Crowded: geometry is nearer than a few minimum radii, so the light there is too fine to interpolate. The record stores no
/// irradiance; paths within its disc gather. In place of irradiance it stores a guide table (k_guide_*).
LUCERNA_CONST uint k_record_crowded = 0x80u;
LUCERNA_CONST uint k_record_origin_shift = 8u;  ///< 2 bits: origin of its candidate, k_origin_*
LUCERNA_CONST uint k_record_facet_shift =
    10u;  ///< 11 + 11 bits: the geometric normal, octahedral (Cigolle et al. 2014)
LUCERNA_CONST uint k_origin_screen = 0u;  ///< a directly visible surface
LUCERNA_CONST uint k_origin_world = 1u;   ///< seen in mirrors, through glass or by one diffuse bounce
LUCERNA_CONST uint k_origin_recursive =
    2u;  ///< a vertex beyond the lookup, for rays of other records

// irradiance_texels: k_part_texels for each (record, part), record by record: 16 floats:
//   irradiance rgb; rotational gradient rgb along the tangent, then along the bitangent; translational
//   likewise [1/m]; distance off the record up to which the latter is valid [m], at most k_record_slope_most.
// Tangent and bitangent are make_basis() of the normal. Rotational gradient: change of the irradiance as the
// normal n_i turns to n, by the components of n_i x n.
LUCERNA_CONST uint k_part_texels = 4u;
LUCERNA_CONST float k_record_slope_most = 1e30f;

// For crowded records the same texels store one byte for each cell of the hemisphere, elevations of one azimuth in turn: the
// luminance of its rays, over the maximum. Cells are uniform in azimuth from the tangent on, and in sin^2 of the angle from
// the normal.
LUCERNA_CONST uint k_guide_azimuths = 32u, k_guide_elevations = 8u;
LUCERNA_CONST uint k_guide_texels = 16u;
LUCERNA_CONST uint k_guide_most =
    126u;  ///< maximum value of a byte, so that texels read as floats are neither infinite nor NaN
LUCERNA_CONST uint k_no_guide = 0xffffffffu;

/// Bytes of a record with its sphere, its irradiance for lookups, and its errors; the references of the octree are
/// additional.
LUCERNA_CONST uint k_record_bytes =
    16u * (k_record_texels + 2u * k_part_count * k_part_texels + 1u) + 4u * k_lookup_lanes;

// candidate_texels: 2 per path slot, all 0 without a candidate:
//   0: position, off its surface; 1 + k_origin_* + k_candidate_media times the media
//   1: smooth normal on the lit side, bits facet
LUCERNA_CONST uint k_candidate_media = 4u;
LUCERNA_CONST uint k_candidate_texels = 2u;

struct RelightPreviewPush {
  vec3 factor;  ///< factor on the light; separate light groups have further factors
  uint count;  ///< number of records
  uint sky_group; ///< light group of the sky
};

LUCERNA_CONST uint k_no_routes = 0x4444u;  ///< k_component_none for every part

LUCERNA_CONST uint k_probe_none = 0u;
/// Notes vertices without a record as candidates. Paths end at lookups and sample no lights.
LUCERNA_CONST uint k_probe_lookups = 1u;
/// Likewise, but paths continue, and one of the diffuse vertices from the lookup on is noted at random.
LUCERNA_CONST uint k_probe_beyond = 2u;
/// Notes the first vertex if it is diffuse, with or without a lookup or records, and ends the path there. If its
/// normal map is too steep for records, the origin is below 0.
LUCERNA_CONST uint k_probe_screen = 3u;
/// Notes the last vertex with a lookup, with or without records. Paths end as in k_probe_lookups.
LUCERNA_CONST uint k_probe_reads = 4u;
/// Likewise, for lookups of records' rays: paths continue at lookups, and the next diffuse vertex, where they
/// end, is noted.
LUCERNA_CONST uint k_probe_next = 5u;

/// Notes, in place of a candidate, one of the vertices that read records, with its throughput there. Paths end
/// at such a vertex or continue by a diffuse event. The mean of the noted throughput times the records'
/// irradiance there is the light that pictures read from them.
LUCERNA_CONST uint k_probe_errors = 6u;
/// Likewise, for the records' own lookups: paths continue past their first lookup and note a later one.
LUCERNA_CONST uint k_probe_errors_beyond = 7u;

// Noted by the last two, in candidate_texels:
//   0: position; bits 1 + state of the automaton + k_note_media times the media, 0: nothing noted
//   1: smooth normal on the lit side, bits throughput_pack() of the throughput after the diffuse lobe, over pi
LUCERNA_CONST uint k_note_media = 32u;

/// Texels of a record's residual by leave_one_out.comp, relative to the luminance of its irradiance: the
/// interpolation error at its border, from its difference to the other records; 0, 0, 0; likewise the errors
/// of the records in every lane.
LUCERNA_CONST uint k_residual_texels = 1u + k_lookup_lanes / 4u;

struct PropagatePush {
  uint width, height;  ///< of the picture, in pixels of the film
  uint step;  ///< film pixels along the side of one of this kernel's pixels: a power of 2, at most 8
  uint pixels;  ///< number of this kernel's pixels in the work item, two paths each
  uint beyond;  ///< not 0: includes the errors of records that records read
};

/// Parameters of lookups.
struct CacheFrame {
  /// By state of the automaton at the vertex, for its diffuse lobe: from bit 4 p, the component of part p;
  /// k_component_none: none. k_no_routes: no lookup there.
  uint routes[32];
  uint record_count;
  /// Maximum difference of the normals of a point and of a record, as 1 - cos.
  float normal_tolerance;
  /// Maximum distance of a point from the plane midway between its own and a record's tangent plane, over the
  /// record's radius.
  float off_plane;
  uint probing;  ///< k_probe_*
  /// Likewise, for records of minimum radius: such small steps of surfaces are invisible, and would otherwise
  /// produce candidates endlessly.
  float off_plane_least;
  float least_of_distance;  ///< minimum radius over the distance from `eye`; if `parallel`, in metres
  float least_most;         ///< its maximum [m]
  uint parallel;
  vec3 eye;
  uint branches;  ///< branches of a gathering path of the picture
};

/// One level of evaluation of `records` records: entries of record_list from `first`, elevations x azimuths
/// paths each.
struct RecordPush {
  uint first, records;
  uint elevations, azimuths;
  uint rays_before;  ///< rays of each record before
  uint parts;        ///< bit p: part p is computed
  uint state;        ///< state of the automaton after ED
  uint seed;
  uint pilot;  ///< not 0: pilot rays, which set the radius and contribute no light
};

struct RadiusPush {
  uint first, count;  ///< records
  float error;        ///< radius over harmonic mean distance
  float most;         ///< [m]
  float near;         ///< maximum radius over the distance of the nearest hit
  float crowd;        ///< as in EllipsePush
};

struct ClampPush {
  uint count;      ///< records
  float near;      ///< maximum lesser radius over the distance of the nearest hit
  float crowd;     ///< as in EllipsePush, ...
  uint undecided;  ///< ... for records from this one on
};
/// Value for a record without a clamp: the bits of infinity.
LUCERNA_CONST uint k_no_bound = 0x7f800000u;

/// Importance: the share of the picture that reads a record.
struct ImportancePush {
  uint pixels;
  uint first;  ///< number of pixels before these
  uint next;   ///< not 0: includes the places of next lookups
};
LUCERNA_CONST uint k_importance_steps = 256u;  ///< importance of a record that provides all light of a pixel
/// Upper bound of a record's importance through another one, relative to that one: its square in steps is below 2^32.
LUCERNA_CONST float k_importance_most = 2048.0f;
LUCERNA_CONST uint k_importance_place = 0x40000000u;  ///< flag of a place; above the 22 bits of its normal

struct EllipsePush {
  uint first, count;  ///< records
  float reach;        ///< fourth root of 4/pi times the integral of a record's relative error [m^(1/2)]
  float most;         ///< [m]
  float dark;         ///< minimum luminance of irradiance for relative errors
  float near;         ///< maximum lesser radius over the greatest one without a hit inside
  float near_tried;   ///< likewise, if only the distance of the nearest hit is known
  /// Distance of a hit over the minimum radius, below which records are crowded; 0: crowding is already decided.
  float crowd;
};

/// Averages pilot results.
struct PoolPush {
  uint first, count;  ///< records
};

// Quantity that the overlay shows as the colour of records.
LUCERNA_CONST uint k_record_by_pass = 0u;
LUCERNA_CONST uint k_record_by_origin = 1u;
LUCERNA_CONST uint k_record_by_rays = 2u;
LUCERNA_CONST uint k_record_by_distance = 3u;
LUCERNA_CONST uint k_record_by_error = 4u;
struct OverlayPush {
  uint width, height;
  uint discs, overlap;  ///< not 0: drawn
  uint color;           ///< k_record_by_*
  float lo, hi;         ///< range of the value, logarithmic; 0 < lo < hi
  float overlap_most;   ///< records at the upper end of the heat map
  SightGrid grid;
};

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(lucerna::shared::k_record_bytes == 688 && sizeof(lucerna::shared::RecordPush) == 36);
#endif
#endif
