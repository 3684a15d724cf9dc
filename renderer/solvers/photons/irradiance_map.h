#pragma once
// Irradiance at places where photons of a map lie, so that a lookup is to find the nearest place
// (shaders/photons/irradiance.glsl) instead of adding up all photons around.
#include "solvers/photons/photon_map.h"

namespace lucerna::photons {

class IrradianceMap {
 public:
  /// `scene_defines`: of the kernels that know the scene. Throws Error: a kernel does not compile (located).
  IrradianceMap(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines);

  /// From a complete map whose photons all have one radius, as `from` binds it with the surfaces around.
  /// `component`: by state of the eye path, as PhotonFrame has it, what lookups bring of it. Throws Error
  /// when memory is short. The wavefront's lookups are bound anew.
  void make(transport::Wavefront& wavefront, const PhotonMap& map, const std::vector<uint32_t>& component,
            const std::function<void(gpu::Resources&)>& from);
  /// Lookups find nothing, until the next one is made.
  void clear();
  bool complete() const { return complete_; }
  void bind(gpu::Resources& resources) const;
  uint32_t places() const { return lookup_.count; }
  uint64_t bytes() const;

 private:
  void write_lookup();

  gpu::Device& device_;
  gpu::Kernel choose_, gather_;
  PhotonCells cells_;
  uint32_t group_words_;  ///< texels of shares a place; 0: groups are not kept
  gpu::Buffer list_, ids_, irradiance_, shares_, block_;
  shared::PhotonFrame lookup_{};
  bool complete_ = false;
};

}  // namespace lucerna::photons
