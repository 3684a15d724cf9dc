#pragma once
// Sampling tables of the sky through portals (shaders/shared/portals.h). Host code.
#include <vector>

#include "base/shared_vector.h"
#include "scene/scene.h"
#include "upload/environment_tables.h"

namespace lucerna::upload {

/// Copies share the sums.
struct PortalTables {
  std::vector<vec4> portals;    ///< scene_portals
  SharedVector<uint32_t> sums;  ///< portal_sums
  /// Probabilities among the portals, in proportion to the flux of the sky's sampling density through each;
  /// they sum to 1.
  std::vector<double> shares;
  uint32_t count() const { return uint32_t(shares.size()); }
  // The source of the tables.
  std::vector<scene::Portal> of;
  SharedVector<float> density;
  double rotation = 0;  ///< degrees
};

/// Tables of the scene's portals for that environment, as one emitter; none if no portal receives light.
/// `before`: returned if its source is equal. A table's texel has the weight of the sky's density, of which a
/// map wider than 1024 texels is averaged, times its solid angle.
PortalTables portal_tables(const scene::Scene& scene, const EnvironmentTables& environment,
                           const PortalTables& before);

}  // namespace lucerna::upload
