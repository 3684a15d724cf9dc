#pragma once
// One edit of a renderer's setup: everything new is built first, then committed without an error.
#include <memory>
#include <optional>
#include <utility>

#include "session/setup.h"

namespace lucerna::session {

/// What setups are built with; must outlive them.
struct SetupContext {
  gpu::Device& device;
  gpu::ShaderCompiler& compiler;
  const paths::Automaton& automaton;
  gpu::Defines defines;      ///< additional #defines of the transport kernels
  bool interactive = false;  ///< in the window
};

/// Call make_world() or edit_world(), then build(), then commit(). Each throws Error (settings, memory,
/// kernels that do not compile, two solvers for one component), except commit(). Without commit(), the
/// destructor leaves the setup as it was. Until then the setup must not be used elsewhere.
class Transaction {
 public:
  /// The setup's values after the edit.
  struct Target {
    std::shared_ptr<const scene::Scene> scene;
    plan::Settings settings;
    scene::Camera camera;
    uint32_t width = 0, height = 0;  ///< of the picture

    /// Values of an unedited setup.
    explicit Target(const Setup& now)
        : scene(now.world.scene),
          settings(now.settings),
          camera(now.camera),
          width(now.width),
          height(now.height) {}
  };

  /// `plan`: of the target. Derives the relighting. Throws Error located at the setting.
  Transaction(const SetupContext& context, Setup& setup, Target target, plan::Plan plan);
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  const Target& target() const { return target_; }
  const Relight& relight() const { return relight_; }
  /// True if the mix applied to the traced lights differs.
  bool relit() const { return relight_.baked != setup_.relight.baked; }

  /// Flattens and uploads the target's scene. Throws Error also: too large, cancelled.
  void make_world(const Progress& progress);
  /// Changes lights and environment of the current world, if they or their separation differ. `factors`:
  /// material factors differ too.
  void edit_world(bool factors = false);
  /// Makes the engine and the films where the current ones cannot be used. `changes`: determine which solver
  /// data a new engine may use. `new_engine`: makes an engine in any case.
  void build(const scene::Changes& changes, bool new_engine = false);
  /// Results of build().
  bool has_engine() const { return engine_ != nullptr; }
  bool has_films() const { return film_ != nullptr; }

  void commit() noexcept;

 private:
  Relight make_relight() const;
  upload::LightSeparation separation() const;
  void build_films();
  void build_engine(const scene::Changes& changes);
  const World& world() const { return world_ ? *world_ : setup_.world; }

  const SetupContext& context_;
  Setup& setup_;
  Target target_;
  plan::Plan plan_;
  Relight relight_;
  uint32_t layers_ = 0;            ///< number of film.layers
  std::optional<World> world_;     ///< by make_world() ...
  std::optional<WorldEdit> edit_;  ///< ... or edit_world()
  std::unique_ptr<Engine> engine_;
  KeptSolvers kept_;  ///< with a new engine
  std::unique_ptr<film::Film> film_, coarse_;
};

}  // namespace lucerna::session
