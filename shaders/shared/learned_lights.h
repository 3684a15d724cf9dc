// Learned light selection: probabilities of lights by what has arrived at a place before, and the records to learn from.
// Read by C++ and GLSL.
//
// Clusters are disjoint parts of all lights: rectangles of the sky's texels, squares of large emissive triangles, runs of
// neighbouring small ones, lamps. Each portal is one too (shared/portals.h), the last of the sky's; it samples the same
// directions as the sky's texels. A row holds the probability of each cluster for one cell of space and one facing. Within a
// cluster, lights are chosen as without learning, so that the density of a light sample is the density without learning times
// the ratio of row and cluster.
//
// Texel buffers (RGBA32F; integers as bit patterns):
// learned_grid: k_learned_top^3 words for each of 6 facings, then k_learned_brick^3 words a brick, four words a texel. A word
// is row << 1, or brick << 1 | 1 where rows differ within the cell of the coarse grid.
// learned_rows: an alias table of the clusters a row: (threshold, bits alias, ratio of this cluster, ratio of the alias).
// light_clusters: one texel a cluster: (bits first member, bits number of members, bits square, probability without learning).
// A square is column | row << 8 | squares a side << 16 of the unit square of random numbers that choose a place on the
// member; 1 << 16: the whole unit square. k_cluster_of_triangles: a run of emissive triangles.
// cluster_members: alias tables: (threshold, bits 0, bits member, bits member of the alias). A member of the sky is a texel of
// the environment, of a portal the portal, else an entry of scene_lights.
// light_facets (LUCERNA_TRIANGLE_CANDIDATES): one texel a triangle of scene_lights: (centroid, bits facing). Facing: the normal
// of the emitting side, octahedral, 12 bits each; bits 24-30 e of the area 2^(e - 64) m^2; bit 31: both sides emit.
// primitive_clusters: a word a primitive, four a texel: first cluster | squares a side << 24.
// sky_tiles: a byte a texel of the environment, 16 a texel: its cluster.
#ifndef LUCERNA_SHARED_LEARNED_LIGHTS_H
#define LUCERNA_SHARED_LEARNED_LIGHTS_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_learned_top = 16u;    ///< cells of the coarse grid along an axis
LUCERNA_CONST uint k_learned_brick = 8u;   ///< cells of the fine grid in one of these, along an axis
LUCERNA_CONST uint k_learned_cells = 128u; ///< cells of the fine grid along an axis
LUCERNA_CONST uint k_learned_facings = 6u;
LUCERNA_CONST uint k_cluster_of_triangles = 0x80000000u;
LUCERNA_CONST uint k_learned_vertices = 4u;  ///< maximum vertices of a path whose light samples are recorded

/// A vertex: its light sample, and the light that its scattered ray hits. A value is a contribution over the density of its
/// direction within its cluster, weighted against scattered rays as if there were no other cluster; a rate is the density of
/// scattered rays in this direction over the density within the cluster.
struct LightRecord {
  vec3 position;
  uint cell;       ///< facing << 16 | cluster of the light sample
  float value, rate;
  float full;      ///< luminance at the start of its shadow ray; < 0: no shadow ray; 0: no record
  float arrived;   ///< ... at its end
  float before;    ///< luminance of the path's throughput
  uint met;        ///< cluster of the light that the scattered ray hits, from 1; 0: none
  float met_value, met_rate;
};

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::LightRecord) == 48);
#endif
#endif
