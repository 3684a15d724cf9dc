#pragma once
// Interface of solvers: they compute components of the light. Path tracing needs none: it is the wavefront
// itself. Other solvers prepare data (records, photons), which kernels then read at path vertices, and draw
// overlays of it. A solver is made for a task; what it offers besides Solver is in capabilities.h. All calls
// come from one thread, that of session/renderer.h.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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

/// What a frame of paths depends on besides their lookups.
struct FrameSource {
  const paths::Automaton& automaton;
  const OptionValues& settings;
  const upload::FlatScene& flat;
  const scene::Camera& camera;
  uint32_t width = 0, height = 0;
};

/// The frame of paths that look light up by these routes and compute the `enabled` components.
shared::Frame path_frame(const FrameSource& source, const Routing& routing, uint32_t enabled);

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
  /// For begin(): world-space boxes that objects have left or entered since the last begin().
  std::vector<Box> moved{};
  /// path_frame() of the solver's own paths from the same camera.
  shared::Frame frame_for(const Routing& routing, uint32_t enabled) const {
    return path_frame({task.automaton, task.settings, flat, camera, width, height}, routing, enabled);
  }
};

using Cancel = std::function<bool()>;

/// What every solver has. All else is optional: see capabilities.h.
class Solver {
 public:
  virtual ~Solver() = default;
  virtual const SolverInfo& info() const = 0;
  /// True if the solver, made for another task, and kernels that call its hook can be used for this one. It
  /// then continues with its work, also in another engine of the same scene; else a new solver is made. Its
  /// own settings that restart the picture are unchanged (they are read when it is made).
  virtual bool serves(const Task& task) const = 0;
  /// Starts a new picture. `invalidated`: which of the solver's data has become invalid since the last one.
  virtual void begin(const Picture& picture, Invalidation invalidated) = 0;
  /// Report on what Views::draw() last showed. `sampled`: every pixel has a sample.
  virtual std::shared_ptr<const Report> report(const overlay::Canvas& canvas, const Picture& picture,
                                               bool sampled) = 0;
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
