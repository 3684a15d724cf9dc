#pragma once
// A way of computing light, at work. Path tracing alone needs none of this: the wavefront brings its light.
// Others prepare something first (records, photons), which the wavefront's kernels then read at the vertices
// of paths, and show it to a person.
//
// What calls these: session/renderer.h, in this order. A solver is made for a task with its kernels' needs
// known; adopt() may hand it what the one before it had; begin() starts a picture, and says what of the
// present work has been spoiled; prepare() is called until ready(); then paths are traced, each sample of the
// picture behind prepare_round() where a solver works in rounds, and what they read may be wrong by is told
// by estimate_errors(), or comes with their light. Everything runs on one thread.
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

/// What a solver is to do, and by which settings. Components in bits.
struct Task {
  const paths::Automaton& automaton;
  const OptionValues& settings;
  uint32_t enabled = 0;                    ///< components that anybody computes
  uint32_t own = 0;                        ///< of these, this solver
  uint32_t directly_visible_by_other = 0;  ///< of own: what the camera sees straight of it another one brings
  uint32_t provided = 0;    ///< that others compute who lend their lookups (SolverInfo::provides_lookups)
  uint32_t consuming = 0;   ///< that others compute who borrow those
  upload::Effects effects;  ///< what the scene calls for
  const gpu::Defines* scene_defines =
      nullptr;  ///< of kernels that know its surfaces and lights; when it is made
};

/// What of the paths is looked up: the tables of the automaton that paths carry (transport/frame.h).
struct Routing {
  paths::LookupRoutes lookups;
  /// Components of paths that a lookup has left alone; 0: there are no such paths.
  uint32_t fallback = 0;
  /// What is looked up later, by paths that have passed a lookup on purpose.
  paths::LookupRoutes gather;
  /// Components (bits) whose light these lookups bring by way of another solver's: it is that one's still.
  uint32_t through = 0;
};

/// The picture that is being made. Valid during a call.
struct Picture {
  const Task& task;
  const upload::FlatScene& flat;
  const scene::Camera& camera;
  uint32_t width = 0, height = 0;
  shared::Frame frame;  ///< of its paths
  /// To begin(): what the light of each group is multiplied by since the last one, or all light, where that
  /// is known; for display.
  std::optional<std::vector<vec3>> light_factors;
  /// A frame for paths of the solver's own, from the same camera: with these routes and `enabled` components.
  shared::Frame frame_for(const Routing& routing, uint32_t enabled) const;
};

/// What decides whether kept work fits a picture (Solver::save, load).
struct Provenance {
  std::string scene;                       ///< its name, for messages
  std::map<std::string, uint64_t> hashes;  ///< of the scene: "geometry", "lights", ...
  std::string view;                        ///< camera and size, as a text that only that view gives
};

using Cancel = std::function<bool()>;

class Solver {
 public:
  virtual ~Solver() = default;
  virtual const SolverInfo& info() const = 0;

  // What kernels need that read it.

  /// #defines for the wavefront's kernels. LUCERNA_LOOKUP_BIAS: the hook says by what the light that it
  /// brings is off (VertexOut::bias), and the film sums that up.
  virtual gpu::Defines defines() const { return {}; }
  /// GLSL file that is called at every vertex (shaders/transport/vertex_hook.glsl), "" for none: relative to
  /// shaders/, or absolute.
  virtual std::string hook() const { return ""; }
  /// Sets what the hook reads; called again after Wavefront::rebind_lookup().
  virtual void bind(gpu::Resources& resources) const { (void)resources; }
  /// Whether the solver, made for another task, can do this one too, and kernels that call its hook as well.
  /// If so it goes on with its work, also in another engine of the same scene; else another solver is made.
  /// Settings of its own that restart the picture are the same (they are read when it is made).
  virtual bool serves(const Task& task) const = 0;

  // Its work.

  /// Takes what another one of its kind had, made for another task or other kernels of the same scene, as far
  /// as it serves here; what does not is spoiled by the next begin(). That one stays as it is. Without this
  /// call all is.
  virtual void adopt(transport::Wavefront& wavefront, const Solver& before) { (void)wavefront, (void)before; }
  /// The picture begins anew. `spoils`: what changes since the last one leave of this solver's work.
  virtual void begin(const Picture& picture, Invalidation invalidated) = 0;
  /// After any setting has changed, whether or not the picture begins anew. `interactive`: somebody is there
  /// to lead preparation from step to step, so that it may wait.
  virtual void on_settings_changed(const OptionValues& settings, bool interactive) {
    (void)settings, (void)interactive;
  }
  virtual bool ready() const { return true; }
  /// Components (of Task::own) that it has found to be better left to paths from the eye in this picture:
  /// its lookups bring none of their light. May change in begin() and prepare().
  virtual uint32_t delegated_components() const { return 0; }
  /// Preparation waits for a command.
  virtual bool waits() const { return false; }
  /// One bounded piece of preparation, cancellable between bounces; on return the wavefront's frame is the
  /// picture's. False when it was cancelled (it will be done again), or while it waits.
  virtual bool prepare(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
    (void)wavefront, (void)picture, (void)cancel;
    return true;
  }

  /// Preparation has had the time that it may take: what can be left out is left to paths, so that it ends
  /// soon, or at once.
  virtual void finish_early() {}

  // By and by: what paths read has a noise that samples do not take away, and as they grow more it is to be
  // less.

  /// Paths that have gone into what can be refined so far; 0: nothing can.
  virtual uint64_t paths_refined() const { return 0; }
  /// Only when ready(): one bounded piece of that work, the first of it where none is under way; errors are
  /// then owed anew. While refines() no path of the picture is traced. False when it was cancelled.
  virtual bool refine(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
    (void)wavefront, (void)picture, (void)cancel;
    return true;
  }
  virtual bool refines() const { return false; }

  // In rounds: what paths read is made anew for each of the picture's samples, besides what prepare() makes.
  // Sample i of every pixel reads round i. Items are then of one sample a pixel (schedule/).

  virtual bool in_rounds() const { return false; }
  /// Whether these samples' paths can be traced now.
  virtual bool round_ready(uint32_t sample) const {
    (void)sample;
    return true;
  }
  /// As prepare(), towards that round, in place of the one that there is.
  virtual bool prepare_round(transport::Wavefront& wavefront, const Picture& picture, uint32_t sample,
                             const Cancel& cancel) {
    (void)wavefront, (void)picture, (void)sample, (void)cancel;
    return true;
  }

  /// For display, before it is ready: components (of Task::own) of whose light lookups find nothing yet, so
  /// that the window's drafts trace it.
  virtual uint32_t missing(const Picture& picture) const {
    (void)picture;
    return 0;
  }

  /// For display, while preparation makes light anew that paths have been reading: where it is known what
  /// that will be, lookups of the wavefront's paths read it from now on, or no longer; else they read what is
  /// prepared.
  virtual void look_up_preview(transport::Wavefront& wavefront, bool on) { (void)wavefront, (void)on; }

  /// Preparation is long, and all kernels that it needs have run.
  virtual bool warm() const { return ready(); }
  /// What the picture's lookups may be wrong by is told by work of its own, and the film does not know all
  /// of it: estimate_errors() goes on telling it, a piece at a time. Only when ready(). `anew`: the picture
  /// has begun. False when it was cancelled.
  virtual bool owes_errors(const film::Film& film) const {
    (void)film;
    return false;
  }
  virtual bool estimate_errors(transport::Wavefront& wavefront, film::Film& film, const Picture& picture,
                               bool restarted, const Cancel& cancel) {
    (void)wavefront, (void)film, (void)picture, (void)restarted, (void)cancel;
    return true;
  }

  // What a person sees and says.

  /// Where somebody looks in the picture, 0..1 to the right and down; nothing: nowhere.
  virtual void look_at(std::optional<vec2> place) { (void)place; }
  /// Draws over the film's picture what the settings of its views ask for. The stream is run.
  virtual void draw(const overlay::Canvas& canvas, const Picture& picture) { (void)canvas, (void)picture; }
  /// Of what draw() has shown last. `sampled`: every pixel has a sample.
  virtual std::shared_ptr<const Report> report(const overlay::Canvas& canvas, const Picture& picture,
                                               bool sampled) = 0;
  /// Figures for --stats: any JSON.
  virtual nlohmann::ordered_json statistics(const overlay::Canvas& canvas, const Picture& picture) {
    (void)canvas, (void)picture;
    return nullptr;
  }
  /// The same by name and without a look at the picture, for benches.
  virtual std::map<std::string, double> figures() const { return {}; }
  /// Looks its light up at every pixel that has samples, and forgets it: to be timed.
  virtual void look_up_picture(const overlay::Canvas& canvas, const Picture& picture) {
    (void)canvas, (void)picture;
  }
  /// One of SolverInfo::commands.
  virtual void command(const std::string& name) { (void)name; }
  /// Where SolverInfo::file: writes the work, when ready; takes it from a file in place of what there is,
  /// then the picture is to begin anew with nothing spoiled. Throw Error located at `file`: it is not ready,
  /// cannot be written, is no such file, or does not fit; then everything stays as it was.
  virtual void save(const std::string& file, const Picture& picture, const Provenance& provenance) const {
    (void)file, (void)picture, (void)provenance;
  }
  virtual void load(const std::string& file, transport::Wavefront& wavefront, const Picture& picture,
                    const Provenance& provenance) {
    (void)file, (void)wavefront, (void)picture, (void)provenance;
  }
};

/// A way of computing light: what it says of itself, what its lookups bring, and how one is made.
struct SolverType {
  const SolverInfo& info;
  /// Null: nothing is looked up, and all components are traced. Known before one is made, so that a choice of
  /// solvers that count light twice is refused before any takes memory.
  Routing (*routing)(const Task& task) = nullptr;
  /// Null: nothing but the wavefront is needed. Throws Error: memory, kernels.
  std::unique_ptr<Solver> (*make)(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots,
                                  const Task& task) = nullptr;
  /// Components (of Task::own) that it may leave to paths from the eye in parts of the picture, which its
  /// defines() and bind() tell camera.comp of (LUCERNA_DELEGATED_REGIONS, delegated_regions). Null: none.
  uint32_t (*delegable_components)(const Task& task) = nullptr;
  /// Paths in flight that it needs at least.
  uint32_t least_slots = 0;
  /// upload::FlatScene::sun_threshold that it asks for; 0 or null: none. Task::effects are not known yet.
  float (*sun_threshold)(const Task& task) = nullptr;
};

}  // namespace lucerna::solvers
