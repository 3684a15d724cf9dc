#pragma once
// A scene ready for tracing: flattened, with its tree, in device memory.
#include <functional>
#include <memory>

#include "bvh/embree/host_tracer.h"
#include "scene/scene.h"
#include "transport/wavefront.h"
#include "upload/device_scene.h"
#include "upload/flatten.h"

namespace lucerna::session {

/// fraction 0..1 and the current step; returning false cancels (Error "cancelled" is thrown).
using Progress = std::function<bool(float, const std::string&)>;

struct World {
  std::shared_ptr<const scene::Scene> scene;
  /// The traced scene: the scene itself or, if its light groups are not separate, with the mix applied to its
  /// lights.
  std::shared_ptr<const scene::Scene> lit;
  upload::FlatScene flat;
  std::unique_ptr<upload::DeviceScene> device;
  std::unique_ptr<bvh::HostTracer> host;  ///< null: kernels trace

  transport::HostTrace trace() const;  ///< on the host; empty if kernels trace
};

/// `tracer`: the setting. Throws Error: too large, no memory, cancelled.
World make_world(gpu::Device& device, std::shared_ptr<const scene::Scene> scene,
                 std::shared_ptr<const scene::Scene> lit, const std::string& tracer,
                 const upload::LightSeparation& separation, const Progress& progress);

/// Reports progress; throws Error "cancelled" if the callback returns false.
void report_progress(const Progress& progress, float fraction, const std::string& what);

/// Changes lights, environment or material factors of a world on trial: unless keep() is called, the
/// destructor restores the world.
class WorldEdit {
 public:
  /// `factors`: material factors differ. Throws Error: memory; the world is then unchanged.
  WorldEdit(gpu::Device& device, World& world, std::shared_ptr<const scene::Scene> edited,
            std::shared_ptr<const scene::Scene> lit, const upload::LightSeparation& separation, bool factors);
  ~WorldEdit();
  WorldEdit(const WorldEdit&) = delete;
  WorldEdit& operator=(const WorldEdit&) = delete;
  void keep() { kept_ = true; }

 private:
  void try_out(gpu::Device& device, bool factors);
  void put_back() noexcept;

  World& world_;
  std::shared_ptr<const scene::Scene> scene_, lit_;
  upload::FlatLights lights_;
  upload::FlatMaterials materials_;
  upload::Effects effects_;
  upload::LightSeparation separation_;
  upload::LightBuffers light_buffers_;
  upload::MaterialBuffers material_buffers_;
  bool lights_out_ = false, materials_out_ = false, kept_ = false;
};

}  // namespace lucerna::session
