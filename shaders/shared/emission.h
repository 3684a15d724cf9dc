// Where paths from lights begin. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_EMISSION_H
#define LUCERNA_SHARED_EMISSION_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// Besides emission_alias, which is like light_alias (shared/scene.h), by the power of lights.
struct EmissionTable {
  vec3 centre;   ///< of the sphere that holds the scene [m]
  float radius;  ///< of it: what comes from afar begins on a disk of this radius
  uint count;    ///< entries of emission_alias: the lights of scene_lights, and the sky where that is none of them
  uint sky;      ///< which entry that is; k_no_sky_entry: none
  float sun_pmf; ///< of the sun in light_alias, where the sky is apart
  float pad0;
};
LUCERNA_CONST uint k_no_sky_entry = 0xffffffffu;

LUCERNA_SHARED_END
#endif
