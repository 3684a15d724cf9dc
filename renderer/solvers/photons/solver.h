#pragma once
// Photon mapping as a solver: stochastic progressive photon mapping, one round for every sample.
#include "overlay/light_paths.h"
#include "schedule/uniform.h"
#include "solvers/capabilities.h"
#include "solvers/photons/efficiency.h"
#include "solvers/photons/inspector.h"
#include "solvers/photons/irradiance_map.h"
#include "solvers/photons/photon_map.h"
#include "solvers/photons/points_view.h"
#include "solvers/photons/report.h"
#include "solvers/photons/surface_index.h"
#include "solvers/photons/trials.h"
#include "transport/first_hits.h"

namespace lucerna::photons {

const solvers::SolverType& type();

/// Components (bits) behind a diffuse surface: secondary and tertiary.
inline constexpr uint32_t k_deep = paths::k_secondary_bit | paths::k_tertiary_bit;
/// ... and primary: those that paths trace in drafts before there are photons.
inline constexpr uint32_t k_drafted = paths::k_primary_bit | k_deep;

class PhotonSolver final : public solvers::Solver,
                           public solvers::Kernels,
                           public solvers::Preparation,
                           public solvers::PreviewLookups,
                           public solvers::Rounds,
                           public solvers::LookupBias,
                           public solvers::Views,
                           public solvers::Statistics {
 public:
  /// Throws Error like PhotonMap.
  PhotonSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, const solvers::Task& task);

  const solvers::SolverInfo& info() const override;
  gpu::Defines defines() const override;
  std::string hook() const override { return sends_ ? "photons/vertex_hook.glsl" : ""; }
  void bind(gpu::Resources& resources) const override;
  bool serves(const solvers::Task& task) const override;

  void begin(const solvers::Picture& picture, solvers::Invalidation invalidated) override;
  /// True once the pilot is complete (places of lookups, casters, shares, efficiency), and standing photons
  /// exist if records' rays or gathering paths read them.
  bool ready() const override {
    return pilot_done() && (!stands() || standing_served_) && (!tries_ || tried_);
  }
  uint32_t delegated_components() const override { return delegated_; }
  /// Secondary and tertiary light only; preview samples do not find caustics better.
  uint32_t missing(const solvers::Picture& picture) const override;
  /// Preview samples record nothing.
  void look_up_preview(transport::Wavefront& wavefront, bool on) override;
  bool prepare(transport::Wavefront& wavefront, const solvers::Picture& picture,
               const solvers::Cancel& cancel) override;
  bool in_rounds() const override { return sends_ && (reads_rounds() || renews_standing()); }
  bool round_ready(uint32_t sample) const override;
  /// Cells of the irradiance map with hidden area are too dark by an unknown amount.
  bool estimates_bias() const override { return !gathers() && !feeds_; }
  bool prepare_round(transport::Wavefront& wavefront, const solvers::Picture& picture, uint32_t sample,
                     const solvers::Cancel& cancel) override;

  void look_at(std::optional<vec2> place) override { looked_at_ = place; }
  void draw(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::shared_ptr<const solvers::Report> report(const overlay::Canvas& canvas,
                                                const solvers::Picture& picture, bool sampled) override;
  nlohmann::ordered_json statistics(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::map<std::string, double> figures() const override;

  /// Samples that use the first irradiance map; each further map serves twice as many.
  static constexpr uint32_t k_first_gather_samples = 8;

  const PhotonMap& map() const { return map_; }
  const Regions& regions() const { return regions_; }
  const PhotonInspector& inspector() const { return inspector_; }
  const std::optional<Inspected>& inspected() const { return inspected_; }
  static solvers::Routing routing_of(const solvers::Task& task);
  /// SolverType::delegable_components.
  static uint32_t delegable_components(const solvers::Task& task);

 private:
  bool pilot_done() const { return (!aims_ && !shares_lights_ && !spares_ && !weighs_ && !hides_) || aimed_; }
  /// Parts of light to store: all own parts, plus parts delegated to paths whose unreachable light only
  /// rounds find.
  uint32_t whole_parts() const;
  uint32_t sent_parts() const;
  bool reads_rounds() const;
  /// True if no round has found what only rounds are sent for: later ones are short until one does.
  bool seeks_in_vain() const;
  void store_parts(uint32_t sent);  ///< which of these rounds store completely
  /// Sets the routes below.
  void route(const solvers::Task& task);
  bool stands() const { return feeds_ || gathers(); }
  /// True if gathering paths read the irradiance map.
  bool gathers() const;
  /// True if gathering paths read new photons after some samples; records keep what they have read.
  bool renews_standing() const { return gathers() && !feeds_; }
  bool standing_made(uint32_t epoch) const;
  /// One work item of making the standing photons. False if cancelled.
  bool make_standing(transport::Wavefront& wavefront, const solvers::Picture& picture, uint32_t epoch,
                     const solvers::Cancel& cancel);
  /// ... before the first sample, and of binding them.
  bool prepare_standing(transport::Wavefront& wavefront, const solvers::Picture& picture,
                        const solvers::Cancel& cancel);
  /// Radius in which a typical lookup finds that many photons of that many paths.
  float standing_radius(const solvers::Picture& picture, uint32_t paths, float photons) const;
  void account(const RoundFigures& round);  ///< adds a complete round to the totals
  void read_standing(transport::Wavefront& wavefront,
                     bool on);  ///< lookups of all paths read the standing photons
  const PhotonMap& shown_map() const { return reads_standing_ ? *standing_ : map_; }  ///< the map in use
  /// Changes when other photons, or photons seen from elsewhere, are shown.
  uint64_t shown_version() const { return begun_ << 32 | shown_map().round(); }
  PhotonReport state(const solvers::Picture& picture) const;
  static RadiusLaw radius_law(const OptionValues& settings);
  Round round_of(const solvers::Picture& picture, uint32_t sample) const;
  void begin_aim(const solvers::Picture& picture, solvers::Invalidation invalidated);
  bool may_hide(const solvers::Picture& picture) const;
  /// Frame of a pilot's eye paths: the same view with fewer pixels.
  static shared::Frame small_frame(const solvers::Picture& picture);
  /// Automatic number of light paths in a round.
  static uint32_t paths_of_round(const solvers::Picture& picture);
  shared::PhotonFrame lookup_of(const solvers::Picture& picture, const shared::Frame& frame,
                                double radius_pixels) const;

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Defines scene_defines_;
  paths::LookupRoutes routes_;            ///< of all own components
  uint32_t delegable_;                    ///< components; SolverType::delegable_components
  uint32_t delegated_ = 0;                ///< components delegated in the whole picture
  paths::LookupRoutes here_routes_;       ///< without the delegated components
  paths::LookupRoutes delegated_routes_;  ///< ... and without the delegable ones
  /// Lookups of delegated components, restricted to light that eye paths cannot find: points, spots and
  /// directional lights behind smooth mirrors and glass (k_photon_unreachable).
  paths::LookupRoutes unreachable_here_, unreachable_delegated_;
  bool unreachable_found_ = false;  ///< the pilot has found such light
  uint32_t parts_;                  ///< parts of light in the scene: no caustics if nothing focuses light
  bool sends_;                      ///< traces photons; false: they could contribute nothing
  PhotonMap map_;
  // Standing photons, for lookups behind a diffuse surface: a separate map with a wider radius, kept while
  // light and surfaces stay. Read by records' rays before the first round, if the cache computes secondary
  // and this solver tertiary light, and by gathering paths through the irradiance map.
  bool feeds_;                         ///< records read them
  std::optional<PhotonMap> standing_;  ///< made at the first use
  std::optional<IrradianceMap> irradiance_;
  uint32_t irradiance_round_ = 0;  ///< round of standing_ that it was made from
  bool gathers_alone_ = false;     ///< no other lookups of this solver exist, and no rounds
  bool reads_standing_ = false;    ///< all lookups read them
  bool standing_served_ = false;   ///< in this picture
  PointsView view_;
  overlay::LightPathsPainter paths_view_;
  PhotonInspector inspector_;
  std::optional<vec2> looked_at_;
  std::optional<Inspected> inspected_;
  DensityScale density_;  ///< of the drawn view
  SurfaceIndex surfaces_;
  transport::LightSource lights_;
  transport::LightGroups light_groups_;

  // Aimed emission (aim.cpp). Pilots: casters are found; eye paths record lookups; light paths from distant
  // lights find entrances; light paths from all lights measure the contributions of pairs of light and box.
  enum class AimStep { casters, importance, first_hits, contribution };
  /// One work item of a pilot; false if cancelled: it will be repeated.
  bool note_importance(transport::Wavefront& wavefront, const solvers::Picture& picture,
                       const solvers::Cancel& cancel);
  bool note_first_hits(transport::Wavefront& wavefront, const solvers::Picture& picture,
                       const solvers::Cancel& cancel);
  void begin_sharing(const solvers::Picture& picture);  ///< call when all boxes are known
  /// True if standing photons are missing, whose radius depends on the density.
  bool needs_density() const { return standing_ && !standing_->complete(); }
  bool share_out(transport::Wavefront& wavefront, const solvers::Picture& picture,
                 const solvers::Cancel& cancel);
  /// Chooses the regions whose caustics are delegated to paths, from the pilot; `gain` as in EfficiencyPilot.
  void choose_delegated_regions(const solvers::Picture& picture,
                                std::span<const shared::PhotonContribution> photons,
                                std::span<const double> gain, uint32_t pilot_paths);
  void write_delegated_regions();

  // Choice between photons and paths for secondary and tertiary light (try_ways.cpp): each combination is
  // tried on a small picture.
  void begin_trials(const solvers::Picture& picture, bool stale);
  /// One work item. False if cancelled: it will be repeated.
  bool try_ways(transport::Wavefront& wavefront, const solvers::Picture& picture,
                const solvers::Cancel& cancel);
  /// Delegates these components (of Task::own) to paths in the whole picture.
  void delegate(const solvers::Picture& picture, uint32_t components);
  bool tries_ = false;  ///< there is a choice
  bool tried_ = false;  ///< it is made for this picture
  std::vector<Trial> trials_;
  std::unique_ptr<film::Film> trial_film_;

  bool aims_ = false;           ///< there may be boxes to aim at
  bool bundles_ = false;        ///< ... casters, and light that they focus
  bool enters_ = false;         ///< ... entrances of distant light
  bool shares_lights_ = false;  ///< paths are distributed to lights by contribution
  bool hides_ = false;          ///< there may be light that no eye path finds
  bool spares_ = false;         ///< photons without lookups nearby are not stored
  bool weighs_ = false;         ///< caustics may be delegated by efficiency
  Regions regions_;             ///< empty: photons everywhere
  gpu::Buffer delegated_regions_;
  bool aimed_ = false;  ///< importance and shares belong to this picture
  AimStep aim_step_ = AimStep::casters;
  std::vector<Box> casters_;
  bool casters_known_ = false;
  std::vector<Box> boxes_;          ///< aimed boxes: casters, then entrances
  std::vector<Box> reached_boxes_;  ///< around the places where eye paths continue behind lookups
  std::vector<transport::FirstHit> first_hits_;  ///< useful ones in the pilot's rounds so far
  uint32_t first_hit_rounds_ = 0;
  /// Photons per path and square metre at typical lookups; 0: not measured yet.
  double density_at_lookups_ = 0;
  std::optional<schedule::UniformSchedule> eye_schedule_;
  std::vector<overlay::AimedPair> pairs_;  ///< with their shares
  shared::Frame aimed_for_{};

  bool lit_ = false;          ///< lights_ are up to date
  uint32_t last_sample_ = 0;  ///< sample of the latest complete round of this picture
  uint64_t begun_ = 0;        ///< number of pictures begun
  bool fresh_ = true;         ///< no round of this picture exists
  uint64_t rounds_ = 0, paths_ = 0, photons_ = 0, escaped_ = 0, dark_ = 0;  ///< of this picture
  uint64_t spared_ = 0;
  double trace_s_ = 0, build_s_ = 0;
};

}  // namespace lucerna::photons
