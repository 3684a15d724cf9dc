#pragma once
// Interface of solvers: they compute components of the light. Path tracing needs none: it is the wavefront
// itself. Other solvers prepare data (records, photons), which kernels then read at path vertices, and draw
// overlays of it.
//
// session/renderer.h calls these functions in this order. A solver is made for a task. adopt() may pass it
// the data of its predecessor. begin() starts a picture and states which data is invalid. prepare() is called
// until ready(). Then paths are traced; for a solver that works in rounds, prepare_round() runs before each
// sample of the picture. Lookup errors come with the light, or from estimate_errors(). All calls come from
// one thread.
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "overlay/canvas.h"
#include "paths/automaton.h"
#include "scene/scene.h"
#include "solvers/info.h"
#include "solvers/report.h"
#include "transport/frame.h"
#include "transport/wavefront.h"
#include "upload/flatten.h"

namespace lucerna::solvers {

/// What a solver computes, and its settings. Components as bits.
struct Task {
  const paths::Automaton& automaton;
  const OptionValues& settings;
  uint32_t enabled = 0;  ///< components that are computed by any solver
  uint32_t own = 0;      ///< components that this solver computes
  uint32_t directly_visible_by_other =
      0;                  ///< part of `own` whose directly visible light another solver computes
  uint32_t provided = 0;  ///< components of other solvers that provide lookups (SolverInfo::provides_lookups)
  uint32_t consuming = 0;   ///< components of other solvers that consume lookups
  upload::Effects effects;  ///< features of the scene
  const gpu::Defines* scene_defines =
      nullptr;  ///< of kernels that read surfaces and lights; set when the solver is made
};

/// Where paths look light up: tables of the path automaton (transport/frame.h).
struct Routing {
  paths::LookupRoutes lookups;
  /// Components of paths that continue after a lookup without data; 0: no path does.
  uint32_t fallback = 0;
  /// Lookups of paths that have intentionally passed an earlier lookup (gathering).
  paths::LookupRoutes gather;
  /// Components (bits) that these lookups return on behalf of another solver, which still owns them.
  uint32_t through = 0;
};

/// The current picture. Valid during a call.
struct Picture {
  const Task& task;
  const upload::FlatScene& flat;
  const scene::Camera& camera;
  uint32_t width = 0, height = 0;
  shared::Frame frame;  ///< of the picture's paths
  /// For begin(), display only: factor on the light of each group, or on all light, since the last begin(),
  /// if known.
  std::optional<std::vector<vec3>> light_factors;
  /// A frame for the solver's own paths from the same camera, with these routes and `enabled` components.
  shared::Frame frame_for(const Routing& routing, uint32_t enabled) const;
};

/// Identifies what saved data belongs to (Solver::save, load).
struct Provenance {
  std::string scene;                       ///< scene name for messages
  std::map<std::string, uint64_t> hashes;  ///< scene hashes: "geometry", "lights", ...
  std::string view;                        ///< unique text of camera and size
};

using Cancel = std::function<bool()>;

class Solver {
 public:
  virtual ~Solver() = default;
  virtual const SolverInfo& info() const = 0;

  // Kernels that read its data.

  /// #defines of the wavefront's kernels. LUCERNA_LOOKUP_BIAS: the hook estimates the bias of its light
  /// (VertexOut::bias), and the film sums it.
  virtual gpu::Defines defines() const { return {}; }
  /// GLSL hook called at every vertex (shaders/transport/vertex_hook.glsl); relative to shaders/, or
  /// absolute; "": none.
  virtual std::string hook() const { return ""; }
  /// Binds what the hook reads; called again after Wavefront::rebind_lookup().
  virtual void bind(gpu::Resources& resources) const { (void)resources; }
  /// True if the solver, made for another task, and kernels that call its hook can be used for this one. It
  /// then continues with its work, also in another engine of the same scene; else a new solver is made. Its
  /// own settings that restart the picture are unchanged (they are read when it is made).
  virtual bool serves(const Task& task) const = 0;

  // Preparation.

  /// Copies usable data from a solver of the same type, made for another task or other kernels of the same
  /// scene, which stays unchanged. The next begin() invalidates unusable data. Without this call all data is
  /// invalid.
  virtual void adopt(transport::Wavefront& wavefront, const Solver& before) { (void)wavefront, (void)before; }
  /// Starts a new picture. `invalidated`: which of the solver's data has become invalid since the last one.
  virtual void begin(const Picture& picture, Invalidation invalidated) = 0;
  /// Called after any setting has changed, even if the picture continues. `interactive`: a user can step
  /// through preparation, so it may wait.
  virtual void on_settings_changed(const OptionValues& settings, bool interactive) {
    (void)settings, (void)interactive;
  }
  virtual bool ready() const { return true; }
  /// Components (of Task::own) that eye paths compute more efficiently in this picture; its lookups return
  /// none of their light. May change in begin() and prepare().
  virtual uint32_t delegated_components() const { return 0; }
  /// True if preparation waits for a command.
  virtual bool waits() const { return false; }
  /// Runs one bounded work item of preparation, cancellable between bounces; afterwards the wavefront has the
  /// picture's frame again. False if cancelled (it will be repeated), or if it waits.
  virtual bool prepare(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
    (void)wavefront, (void)picture, (void)cancel;
    return true;
  }

  /// Ends preparation as soon as possible. Light without data falls back to path tracing.
  virtual void finish_early() {}

  // Refinement: prepared data has noise that samples do not average out; it is refined as samples accumulate.

  /// Number of paths already used for refinable data; 0: nothing can be refined.
  virtual uint64_t paths_refined() const { return 0; }
  /// Runs one bounded work item of refinement, the first one if none is running. Requires ready(). Errors
  /// must then be estimated again. While refines() no path of the picture is traced. False if cancelled.
  virtual bool refine(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
    (void)wavefront, (void)picture, (void)cancel;
    return true;
  }
  virtual bool refines() const { return false; }

  // Rounds: data prepared again for each sample of the picture, in addition to prepare(). Sample i of every
  // pixel reads round i. Work items then have one sample a pixel (schedule/).

  virtual bool in_rounds() const { return false; }
  /// True if the paths of this sample can be traced now.
  virtual bool round_ready(uint32_t sample) const {
    (void)sample;
    return true;
  }
  /// Like prepare(), for the round of this sample, which replaces the current one.
  virtual bool prepare_round(transport::Wavefront& wavefront, const Picture& picture, uint32_t sample,
                             const Cancel& cancel) {
    (void)wavefront, (void)picture, (void)sample, (void)cancel;
    return true;
  }

  /// For display before ready(): components (of Task::own) whose lookups find no data yet; preview samples
  /// trace them.
  virtual uint32_t missing(const Picture& picture) const {
    (void)picture;
    return 0;
  }

  /// For display while light is prepared again: with `on`, lookups of the wavefront's paths read predicted
  /// light where the effect of the edit is known, otherwise prepared light.
  virtual void look_up_preview(transport::Wavefront& wavefront, bool on) { (void)wavefront, (void)on; }

  /// True if preparation takes long and all of its kernels have run once.
  virtual bool warm() const { return ready(); }
  /// True if lookup errors need separate work and the film does not have them all yet: estimate_errors()
  /// computes them, one work item a call. Requires ready(). `restarted`: a new picture has begun. False if
  /// cancelled.
  virtual bool owes_errors(const film::Film& film) const {
    (void)film;
    return false;
  }
  virtual bool estimate_errors(transport::Wavefront& wavefront, film::Film& film, const Picture& picture,
                               bool restarted, const Cancel& cancel) {
    (void)wavefront, (void)film, (void)picture, (void)restarted, (void)cancel;
    return true;
  }

  // Display and commands.

  /// Sets the inspected place, 0..1 to the right and down; nullopt: none.
  virtual void look_at(std::optional<vec2> place) { (void)place; }
  /// Draws the overlays chosen in the settings over the film's picture. The stream has been submitted.
  virtual void draw(const overlay::Canvas& canvas, const Picture& picture) { (void)canvas, (void)picture; }
  /// Report on what draw() last showed. `sampled`: every pixel has a sample.
  virtual std::shared_ptr<const Report> report(const overlay::Canvas& canvas, const Picture& picture,
                                               bool sampled) = 0;
  /// Statistics for --stats, as any JSON.
  virtual nlohmann::ordered_json statistics(const overlay::Canvas& canvas, const Picture& picture) {
    (void)canvas, (void)picture;
    return nullptr;
  }
  /// Statistics by name, for benches; does not look at the picture.
  virtual std::map<std::string, double> figures() const { return {}; }
  /// Looks light up at every sampled pixel and discards it, for timing.
  virtual void look_up_picture(const overlay::Canvas& canvas, const Picture& picture) {
    (void)canvas, (void)picture;
  }
  /// Runs one of SolverInfo::commands.
  virtual void command(const std::string& name) { (void)name; }
  /// For SolverInfo::file. save() writes the prepared data (requires ready()). load() replaces it; the
  /// picture must then begin with nothing invalidated. Throws Error located at `file` if not ready, not
  /// writable, of another format, or of another scene; then everything stays unchanged.
  virtual void save(const std::string& file, const Picture& picture, const Provenance& provenance) const {
    (void)file, (void)picture, (void)provenance;
  }
  virtual void load(const std::string& file, transport::Wavefront& wavefront, const Picture& picture,
                    const Provenance& provenance) {
    (void)file, (void)wavefront, (void)picture, (void)provenance;
  }
};

/// A solver type: description, routing and factory.
struct SolverType {
  const SolverInfo& info;
  /// Lookups for a task; null: none, all components are traced. Called before a solver is made, so that
  /// choices which count light twice are refused before memory is allocated.
  Routing (*routing)(const Task& task) = nullptr;
  /// Makes a solver; null: the wavefront is enough. Throws Error: memory, kernels.
  std::unique_ptr<Solver> (*make)(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots,
                                  const Task& task) = nullptr;
  /// Components (of Task::own) that it may delegate to eye paths in parts of the picture. Its defines() and
  /// bind() pass the regions to camera.comp (LUCERNA_DELEGATED_REGIONS, delegated_regions). Null: none.
  uint32_t (*delegable_components)(const Task& task) = nullptr;
  /// Minimum number of paths in flight.
  uint32_t least_slots = 0;
  /// Required upload::FlatScene::sun_threshold; 0 or null: none. Task::effects are not set yet.
  float (*sun_threshold)(const Task& task) = nullptr;
};

}  // namespace lucerna::solvers
