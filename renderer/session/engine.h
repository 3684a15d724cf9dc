#pragma once
// The wavefront's kernels with the solvers of a plan, made for one world.
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "film/developer.h"
#include "film/estimator.h"
#include "plan/plan.h"
#include "session/world.h"
#include "solvers/solver.h"

namespace lucerna::session {

/// A picture of a world, to be handed to solvers; everything that it names must outlive it.
struct PictureView {
  const paths::Automaton& automaton;
  const plan::Settings& settings;
  const World& world;
  const scene::Camera& camera;
  uint32_t width = 0, height = 0;
  std::vector<vec3> mix = {};  ///< of groups of lights, where they are kept apart (film::Film::set_mix)
};

/// What a solver of the plan is to do. All but the numbers must outlive it.
solvers::Task task_of(const paths::Automaton& automaton, const plan::Plan& plan,
                      const solvers::SolverInfo& solver, const plan::Settings& settings,
                      const upload::Effects& effects);

/// What a solver is made for besides its task and its own settings.
struct MadeFor {
  gpu::Defines scene_defines;
  uint32_t slots = 0;          ///< of the wavefront
  upload::LightSeparation lights;  ///< as the picture begun last has them
  bool operator==(const MadeFor&) const = default;
};

/// A solver of an earlier engine, with its work.
struct Predecessor {
  std::shared_ptr<solvers::Solver> solver;
  MadeFor made_for;
  scene::Changes since;  ///< its last picture
  bool kept = false;     ///< it has been out of use meanwhile: `since` are all changes
};

class Engine {
 public:
  /// `before`: one whose film kernels, which know neither scene nor plan, serve on; null: they are compiled.
  /// `predecessors`: of each kind the first that serves the task works on as it is (working_on); if none
  /// does, a new solver is made, which adopts the work of the first whose work holds in part. No predecessor
  /// changes before begin(). Throws Error: kernels that do not compile (located), no memory, a component's
  /// light that two solvers would bring.
  Engine(gpu::Device& device, gpu::ShaderCompiler& compiler, const paths::Automaton& automaton,
         const World& world, const plan::Plan& plan, const plan::Settings& settings, gpu::Defines defines,
         const Engine* before, std::span<const Predecessor> predecessors);

  /// Whether kernels and solvers do for another plan and these settings of the same world.
  bool serves(const plan::Plan& plan, const plan::Settings& settings, const World& world) const;
  /// For another plan that it serves.
  void set_plan(const plan::Plan& plan) { plan_ = plan; }
  const plan::Plan& plan() const { return plan_; }
  /// Whether one of this engine's solvers has taken up that one's work when the engine was made.
  bool took_up(const solvers::Solver& predecessor) const;
  const MadeFor& made_for() const { return made_for_; }
  /// Of the picture begun last.
  const std::map<std::string, std::string>& begun_settings() const { return begun_settings_; }
  /// The picture begins anew: sets the wavefront's frame, and tells the solvers.
  /// `light_factors`: solvers::Picture::light_factors.
  void begin(const PictureView& picture, const scene::Changes& changes,
             const std::optional<std::vector<vec3>>& light_factors = {});

  film::Developer& developer() { return *developer_; }
  film::ErrorEstimator& estimator() { return *estimator_; }
  transport::Wavefront& wavefront() { return *wavefront_; }
  const transport::Wavefront& wavefront() const { return *wavefront_; }
  const std::vector<std::shared_ptr<solvers::Solver>>& solvers() const { return solvers_; }
  /// Null: that one is not at work.
  solvers::Solver* find(std::string_view name) const;
  /// The next that is not ready; null: all are.
  solvers::Solver* unready() const;
  /// Some solver makes what paths read anew for each sample.
  bool in_rounds() const;
  /// The first whose round for that sample is not ready; null: all are.
  solvers::Solver* unready_for(uint32_t sample) const;
  /// The first that owes the film errors of lookups (Solver::owes_errors); null: all that is told of them is
  /// known.
  solvers::Solver* owing_errors(const film::Film& film) const;
  /// The one at work at refining what paths read (Solver::refine), or that can be; null: none.
  solvers::Solver* refining() const;
  solvers::Solver* refinable() const;
  /// A piece of preparation of one that is not ready (Solver::prepare). False when it was cancelled.
  bool prepare(solvers::Solver& solver, const PictureView& picture, const std::function<bool()>& cancel);
  bool waits() const;
  /// Another generation of light samples is to be learned from before the picture, that has so many samples
  /// a pixel, goes on. Its first sample does not wait for that; and whatever is computed how, it is learned
  /// after the same samples, so that components that are computed as before stay as they were.
  bool learns(uint32_t samples) const;
  /// What was learned from another view served until now, for drafts; the picture is to be the same whatever
  /// was looked at before.
  void begin_samples(const PictureView& picture);
  /// That generation. False when it was cancelled.
  bool learn(const PictureView& picture, const std::function<bool()>& cancel);

  /// Frame of the picture's paths, in a size of its own.
  shared::Frame frame(const PictureView& picture, uint32_t width, uint32_t height) const;
  /// ... of a draft's: what solvers have not prepared yet (Solver::missing) is traced.
  shared::Frame draft_frame(const PictureView& picture, uint32_t width, uint32_t height) const;
  /// Calls f(picture) with the solver's own task.
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
  /// Whether a component's light is looked up besides its solver's own.
  bool looked_up_besides(size_t component) const;
  double compile_seconds() const { return compile_seconds_; }
  /// That the wavefront's kernels were made with, for others that work on its paths.
  const gpu::Defines& defines() const { return made_for_.scene_defines; }

 private:
  /// The first of the predecessors that can work on as it is: made for the same scene and lights, serving the
  /// task, and with the same settings of its own. Null: none.
  const Predecessor* working_on(const solvers::SolverInfo& info, const solvers::Task& task,
                                std::span<const Predecessor> predecessors) const;
  void take_up(std::span<const Predecessor> predecessors);
  /// Of all solvers together. Throws Error, located at the component, where two of them
  /// bring the same light.
  solvers::Routing routing(const plan::Plan& plan, const plan::Settings& settings,
                           const upload::Effects& effects) const;
  struct Routes {
    solvers::Routing here;
    std::optional<solvers::Routing>
        delegated;  ///< ... where solvers leave light to paths (SolverType::delegable_components)
  };
  Routes routes_of(const plan::Plan& here, const plan::Settings& settings,
                   const upload::Effects& effects) const;
  shared::Frame frame_of(const Routes& routes, const PictureView& picture, uint32_t width,
                         uint32_t height) const;
  /// Of paths that record light samples, of all components alike: what is learned does not hang on what is
  /// computed how.
  shared::Frame pilot_frame(const PictureView& picture, uint32_t width, uint32_t height) const;
  /// For the present plan less what solvers leave to paths everywhere (Solver::left).
  void route(const plan::Settings& settings, const upload::Effects& effects);

  const paths::Automaton& automaton_;
  plan::Plan plan_;
  gpu::Defines learned_defines_;
  bool begun_ = false;
  bool learned_elsewhere_ = false;  ///< from another view
  Routes routes_;                   ///< of the picture begun last
  std::vector<std::shared_ptr<solvers::Solver>> solvers_;
  MadeFor made_for_;
  std::map<std::string, std::string> begun_settings_;
  std::set<const solvers::Solver*> taken_up_;  ///< of the predecessors
  /// Of solvers with work that was kept: all changes since its last picture.
  std::map<const solvers::Solver*, scene::Changes> missed_;
  std::unique_ptr<transport::Wavefront> wavefront_;
  std::shared_ptr<film::Developer> developer_;
  std::shared_ptr<film::ErrorEstimator> estimator_;
  double compile_seconds_ = 0;
};

/// upload::FlatScene::sun_threshold that the plan's solvers ask for.
float wanted_sun_threshold(const paths::Automaton& automaton, const plan::Plan& plan,
                           const plan::Settings& settings);

}  // namespace lucerna::session
