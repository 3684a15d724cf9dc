// Emission of light paths. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_EMISSION_H
#define LUCERNA_SHARED_EMISSION_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// Besides emission_alias, an alias table like light_alias (shared/scene.h) by the power of lights.
struct EmissionTable {
  vec3 centre;   ///< centre of the sphere around the scene [m]
  float radius;  ///< its radius: distant light starts on a disk of this radius
  uint count;    ///< entries of emission_alias: the lights of scene_lights, and the sky if it is none of them
  uint sky;      ///< entry of the sky; k_no_sky_entry: none
  float sun_pmf; ///< pmf of the sun in light_alias, with a separate sky
  uint casters;  ///< number of boxes to aim at; 0: no aiming
  uint groups;   ///< number of light groups for aiming
  vec3 core_centre;   ///< likewise for the core, without distant outliers (FlatScene::core_radius)
  float core_radius;
  float core_share;   ///< share of distant light that starts on the core's disk; 0: there are no outliers
};
LUCERNA_CONST uint k_no_sky_entry = 0xffffffffu;

// Aimed emission. A stratum is 0, which is not aimed, or 1 + group of lights * casters + caster. emission_strata: a texel
// each (bits of the start of its interval of 0 ... 2^32, its share of all). emission_boxes: two texels a caster, low and high
// corner. emission_groups, in this order: a texel a group (bits first, bits count of its members), a texel an entry of
// emission_alias (bits group, bits member), a texel a member (bits entry). emission_members: an alias table a group, by power,
// with entries counted from its first member.
LUCERNA_CONST uint k_most_casters = 32u;  ///< maximum number of boxes
LUCERNA_CONST uint k_most_strata = 4096u;

/// Parameters of a batch of light paths. `count` comes first, as wavefront.glsl requires.
struct EmitPush {
  uint count;      ///< paths of this batch
  uint first;      ///< number of its first path in the round
  uint round;
  float share;     ///< 1 / paths of the round
  uint step;       ///< 2^32 / paths of the round
};
LUCERNA_CONST uint k_most_light_events = 255u;      ///< maximum events of a light path
LUCERNA_CONST uint k_most_light_paths = 1u << 24;   ///< maximum paths of a round

// LightPathCounts, uint each.
LUCERNA_CONST uint k_light_paths_dark = 0u;     ///< started where the light does not emit
LUCERNA_CONST uint k_light_paths_escaped = 1u;  ///< left the scene
LUCERNA_CONST uint k_light_path_counts = 2u;

LUCERNA_SHARED_END
#endif
