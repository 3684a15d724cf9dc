#pragma once
// The wavefront's kernels with the solvers of a plan, made for one world.
#include <map>
#include <memory>
#include <optional>
#include <utility>
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

class Engine {
 public:
  /// `before`: one whose film kernels, which know neither scene nor plan, serve on; null: they are compiled.
  /// Throws Error: kernels that do not compile (located), no memory, a component's light that two solvers
  /// would bring.
  Engine(gpu::Device& device, gpu::ShaderCompiler& compiler, const paths::Automaton& automaton,
         const World& world, const plan::Plan& plan, const plan::Settings& settings, gpu::Defines defines,
         const Engine* before);

  /// Whether kernels and solvers do for another plan and these settings of the same world.
  bool serves(const plan::Plan& plan, const plan::Settings& settings, const World& world) const;
  /// For another plan that it serves.
  void set_plan(const plan::Plan& plan) { plan_ = plan; }
  const plan::Plan& plan() const { return plan_; }
  /// Takes over what the solvers of another engine have, where `changes` do not spoil all of it.
  void adopt(const Engine& before, const scene::Changes& changes);
  /// The same of one solver, that has made no picture since these changes.
  void adopt(const solvers::Solver& before, const scene::Changes& since);
  /// For an engine that is given up: its solvers with their work.
  std::vector<std::unique_ptr<solvers::Solver>> release_solvers() { return std::exchange(solvers_, {}); }
  /// The picture begins anew: sets the wavefront's frame, and tells the solvers.
  /// `light_factors`: solvers::Picture::light_factors.
  void begin(const PictureView& picture, const scene::Changes& changes,
             const std::optional<std::vector<vec3>>& light_factors = {});

  film::Developer& developer() { return *developer_; }
  film::ErrorEstimator& estimator() { return *estimator_; }
  transport::Wavefront& wavefront() { return *wavefront_; }
  const transport::Wavefront& wavefront() const { return *wavefront_; }
  const std::vector<std::unique_ptr<solvers::Solver>>& solvers() const { return solvers_; }
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
  const gpu::Defines& defines() const { return scene_defines_; }

 private:
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
  gpu::Defines scene_defines_;  ///< that the kernels were made with
  gpu::Defines learned_defines_;
  bool begun_ = false;
  bool learned_elsewhere_ = false;  ///< from another view
  Routes routes_;                   ///< of the picture begun last
  std::vector<std::unique_ptr<solvers::Solver>> solvers_;
  /// What solvers that were adopted alone have missed before the next picture.
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
