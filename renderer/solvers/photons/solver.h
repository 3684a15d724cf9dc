#pragma once
// Photons as the renderer sees them: stochastic progressive photon mapping, a round for every sample.
#include "solvers/photons/photon_map.h"
#include "solvers/photons/points_view.h"
#include "solvers/photons/report.h"
#include "solvers/photons/surface_index.h"
#include "solvers/solver.h"

namespace lucerna::photons {

const solvers::SolverType& type();

class PhotonSolver final : public solvers::Solver {
 public:
  /// Throws Error as PhotonMap.
  PhotonSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, const solvers::Task& task);

  const solvers::SolverInfo& info() const override;
  std::string hook() const override { return sends_ ? "photons/vertex_hook.glsl" : ""; }
  void bind(gpu::Resources& resources) const override;
  bool serves(const solvers::Task& task) const override;

  void begin(const solvers::Picture& picture, solvers::Spoils spoils) override;
  bool in_rounds() const override { return sends_; }
  bool round_ready(uint32_t sample) const override;
  bool prepare_round(transport::Wavefront& wavefront, const solvers::Picture& picture, uint32_t sample,
                     const solvers::Cancel& cancel) override;

  void draw(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::shared_ptr<const solvers::Report> report(const overlay::Canvas& canvas,
                                                const solvers::Picture& picture, bool sampled) override;
  nlohmann::ordered_json statistics(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::map<std::string, double> figures() const override;

  const PhotonMap& map() const { return map_; }

 private:
  PhotonReport state(const solvers::Picture& picture) const;
  Round round_of(const solvers::Picture& picture, uint32_t sample) const;

  gpu::Device& device_;
  paths::LookupRoutes routes_;
  uint32_t parts_;  ///< of light that the scene has: without caustics where nothing focuses
  bool sends_;      ///< photons; else there is nothing that they could bring
  PhotonMap map_;
  PointsView view_;
  SurfaceIndex surfaces_;
  transport::LightSource lights_;
  bool lit_ = false;          ///< lights_ are the scene's
  uint32_t last_sample_ = 0;  ///< whose round is complete, in this picture
  bool fresh_ = true;         ///< no round of this picture is
  uint64_t rounds_ = 0, paths_ = 0, photons_ = 0, escaped_ = 0, dark_ = 0;  ///< of this picture
};

}  // namespace lucerna::photons
