#pragma once
// Where paths from lights begin: each light in proportion to its power, with its own distribution over places
// and directions (shaders/lib/emission.glsl). For photons, and for whatever else is traced from lights.
#include "gpu/kernel.h"
#include "shaders/shared/emission.h"
#include "upload/flatten.h"

namespace lucerna::transport {

class LightSource {
 public:
  LightSource() = default;
  /// Throws Error: no memory.
  LightSource(gpu::Device& device, const upload::FlatLights& lights, const vec3& scene_centre,
              float scene_radius);
  /// emission_alias, EmissionBlock. What lights are is bound with the scene.
  void bind(gpu::Resources& resources) const;
  /// Luminance of the flux of all lights [W]; 0: there is nothing to begin.
  double power() const { return power_; }
  const shared::EmissionTable& table() const { return table_; }
  uint64_t bytes() const { return alias_ ? alias_.bytes() : 0; }

 private:
  shared::EmissionTable table_{};
  gpu::Buffer alias_, block_;
  double power_ = 0;
};

}  // namespace lucerna::transport
