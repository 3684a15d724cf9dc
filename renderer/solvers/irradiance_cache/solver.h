#pragma once
// The irradiance cache as a solver: cache.h with options from the settings, views and report.
#include <memory>

#include "solvers/capabilities.h"
#include "solvers/irradiance_cache/cache.h"
#include "solvers/irradiance_cache/inspector.h"
#include "solvers/irradiance_cache/placement_view.h"
#include "solvers/irradiance_cache/report.h"

namespace lucerna::irradiance_cache {

const solvers::SolverType& type();

/// Hash of the assignment of lights to groups, for compact groups, where records store shares; 0: no shares.
uint64_t light_grouping(const upload::FlatScene& flat);

class CacheSolver final : public solvers::Solver,
                          public solvers::Kernels,
                          public solvers::Adoption,
                          public solvers::SettingsObserver,
                          public solvers::Preparation,
                          public solvers::PreviewLookups,
                          public solvers::Refinement,
                          public solvers::LookupErrors,
                          public solvers::Views,
                          public solvers::Statistics,
                          public solvers::Commands,
                          public solvers::Persistence {
 public:
  /// Throws Error like Cache.
  CacheSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const solvers::Task& task);

  const solvers::SolverInfo& info() const override;
  gpu::Defines defines() const override;
  std::string hook() const override { return "irradiance_cache/vertex_hook.glsl"; }
  void bind(gpu::Resources& resources) const override { cache_.bind(resources); }
  bool serves(const solvers::Task& task) const override;

  void adopt(transport::Wavefront& wavefront, const solvers::Solver& before) override;
  void begin(const solvers::Picture& picture, solvers::Invalidation invalidated) override;
  void on_settings_changed(const OptionValues& settings, bool interactive) override;
  bool ready() const override { return cache_.ready(); }
  bool waits() const override { return cache_.status().waits; }
  void look_up_preview(transport::Wavefront& wavefront, bool on) override {
    cache_.look_up_preview(wavefront, on);
  }
  bool prepare(transport::Wavefront& wavefront, const solvers::Picture& picture,
               const solvers::Cancel& cancel) override;
  bool usable() const override { return cache_.usable(); }
  bool stepped() const override { return cache_.stepped(); }
  void finish_early() override { cache_.finish_early(); }
  uint64_t paths_refined() const override { return cache_.status().rays; }
  void begin_refining(double factor) override { cache_.refine(factor); }
  bool refines() const override { return cache_.refines(); }
  bool refine(transport::Wavefront& wavefront, const solvers::Picture& picture,
              const solvers::Cancel& cancel) override;
  bool warm() const override { return ready() || cache_.status().pass >= 2; }
  bool owes_errors(const film::Film& film) const override { return !film.lookup_errors_current(); }
  bool estimate_errors(transport::Wavefront& wavefront, film::Film& film, const solvers::Picture& picture,
                       bool restarted, const solvers::Cancel& cancel) override;

  void look_at(std::optional<vec2> place) override { looked_at_ = place; }
  void draw(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::shared_ptr<const solvers::Report> report(const overlay::Canvas& canvas,
                                                const solvers::Picture& picture, bool sampled) override;
  /// Input of report().
  CacheReport state(const overlay::Canvas& canvas, const solvers::Picture& picture, bool sampled);
  nlohmann::ordered_json statistics(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::map<std::string, double> figures() const override;
  /// Looks light up at every sampled pixel and discards it, for timing.
  void look_up_picture(const overlay::Canvas& canvas, const solvers::Picture& picture);
  void command(const std::string& name) override;
  void save(const std::string& file, const solvers::Picture& picture,
            const solvers::Provenance& provenance) const override;
  void load(const std::string& file, transport::Wavefront& wavefront, const solvers::Picture& picture,
            const solvers::Provenance& provenance) override;

  Cache& cache() { return cache_; }
  const Cache& cache() const { return cache_; }

 private:
  CacheView view(const solvers::Picture& picture) const;
  Inspector& inspector();
  /// Statistics of records per pixel; computed once per picture.
  const Overlap& overlap(const overlay::Canvas& canvas, const solvers::Picture& picture);
  void warn_of_full_cache();

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  /// Frames of the picture's paths; of the records' rays, in records; and components that look up.
  paths::LookupRoutes picture_routes_, record_routes_, ray_routes_;
  Metric metric_;
  bool gathers_;
  Cache cache_;
  /// What is invalid in an adopted cache; everything in a new one.
  solvers::Invalidation lacks_ = solvers::k_invalidates_all;
  uint64_t grouping_ = 0;                          ///< light_grouping() of the records
  std::unique_ptr<Inspector> inspector_;           ///< made at the first use
  std::unique_ptr<PlacementView> placement_view_;  ///< likewise
  std::optional<vec2> looked_at_;
  Inspection inspection_;
  std::optional<Overlap> overlap_;  ///< of the current picture
  bool interactive_ = false;
  uint32_t full_at_ = 0;  ///< number of records at the last warning that the cache is full
};

}  // namespace lucerna::irradiance_cache
