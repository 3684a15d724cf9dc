// The records of an irradiance cache. Read by C++ and GLSL.
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

LUCERNA_CONST uint k_part_direct = 0u;     ///< L: in a cache, the sky's alone (E_env; lib/sky.glsl)
LUCERNA_CONST uint k_part_secondary = 1u;  ///< [SG]*DL
LUCERNA_CONST uint k_part_tertiary = 2u;   ///< the rest
LUCERNA_CONST uint k_part_caustic = 3u;    ///< [SG]+L
LUCERNA_CONST uint k_part_count = 4u;
// What share each group of lights has in them stands apart (irradiance_cache/groups.glsl).

/// Files keep the texels below as they are: another number for another meaning of them.
LUCERNA_CONST uint k_record_layout = 5u;
// record_texels: k_record_texels a record.
//   0: position xyz [m], moved off its surface by the error bound; radius of validity, the greater of an
//   ellipse [m], 0: none yet
//   1: normal xyz, unit, on the side that is lit; harmonic mean of the distances that its rays met [m]
//   2: bits rays so far, least distance [m], standard error of the luminance of all parts' sum (irradiance),
//   bits k_record_*
//   3: the ellipse of validity: the direction of its greater axis, as long as the root of 1/r^2 - 1/R^2 (0 of
//   a circle); its lesser radius r [m]
//   4: of metric `hessian`: what the pilot rays of this record and of those around it say of the light here,
//   by which its ellipse is made: the Hessian of the irradiance's luminance in tangent and bitangent, xx, xy,
//   yy [1/m^2], and that luminance
//   5: bits of the media in which the record lies, as PathState has them; of metric `hessian` the greatest r
//   at which such an ellipse holds nothing that a ray met [m], 0: not known yet; 0; 0
LUCERNA_CONST uint k_record_texels = 6u;
/// Most of the greater radius over the lesser.
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
//   likewise [1/m]; how far off the record the latter holds [m], k_record_slope_most at most.
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
    126u;  ///< of a byte: read as floats they are never infinite, nor no numbers
LUCERNA_CONST uint k_no_guide = 0xffffffffu;

/// Bytes that a record takes with its sphere and its light as lookups read it; the octree's references come
/// to that.
LUCERNA_CONST uint k_record_bytes = 16u * (k_record_texels + 2u * k_part_count * k_part_texels + 1u);

// candidate_texels: 2 per path slot, all 0 without a candidate:
//   0: position, off its surface; 1 + k_origin_* + k_candidate_media times the media
//   1: smooth normal on the lit side, bits facet
LUCERNA_CONST uint k_candidate_media = 4u;
LUCERNA_CONST uint k_candidate_texels = 2u;

struct RelightPreviewPush {
  vec3 factor;  ///< of the light before; by groups of lights, where these are kept apart, there is more
  uint count;  ///< records
  uint sky_group; ///< of lights
};

LUCERNA_CONST uint k_no_routes = 0x4444u;  ///< k_component_count for every part

LUCERNA_CONST uint k_probe_none = 0u;
/// Vertices that no record serves are noted as candidates. Paths end where they look up, and sample no
/// lights.
LUCERNA_CONST uint k_probe_lookups = 1u;
/// The same, and paths go on: of the diffuse vertices from the lookup on, one by chance is noted.
LUCERNA_CONST uint k_probe_beyond = 2u;
/// The first vertex is noted where it is diffuse, whether paths look up there and records serve it or not,
/// and paths end there; where no record can serve its normal map, with an origin below 0.
LUCERNA_CONST uint k_probe_screen = 3u;
/// The last vertex that looks up is noted, whether records serve it or not. Paths end as in k_probe_lookups.
LUCERNA_CONST uint k_probe_reads = 4u;
/// The same of what records' rays read: paths go on where they look up, and the next vertex that is diffuse
/// is noted, where they end.
LUCERNA_CONST uint k_probe_next = 5u;

/// Of the vertices that read records and from which the path goes on by a diffuse event, where it ends, is
/// noted with its throughput there, in place of a candidate. The mean of what is noted, times
/// what records there hold, is what pictures read of them.
LUCERNA_CONST uint k_probe_errors = 6u;
/// The same of what the records themselves have read: paths pass their first lookup over and note one of
/// those beyond.
LUCERNA_CONST uint k_probe_errors_beyond = 7u;

// Noted by these, in candidate_texels:
//   0: position; bits 1 + state of the automaton + k_note_media times the media, 0: nothing is noted
//   1: smooth normal on the side that is lit, bits throughput_pack() of the throughput behind the diffuse
//   lobe, over pi
LUCERNA_CONST uint k_note_media = 32u;

/// leave_one_out.comp leaves for every record, over the luminance of its irradiance: what it is off by where
/// it ends, by what the others around say of it beyond what it says itself; 0, 0, 0; the same of their errors
/// in every lane.
LUCERNA_CONST uint k_residual_texels = 1u + k_record_lanes / 4u;

struct PropagatePush {
  uint width, height;  ///< of the picture, in pixels of the film
  uint step;  ///< of which so many along each side have one of this kernel's pixels: a power of 2, at most 8
  uint pixels;  ///< of these in the item, two paths each
  uint beyond;  ///< not 0: what records have read counts too
};

/// Parameters of lookups.
struct CacheFrame {
  /// By state of the automaton, for the diffuse lobe of a vertex met in it: bits 4 p on: the component to
  /// which part p goes; k_component_count: none. k_no_routes: no lookup there.
  uint routes[32];
  uint record_count;
  /// Most that the normals of a point and of a record may differ, as 1 - cos.
  float normal_tolerance;
  /// How far off the plane between its own and a record's tangent plane, in the record's radius, a point may
  /// lie and still be served.
  float off_plane;
  uint probing;  ///< k_probe_*
  /// The same for records of minimum radius: steps of surfaces that small are invisible, and would otherwise produce
  /// candidates forever.
  float off_plane_least;
  float least_of_distance;  ///< the least radius, of the distance from `eye`; where `parallel`, in metres
  float least_most;         ///< ... at most [m]
  uint parallel;
  vec3 eye;
  uint branches;  ///< of a path of the picture that gathers
};

/// One level of evaluation of `records` records: entries `first` on of record_list, elevations x azimuths
/// paths each.
struct RecordPush {
  uint first, records;
  uint elevations, azimuths;
  uint rays_before;  ///< that each of them has had
  uint parts;        ///< bit p: part p is wanted
  uint state;        ///< of the automaton after ED
  uint seed;
  uint pilot;  ///< not 0: pilot rays, which set the radius and contribute no light
};

struct RadiusPush {
  uint first, count;  ///< records
  float error;        ///< radius over harmonic mean distance
  float most;         ///< [m]
  float near;         ///< ... and over the distance of the nearest thing
  float crowd;        ///< as EllipsePush has it
};

struct ClampPush {
  uint count;      ///< records
  float near;      ///< lesser radius over the distance of the nearest thing, at most
  float crowd;     ///< as EllipsePush has it ...
  uint undecided;  ///< ... for records from this one on
};
/// Of a record that none clamps: the bits of infinity.
LUCERNA_CONST uint k_no_bound = 0x7f800000u;

/// How much of the picture reads a record.
struct ImportancePush {
  uint pixels;
  uint first;  ///< pixels before these
  uint next;   ///< not 0: there are next places too
};
LUCERNA_CONST uint k_importance_steps = 256u;  ///< that a pixel of which a record has all is
/// Upper bound of a record's importance through another one, relative to that one: its square in steps is below 2^32.
LUCERNA_CONST float k_importance_most = 2048.0f;
LUCERNA_CONST uint k_importance_place = 0x40000000u;  ///< a place is one; above the 22 bits of its normal

struct EllipsePush {
  uint first, count;  ///< records
  float reach;        ///< fourth root of 4/pi times the integral of a record's relative error [m^(1/2)]
  float most;         ///< [m]
  float dark;         ///< irradiance, luminance: records that have less are held against it
  float near;         ///< lesser radius over the greatest that holds nothing that a ray met, at most
  float near_tried;   ///< the same where only the distance of the nearest thing is known
  /// Over the least radius: where something is nearer than that records crowd; 0: it has been decided which
  /// do.
  float crowd;
};

/// Averages pilot results.
struct PoolPush {
  uint first, count;  ///< records
};

// What the overlay colours records by.
LUCERNA_CONST uint k_record_by_pass = 0u;
LUCERNA_CONST uint k_record_by_origin = 1u;
LUCERNA_CONST uint k_record_by_rays = 2u;
LUCERNA_CONST uint k_record_by_distance = 3u;
LUCERNA_CONST uint k_record_by_error = 4u;
struct OverlayPush {
  uint width, height;
  uint discs, overlap;  ///< not 0: drawn
  uint color;           ///< k_record_by_*
  float lo, hi;         ///< of the value, logarithmic; 0 < lo < hi
  float overlap_most;   ///< records at the upper end of the heat map
  SightGrid grid;
};

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(lucerna::shared::k_record_bytes == 624 && sizeof(lucerna::shared::RecordPush) == 36);
#endif
#endif
