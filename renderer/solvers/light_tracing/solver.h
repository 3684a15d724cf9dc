#pragma once
// Light tracing as a solver: one round of light paths for every sample, connected to the camera.
#include "overlay/light_paths.h"
#include "solvers/capabilities.h"
#include "solvers/light_tracing/report.h"
#include "solvers/light_tracing/splats.h"

namespace lucerna::light_tracing {

const solvers::SolverType& type();

class LightTracingSolver final : public solvers::Solver,
                                 public solvers::Kernels,
                                 public solvers::Preparation,
                                 public solvers::Rounds,
                                 public solvers::Views,
                                 public solvers::Statistics {
 public:
  /// Throws Error like Splats.
  LightTracingSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, const solvers::Task& task);

  const solvers::SolverInfo& info() const override;
  gpu::Defines defines() const override;
  void bind(gpu::Resources& resources) const override;
  bool serves(const solvers::Task& task) const override;

  void begin(const solvers::Picture& picture, solvers::Invalidation invalidated) override;
  /// True once the casters, and the shares of paths aimed at them, are known.
  bool ready() const override { return !aims_ || aimed_; }
  bool prepare(transport::Wavefront& wavefront, const solvers::Picture& picture,
               const solvers::Cancel& cancel) override;
  bool in_rounds() const override { return sends_; }
  bool round_ready(uint32_t sample) const override;
  bool prepare_round(transport::Wavefront& wavefront, const solvers::Picture& picture, uint32_t sample,
                     const solvers::Cancel& cancel) override;

  void draw(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::shared_ptr<const solvers::Report> report(const overlay::Canvas& canvas,
                                                const solvers::Picture& picture, bool sampled) override;
  nlohmann::ordered_json statistics(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::map<std::string, double> figures() const override;

  static solvers::Routing routing_of(const solvers::Task& task);

 private:
  transport::LightRound round_of(const solvers::Picture& picture, uint32_t sample) const;
  LightTracingReport state(const solvers::Picture& picture) const;

  gpu::Device& device_;
  paths::LookupRoutes routes_;
  bool sends_;  ///< the scene may focus light
  Splats splats_;
  overlay::LightPathsPainter paths_view_;
  transport::LightSource lights_;
  bool lit_ = false;    ///< lights_ are up to date
  bool begun_ = false;  ///< splats_ belong to this picture

  bool aims_ = false;   ///< there may be casters
  bool aimed_ = false;  ///< shares belong to this picture
  std::vector<Box> casters_;
  bool casters_known_ = false, casters_set_ = false;  ///< set: in lights_, with equal shares
  std::vector<overlay::AimedPair> pairs_;             ///< aimed pairs with their shares
  shared::Frame aimed_for_{};

  uint32_t last_sample_ = 0;  ///< sample of the latest complete round of this picture
  uint64_t rounds_ = 0, paths_ = 0, joined_ = 0, escaped_ = 0, dark_ = 0;  ///< of this picture
  double trace_s_ = 0;
};

}  // namespace lucerna::light_tracing
