#pragma once
// Sampling tables of the environment's directions. They depend only on its image and are slow to build for a
// large one; edits of other lights and of the environment's strength and rotation keep them.
#include <optional>

#include "base/shared_vector.h"
#include "scene/scene.h"

namespace lucerna::upload {

/// Identity of an environment's texels. Equal sources have equal texels; copies of a scene have equal
/// sources.
struct EnvironmentSource {
  EnvironmentSource() = default;
  explicit EnvironmentSource(const scene::Scene& scene);
  SharedVector<scene::Image> images;  ///< none: the environment is constant
  scene::Id image = scene::k_none;
  vec3 radiance{0};  ///< of a constant environment
  bool operator==(const EnvironmentSource& o) const;
};

/// Copies share the large tables.
struct EnvironmentTables {
  SharedVector<vec4> alias;
  SharedVector<float> density;  ///< by texel, density of its directions [1/sr]; sign bit: texel of the sun
  SharedVector<vec4> sun_cells;
  SharedVector<vec4> sun_density;  ///< four texels each [1/sr], without the sun's own pmf
  double sky_weight = 0,
         sun_weight = 0;  ///< luminance times solid angle, times width / 2 pi; the sun's if it is separate
  std::optional<EnvironmentSource> source;  ///< none: there is no environment
  float sun_threshold = 0;                  ///< 0: the sun is not separate
};

/// `sun_threshold`: that of FlatScene; 0: the environment is one emitter. `before`: returned if its source is
/// equal.
EnvironmentTables environment_tables(const scene::Scene& scene, float sun_threshold,
                                     const EnvironmentTables& before);

}  // namespace lucerna::upload
