#pragma once
// Photons as the renderer sees them: stochastic progressive photon mapping, a round for every sample.
#include "overlay/light_paths.h"
#include "schedule/uniform.h"
#include "solvers/photons/efficiency.h"
#include "solvers/photons/inspector.h"
#include "solvers/photons/irradiance_map.h"
#include "solvers/photons/photon_map.h"
#include "solvers/photons/points_view.h"
#include "solvers/photons/report.h"
#include "solvers/photons/surface_index.h"
#include "solvers/photons/trials.h"
#include "solvers/solver.h"
#include "transport/first_hits.h"

namespace lucerna::photons {

const solvers::SolverType& type();

/// Components (bits) of light that has met a diffuse surface before: secondary and tertiary.
inline constexpr uint32_t k_deep = 1u << 1 | 1u << 2;

class PhotonSolver final : public solvers::Solver {
 public:
  /// Throws Error as PhotonMap.
  PhotonSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, const solvers::Task& task);

  const solvers::SolverInfo& info() const override;
  gpu::Defines defines() const override;
  std::string hook() const override { return sends_ ? "photons/vertex_hook.glsl" : ""; }
  void bind(gpu::Resources& resources) const override;
  bool serves(const solvers::Task& task) const override;

  void begin(const solvers::Picture& picture, solvers::Invalidation invalidated) override;
  /// Whether it is known where lookups take place, which casters light paths are aimed at, and with which
  /// shares; where records' rays or gathering paths read standing photons, whether there are some; and
  /// whether photons are worth their time.
  bool ready() const override {
    return pilot_done() && (!stands() || standing_served_) && (!tries_ || tried_);
  }
  uint32_t delegated_components() const override { return delegated_; }
  /// Secondary and tertiary light; caustics are for photons to find.
  uint32_t missing(const solvers::Picture& picture) const override;
  /// Drafts note nothing.
  void look_up_preview(transport::Wavefront& wavefront, bool on) override;
  bool prepare(transport::Wavefront& wavefront, const solvers::Picture& picture,
               const solvers::Cancel& cancel) override;
  bool in_rounds() const override { return sends_ && (reads_rounds() || renews_standing()); }
  bool round_ready(uint32_t sample) const override;
  bool prepare_round(transport::Wavefront& wavefront, const solvers::Picture& picture, uint32_t sample,
                     const solvers::Cancel& cancel) override;

  void look_at(std::optional<vec2> place) override { looked_at_ = place; }
  void draw(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::shared_ptr<const solvers::Report> report(const overlay::Canvas& canvas,
                                                const solvers::Picture& picture, bool sampled) override;
  nlohmann::ordered_json statistics(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  void look_up_picture(const overlay::Canvas& canvas, const solvers::Picture& picture) override;
  std::map<std::string, double> figures() const override;

  /// Samples that the first map of irradiance serves; each further one serves twice as many.
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
  /// Parts of light that are stored: all of it, and with that what only rounds find of those that paths from
  /// the eye compute.
  uint32_t whole_parts() const;
  uint32_t sent_parts() const;
  bool reads_rounds() const;
  void store_parts(uint32_t sent);  ///< which of these rounds store as a whole
  /// Sets the routes below.
  void route(const solvers::Task& task);
  bool stands() const { return feeds_ || gathers(); }
  /// Paths that gather find irradiance that is known beforehand.
  bool gathers() const;
  /// Gathering paths read other photons after some samples, and then again; what records have read, stays.
  bool renews_standing() const { return gathers() && !feeds_; }
  bool standing_made(uint32_t epoch) const;
  /// One piece of making what records' rays and gathering paths read. False when it was cancelled.
  bool make_standing(transport::Wavefront& wavefront, const solvers::Picture& picture, uint32_t epoch,
                     const solvers::Cancel& cancel);
  /// ... before the first sample, and of binding it.
  bool prepare_standing(transport::Wavefront& wavefront, const solvers::Picture& picture,
                        const solvers::Cancel& cancel);
  /// Within which a typical lookup finds so many photons of so many paths.
  float standing_radius(const solvers::Picture& picture, uint32_t paths, float photons) const;
  void account(const RoundFigures& round);                       ///< one that is complete
  void read_standing(transport::Wavefront& wavefront, bool on);  ///< lookups of all paths do
  const PhotonMap& shown_map() const { return reads_standing_ ? *standing_ : map_; }  ///< that is bound
  /// Another one whenever other photons are shown, or from elsewhere.
  uint64_t shown_version() const { return begun_ << 32 | shown_map().round(); }
  PhotonReport state(const solvers::Picture& picture) const;
  static RadiusLaw radius_law(const OptionValues& settings);
  Round round_of(const solvers::Picture& picture, uint32_t sample) const;
  void begin_aim(const solvers::Picture& picture, solvers::Invalidation invalidated);
  bool may_hide(const solvers::Picture& picture) const;
  /// The frame of a pilot's eye paths: the same view with fewer pixels.
  static shared::Frame small_frame(const solvers::Picture& picture);
  /// Light paths of a round, where none is asked for.
  static uint32_t paths_of_round(const solvers::Picture& picture);
  shared::PhotonFrame lookup_of(const solvers::Picture& picture, const shared::Frame& frame,
                                double radius_pixels) const;

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Defines scene_defines_;
  paths::LookupRoutes routes_;            ///< of all that is ours
  uint32_t delegable_;                    ///< components; SolverType::delegable_components
  uint32_t delegated_ = 0;                ///< ... that are left everywhere
  paths::LookupRoutes here_routes_;       ///< without these
  paths::LookupRoutes delegated_routes_;  ///< ... where those are left as well
  /// Where light of components that are left to paths is looked up as far as these cannot find it: points,
  /// spots and directional lights by way of smooth mirrors and glass (k_photon_unreachable).
  paths::LookupRoutes unreachable_here_, unreachable_delegated_;
  bool unreachable_found_ = false;  ///< the pilot has met such light
  uint32_t parts_;                  ///< of light that the scene has: without caustics where nothing focuses
  bool sends_;                      ///< photons; else there is nothing that they could bring
  PhotonMap map_;
  // What is looked up behind a diffuse surface: photons of their own, everywhere and within a wider radius,
  // as long as light and surfaces stay the same. Records that are made before there is any round read them,
  // where secondary light is theirs and tertiary light ours, and paths that gather, by way of irradiance that
  // is known beforehand.
  bool feeds_;                         ///< there are records that read them
  std::optional<PhotonMap> standing_;  ///< made when it is called for
  std::optional<IrradianceMap> irradiance_;
  uint32_t irradiance_round_ = 0;  ///< of standing_, from which it was made
  bool gathers_alone_ = false;     ///< nothing of ours is looked up elsewhere, and there are no other rounds
  bool reads_standing_ = false;    ///< all lookups do
  bool standing_served_ = false;   ///< in this picture
  PointsView view_;
  overlay::LightPathsPainter paths_view_;
  PhotonInspector inspector_;
  std::optional<vec2> looked_at_;
  std::optional<Inspected> inspected_;
  DensityScale density_;  ///< that is drawn
  SurfaceIndex surfaces_;
  transport::LightSource lights_;
  transport::LightGroups light_groups_;

  // Aimed emission (aim.cpp): casters are found, then a few paths from the eye note where lookups take place,
  // then a few from lights far away where those that come to be of use arrive first, then a few from all
  // lights which pairs of light and box bring something.
  enum class AimStep { casters, importance, first_hits, contribution };
  /// One piece of each; false: it was cancelled, and will be done again.
  bool note_importance(transport::Wavefront& wavefront, const solvers::Picture& picture,
                       const solvers::Cancel& cancel);
  bool note_first_hits(transport::Wavefront& wavefront, const solvers::Picture& picture,
                       const solvers::Cancel& cancel);
  void begin_sharing(const solvers::Picture& picture);  ///< all boxes are known
  /// Whether standing photons are to be made, whose radius hangs on it.
  bool needs_density() const { return standing_ && !standing_->complete(); }
  bool share_out(transport::Wavefront& wavefront, const solvers::Picture& picture,
                 const solvers::Cancel& cancel);
  /// Where caustics are left to paths from the eye, by what the pilot has told; `gain` as EfficiencyPilot's.
  void choose_delegated_regions(const solvers::Picture& picture,
                                std::span<const shared::PhotonContribution> photons,
                                std::span<const double> gain, uint32_t pilot_paths);
  void write_delegated_regions();

  // Who brings secondary and tertiary light of the whole picture (try_ways.cpp): each way is tried on a small
  // one.
  void begin_trials(const solvers::Picture& picture, bool stale);
  /// One piece. False: it was cancelled, and will be done again.
  bool try_ways(transport::Wavefront& wavefront, const solvers::Picture& picture,
                const solvers::Cancel& cancel);
  /// Which components (of Task::own) are left to paths from the eye everywhere, from now on.
  void delegate(const solvers::Picture& picture, uint32_t components);
  bool tries_ = false;  ///< there is something to choose
  bool tried_ = false;  ///< it is chosen for this picture
  std::vector<Trial> trials_;
  std::unique_ptr<film::Film> trial_film_;

  bool aims_ = false;           ///< there may be something to aim at
  bool bundles_ = false;        ///< ... casters, and there is light that they bundle
  bool enters_ = false;         ///< ... openings that light from afar comes through
  bool shares_lights_ = false;  ///< among which paths are shared by what they bring
  bool hides_ = false;          ///< there may be light that no path from the eye finds
  bool spares_ = false;         ///< photons that nobody looks at
  bool weighs_ = false;         ///< where photons are worth their time
  Regions regions_;             ///< none: photons everywhere
  gpu::Buffer delegated_regions_;
  bool aimed_ = false;  ///< importance and shares are those of this picture
  AimStep aim_step_ = AimStep::casters;
  std::vector<Box> casters_;
  bool casters_known_ = false;
  std::vector<Box> boxes_;  ///< that paths are aimed at: of the casters, then those where light gets in
  std::vector<Box> reached_boxes_;               ///< around where paths from the eye go on behind lookups
  std::vector<transport::FirstHit> first_hits_;  ///< of use, in the pilot's rounds so far
  uint32_t first_hit_rounds_ = 0;
  /// Photons that a path leaves on a square metre where lookups typically take place; 0: not known.
  double density_at_lookups_ = 0;
  std::optional<schedule::UniformSchedule> eye_schedule_;
  std::vector<overlay::AimedPair> pairs_;  ///< with their shares
  shared::Frame aimed_for_{};

  bool lit_ = false;          ///< lights_ are the scene's
  uint32_t last_sample_ = 0;  ///< whose round is complete, in this picture
  uint64_t begun_ = 0;        ///< pictures
  bool fresh_ = true;         ///< no round of this picture is
  uint64_t rounds_ = 0, paths_ = 0, photons_ = 0, escaped_ = 0, dark_ = 0;  ///< of this picture
  uint64_t spared_ = 0;
  double trace_s_ = 0, build_s_ = 0;
};

}  // namespace lucerna::photons
