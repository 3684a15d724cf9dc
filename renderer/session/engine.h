#pragma once
// The wavefront's kernels with the solvers of a plan, for one world.
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "film/developer.h"
#include "film/estimator.h"
#include "paths/layers.h"
#include "plan/plan.h"
#include "session/frame.h"
#include "session/layer_status.h"
#include "session/world.h"
#include "solvers/capabilities.h"

namespace lucerna::session {

/// Task of one solver of the plan. Everything it refers to must outlive it.
solvers::Task task_of(const paths::Automaton& automaton, const plan::Plan& plan,
                      const solvers::SolverInfo& solver, const plan::Settings& settings,
                      const upload::Effects& effects);

/// Conditions for which a solver is made, besides its task and its own settings.
struct MadeFor {
  gpu::Defines scene_defines;
  uint32_t slots = 0;              ///< of the wavefront
  upload::LightSeparation lights;  ///< as the picture begun last has them
  bool operator==(const MadeFor&) const = default;
};

/// A solver of an earlier engine, with its work.
struct Predecessor {
  std::shared_ptr<solvers::Solver> solver;
  MadeFor made_for;
  scene::Changes since;  ///< its last picture
  bool kept = false;     ///< it was unused meanwhile: `since` contains all changes
};

class Engine {
 public:
  /// `before`: an engine whose film kernels are reused, which depend on neither scene nor plan; null: they
  /// are compiled. `same_lights`: what it has learned of lights holds in this world, too. `predecessors`: the
  /// first of each kind that serves the task is used with its work (working_on); if none does, a new solver
  /// adopts the work of the first one that is valid in part. No predecessor changes before begin(). Throws
  /// Error: kernels that do not compile (located), memory, a component that two solvers would compute.
  Engine(gpu::Device& device, gpu::ShaderCompiler& compiler, const paths::Automaton& automaton,
         const World& world, const plan::Plan& plan, const plan::Settings& settings, gpu::Defines defines,
         const Engine* before, bool same_lights, std::span<const Predecessor> predecessors);

  /// True if kernels and solvers can be reused for another plan and these settings of the same world.
  bool serves(const plan::Plan& plan, const plan::Settings& settings, const World& world) const;
  /// Switches to a plan that it serves.
  void set_plan(plan::Plan plan) { plan_ = std::move(plan); }
  const plan::Plan& plan() const { return plan_; }
  /// Components (bits) that are computed: those of the plan that the scene can have.
  uint32_t enabled() const;
  /// True if a solver of this engine took over the predecessor's work when the engine was made.
  bool took_up(const solvers::Solver& predecessor) const;
  const MadeFor& made_for() const { return made_for_; }
  /// Settings of the picture begun last.
  const std::map<std::string, std::string>& begun_settings() const { return begun_settings_; }
  /// Starts a new picture: sets the wavefront's frame and informs the solvers. `light_factors`:
  /// solvers::Picture::light_factors.
  void begin(const PictureView& picture, const scene::Changes& changes,
             const std::optional<std::vector<vec3>>& light_factors = {});

  film::Developer& developer() { return *developer_; }
  film::ErrorEstimator& estimator() { return *estimator_; }
  transport::Wavefront& wavefront() { return *wavefront_; }
  const transport::Wavefront& wavefront() const { return *wavefront_; }
  const std::vector<std::shared_ptr<solvers::Solver>>& solvers() const { return solvers_; }
  /// Null if it is not active.
  solvers::Solver* find(std::string_view name) const;
  /// The next solver that is not ready; null: all are.
  solvers::Solver* unready() const;
  /// True if a solver works in rounds, one for each sample.
  bool in_rounds() const;
  /// The first solver whose round for that sample is not ready; null: all are.
  solvers::Solver* unready_for(uint32_t sample) const;
  /// The first solver with pending lookup errors (LookupErrors); null: all estimates are complete.
  solvers::Solver* owing_errors(const film::Film& film) const;
  /// The solver that is refining, or can refine, its data (Refinement); null: none.
  solvers::Solver* refining() const;
  solvers::Solver* refinable() const;
  /// One work item of preparation of a solver that is not ready (Preparation). False if cancelled.
  bool prepare(solvers::Solver& solver, const PictureView& picture, const std::function<bool()>& cancel);
  bool waits() const;
  /// True if another generation of learned lights must be recorded before the picture, with that many samples
  /// a pixel, continues. The first sample does not wait for it. Generations come after fixed sample counts,
  /// whatever is computed how, so that components whose computation is unchanged stay bit-identical.
  bool learns(uint32_t samples) const;
  /// Discards what was learned from another view and used for preview samples; the picture must not depend on
  /// former views.
  void begin_samples(const PictureView& picture);
  /// Records that generation. False if cancelled.
  bool learn(const PictureView& picture, const std::function<bool()>& cancel);

  /// Frame of the picture's paths, in another size.
  shared::Frame frame(const PictureView& picture, uint32_t width, uint32_t height) const;
  /// ... of a preview sample's: light that solvers have not prepared yet (Preparation::missing) is traced.
  shared::Frame draft_frame(const PictureView& picture, uint32_t width, uint32_t height) const;
  /// Calls f(picture) with the solver's task.
  template <class F>
  decltype(auto) with(const solvers::Solver& solver, const PictureView& view, F&& f) const {
    const solvers::Task task =
        task_of(automaton_, plan_, solver.info(), view.settings, view.world.flat.effects);
    return f(solvers::Picture{.task = task,
                              .flat = view.world.flat,
                              .camera = view.camera,
                              .width = view.width,
                              .height = view.height,
                              .frame = frame(view, view.width, view.height)});
  }
  /// Layers by path expressions (film.layers) of the picture begun last.
  const paths::LayerSet& layers() const { return layers_; }
  /// By layer: components (bits) of whose light it has an unknown part (LayerSet::Routed).
  const std::vector<uint32_t>& layers_unknown() const { return layers_unknown_; }
  /// True if lookups provide direct light.
  bool looks_up_direct_light() const;
  double compile_seconds() const { return compile_seconds_; }
  /// #defines of the wavefront's kernels for vertices, with those of the solvers' hooks.
  const gpu::Defines& path_defines() const { return path_defines_; }
  /// #defines of the wavefront's kernels, for other kernels that work on its paths.
  const gpu::Defines& defines() const { return made_for_.scene_defines; }

 private:
  /// The first predecessor that can continue as it is: made for the same scene, lights and own settings, and
  /// serving the task. Null: none.
  const Predecessor* working_on(const solvers::SolverInfo& info, const solvers::Task& task,
                                std::span<const Predecessor> predecessors) const;
  void take_up(std::span<const Predecessor> predecessors);
  /// Merged routing of all solvers. Throws Error, located at the component, if two compute the same light.
  solvers::Routing routing(const plan::Plan& plan, const plan::Settings& settings,
                           const upload::Effects& effects) const;
  PathRoutes routes_of(const plan::Plan& here, const plan::Settings& settings,
                       const upload::Effects& effects) const;
  void set_layers(const PictureView& picture);
  /// Frame of paths in another picture with other samples, for all components alike, however the plan
  /// computes them.
  shared::Frame pilot_frame(const PictureView& picture, uint32_t width, uint32_t height) const;
  /// For the present plan without components delegated everywhere (Preparation::delegated_components).
  void route(const plan::Settings& settings, const upload::Effects& effects);

  const paths::Automaton& automaton_;
  plan::Plan plan_;
  bool only_diffuse_ = false;  ///< upload::Effects::only_diffuse() of the scene
  gpu::Defines learned_defines_, path_defines_;
  bool begun_ = false;
  bool learned_elsewhere_ = false;  ///< from another view
  PathRoutes routes_;               ///< of the current picture
  paths::LayerSet layers_;
  std::vector<uint32_t> layers_unknown_;
  std::vector<std::shared_ptr<solvers::Solver>> solvers_;
  MadeFor made_for_;
  std::map<std::string, std::string> begun_settings_;
  std::set<const solvers::Solver*> taken_up_;  ///< of the predecessors
  /// Changes that solvers with kept work have missed since their last picture.
  std::map<const solvers::Solver*, scene::Changes> missed_;
  std::unique_ptr<transport::Wavefront> wavefront_;
  std::shared_ptr<film::Developer> developer_;
  std::shared_ptr<film::ErrorEstimator> estimator_;
  double compile_seconds_ = 0;
};

/// Largest upload::FlatScene::sun_threshold that the plan's solvers require.
float wanted_sun_threshold(const paths::Automaton& automaton, const plan::Plan& plan,
                           const plan::Settings& settings);

}  // namespace lucerna::session
