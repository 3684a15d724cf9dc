#pragma once
// What a solver may offer besides Solver. Each is an interface that a solver implements or not; callers ask
// for it with offered<>(). session/renderer.h calls them in this order: Adoption, Solver::begin(),
// Preparation until ready(); then paths are traced, with Rounds before each sample and Refinement in between.
// Errors of lookups come with the light, or from LookupErrors.
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "film/film.h"
#include "solvers/solver.h"
#include "transport/wavefront.h"

namespace lucerna::solvers {

/// The solver as an interface that it may offer; null: it does not.
template <class Capability, class AnySolver>
auto* offered(AnySolver& solver) {
  using Wanted = std::conditional_t<std::is_const_v<AnySolver>, const Capability, Capability>;
  return dynamic_cast<Wanted*>(&solver);
}

/// Adds to the wavefront's kernels, which read the solver's data.
class Kernels {
 public:
  virtual ~Kernels() = default;
  /// #defines. LUCERNA_LOOKUP_BIAS: the hook estimates the bias of its light (VertexOut::bias), and the film
  /// sums it.
  virtual gpu::Defines defines() const { return {}; }
  /// GLSL hook called at every vertex (shaders/transport/vertex_hook.glsl); relative to shaders/, or
  /// absolute; "": none.
  virtual std::string hook() const { return ""; }
  /// Binds what the hook reads; called again after Wavefront::rebind_lookup().
  virtual void bind(gpu::Resources& resources) const = 0;
};

/// Continues with data of a solver that was made for another task or other kernels.
class Adoption {
 public:
  virtual ~Adoption() = default;
  /// Copies usable data from a solver of the same type and scene, which stays unchanged. The next begin()
  /// invalidates unusable data. Without this call all data is invalid.
  virtual void adopt(transport::Wavefront& wavefront, const Solver& before) = 0;
};

/// Reacts to settings that do not restart the picture.
class SettingsObserver {
 public:
  virtual ~SettingsObserver() = default;
  /// Called after any setting has changed. `interactive`: a user can step through preparation, so it may
  /// wait.
  virtual void on_settings_changed(const OptionValues& settings, bool interactive) = 0;
};

/// Prepares data before paths are traced.
class Preparation {
 public:
  virtual ~Preparation() = default;
  virtual bool ready() const = 0;
  /// Runs one bounded work item, cancellable between bounces; afterwards the wavefront has the picture's
  /// frame again. False if cancelled (it will be repeated), or if it waits.
  virtual bool prepare(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) = 0;
  /// Components (of Task::own) that eye paths compute more efficiently in this picture; its lookups return
  /// none of their light. May change in begin() and prepare().
  virtual uint32_t delegated_components() const { return 0; }
  /// True if preparation waits for a command.
  virtual bool waits() const { return false; }
  /// True once data for most of the picture would remain if preparation ended.
  virtual bool usable() const { return ready(); }
  /// True if a user steps through preparation, to see all of it.
  virtual bool stepped() const { return false; }
  /// Ends preparation as soon as possible. Light without data falls back to path tracing.
  virtual void finish_early() {}
  /// True if preparation takes long and all of its kernels have run once.
  virtual bool warm() const { return ready(); }
  /// For display before ready(): components (of Task::own) whose lookups find no data yet; preview samples
  /// trace them.
  virtual uint32_t missing(const Picture& picture) const {
    (void)picture;
    return 0;
  }
};

/// Whether paths can be traced.
inline bool ready(const Solver& solver) {
  const Preparation* preparation = offered<Preparation>(solver);
  return !preparation || preparation->ready();
}
/// Preparation::delegated_components(), or none.
inline uint32_t delegated_components(const Solver& solver) {
  const Preparation* preparation = offered<Preparation>(solver);
  return preparation ? preparation->delegated_components() : 0;
}

/// Refines prepared data as samples accumulate: its noise is common to all samples and does not average out.
class Refinement {
 public:
  virtual ~Refinement() = default;
  /// Number of paths already used for refinable data; 0: nothing can be refined.
  virtual uint64_t paths_refined() const = 0;
  /// Begins to refine with about `factor` > 1 times the paths in total. Requires ready(). Errors must be
  /// estimated again when it ends; while refines() no path of the picture is traced.
  virtual void begin_refining(double factor) = 0;
  virtual bool refines() const = 0;
  /// Runs one bounded work item. Requires refines(). False if cancelled.
  virtual bool refine(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) = 0;
};

/// Prepares data again for each sample of the picture, in addition to Preparation. Sample i of every pixel
/// reads round i. Work items then have one sample a pixel (schedule/).
class Rounds {
 public:
  virtual ~Rounds() = default;
  virtual bool in_rounds() const = 0;
  /// True if the paths of this sample can be traced now.
  virtual bool round_ready(uint32_t sample) const = 0;
  /// Like Preparation::prepare(), for the round of this sample, which replaces the current one.
  virtual bool prepare_round(transport::Wavefront& wavefront, const Picture& picture, uint32_t sample,
                             const Cancel& cancel) = 0;
};

/// Reads other data in preview samples: predicted light while light is prepared again, or no pilot's notes.
class PreviewLookups {
 public:
  virtual ~PreviewLookups() = default;
  /// With `on` until off: lookups of the wavefront's paths are those of preview samples.
  virtual void look_up_preview(transport::Wavefront& wavefront, bool on) = 0;
};

/// Estimates errors of lookups in separate work.
class LookupErrors {
 public:
  virtual ~LookupErrors() = default;
  /// True if the film does not have all of them, or only outdated ones.
  virtual bool owes_errors(const film::Film& film) const = 0;
  /// Runs one work item. Requires ready(). `restarted`: a new picture has begun. False if cancelled.
  virtual bool estimate_errors(transport::Wavefront& wavefront, film::Film& film, const Picture& picture,
                               bool restarted, const Cancel& cancel) = 0;
};

/// States whether the bias of its lookups is among the film's errors.
class LookupBias {
 public:
  virtual ~LookupBias() = default;
  /// False if some of the looked up light has a bias that is not estimated.
  virtual bool estimates_bias() const = 0;
};

/// Draws the overlays of SolverInfo::views.
class Views {
 public:
  virtual ~Views() = default;
  /// Sets the inspected place, 0..1 to the right and down; nullopt: none.
  virtual void look_at(std::optional<vec2> place) { (void)place; }
  /// Draws the overlays chosen in the settings over the film's picture. The stream has been submitted.
  virtual void draw(const overlay::Canvas& canvas, const Picture& picture) = 0;
};

class Statistics {
 public:
  virtual ~Statistics() = default;
  /// For --stats, as any JSON.
  virtual nlohmann::ordered_json statistics(const overlay::Canvas& canvas, const Picture& picture) = 0;
  /// By name, for benches; does not look at the picture. Positive values mean that there is data.
  virtual std::map<std::string, double> figures() const = 0;
};

/// Runs SolverInfo::commands.
class Commands {
 public:
  virtual ~Commands() = default;
  virtual void command(const std::string& name) = 0;
};

/// Identifies what saved data belongs to (Solver::save, load).
struct Provenance {
  std::string scene;                       ///< scene name for messages
  std::map<std::string, uint64_t> hashes;  ///< scene hashes: "geometry", "lights", ...
  std::string view;                        ///< unique text of camera and size
};

/// Writes and reads prepared data (SolverInfo::file).
class Persistence {
 public:
  virtual ~Persistence() = default;
  /// Writes the data (requires ready()). Throws Error located at `file` if not ready or not writable.
  virtual void save(const std::string& file, const Picture& picture, const Provenance& provenance) const = 0;
  /// Replaces the data; the picture must then begin with nothing invalidated. Throws Error located at `file`
  /// if it has another format or is of another scene; then everything stays unchanged.
  virtual void load(const std::string& file, transport::Wavefront& wavefront, const Picture& picture,
                    const Provenance& provenance) = 0;
};

}  // namespace lucerna::solvers
