#pragma once
// Static description of a solver: plain tables without a device. Settings, help, window, scripts and renderer
// read all they need from it.
#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/options.h"
#include "scene/change.h"
#include "shaders/shared/lanes.h"
#include "solvers/prospect.h"

namespace lucerna::solvers {

/// Which part of a solver's prepared data a change invalidates.
struct Invalidation {
  bool coverage = false;  ///< data stays valid but may be incomplete: more is added
  bool light = false;     ///< positions stay valid; their light is computed again
  bool places = false;    ///< everything is computed from scratch
  Invalidation& operator|=(const Invalidation& o) {
    coverage |= o.coverage, light |= o.light, places |= o.places;
    return *this;
  }
  bool operator==(const Invalidation&) const = default;
  bool any() const { return coverage || light || places; }
};
inline constexpr Invalidation k_invalidates_nothing{};
inline constexpr Invalidation k_invalidates_coverage{.coverage = true};
inline constexpr Invalidation k_invalidates_light{.light = true};
inline constexpr Invalidation k_invalidates_light_and_coverage{.coverage = true, .light = true};
inline constexpr Invalidation k_invalidates_all{.coverage = true, .light = true, .places = true};

/// One row of a solver's change table.
struct ChangeRow {
  /// An edit, or a prefix of setting keys ("cache.rays", "film."). The longest matching prefix applies; a
  /// solver's own row precedes a default.
  std::variant<scene::Change, std::string_view> change;
  Invalidation invalidates;
  std::string_view why;
};

/// An overlay over the picture: the setting that shows it, and its place in the window.
struct ViewInfo {
  std::string option;  ///< a boolean, or a choice whose first value is "off"
  std::string label;   ///< in panel and menu: "Records"
  char shortcut = 0;   ///< key in the window, 'A' to 'Z'; 0: none
  /// For a choice: the values that the key cycles through; empty: all.
  std::vector<std::string> ring;
  bool inspects_pointer = false;          ///< while shown, a resting pointer inspects the surface below it
  std::vector<std::string> refined_by{};  ///< choices that the menu shows while the view is on
};

/// A solver command, available as SOLVER.NAME.
struct CommandInfo {
  std::string name;   ///< "step"
  std::string label;  ///< in panel and menu: "Next stage"
  std::string help;   ///< one sentence
  char shortcut = 0;
  /// A script continues when preparation waits or is complete and all commands have taken effect.
  bool until_still = false;
};

/// File format of the prepared data: commands SOLVER.save and SOLVER.load.
struct FileInfo {
  std::string extension;  ///< ".cache"
  std::string content;    ///< for messages: "the photons of the map"
  std::string fits;       ///< completes "a file ...": "of the same scene; what this view is missing is added"
};

/// Matrix of `lucerna bench --NAME` (bench/matrix.h).
struct BenchInfo {
  std::string name, help;
  std::string matrix;  ///< JSON
};

struct SolverInfo {
  std::string name;            ///< value of components.secondary = NAME; prefix of its options
  std::string label;           ///< panel title: "Cache"
  std::string title;           ///< used in sentences: "the photon map"
  std::string help;            ///< one sentence
  ByComponent<bool> serves{};  ///< components it can compute
  /// What it computes of primary light, if not all of it; paths compute the rest.
  std::string primary_part;
  /// True if it reads that part in its lookups of secondary light only (plan::primary_by_paths()).
  bool primary_with_secondary = false;
  /// True if the mean image is correct at every sample count: the error is noise only.
  bool unbiased = false;
  /// True if its light is looked up at a diffuse vertex (paths::lookup_routes) instead of traced further.
  bool looked_up = false;
  /// True if it computes only directly visible light, without mirrors or glass between surface and camera.
  /// Another solver or path tracing computes the rest (components.X = NAME+OTHER).
  bool directly_visible_only = false;
  /// True if it finds light of points and directions behind specular surfaces, which eye paths cannot sample.
  bool finds_points = false;
  /// Lookup ports. A provider's lookups may end rays that a consumer traces during preparation, if the
  /// consumer computes secondary light and the provider tertiary light.
  bool provides_lookups = false, consumes_lookups = false;
  /// True if it separates light groups in films with compact groups (film::GroupStorage::compact).
  bool by_groups = false;
  /// Expected cost and noise, by which components.X=auto compares solvers; null: never chosen so.
  PredictProspect prospect = nullptr;
  std::vector<OptionInfo> options{};
  std::vector<ChangeRow> changes{};  ///< its own rows; default_changes() has those that most solvers share
  std::vector<ViewInfo> views{};
  std::vector<CommandInfo> commands{};
  std::optional<FileInfo> file{};
  std::vector<BenchInfo> benches{};
  /// Settings that reduce noise or bias of the prepared data, which more samples do not; shown as advice.
  std::vector<std::string> against_noise{}, against_bias{};
  /// Further settings (JSON objects as in a matrix) that `lucerna bench --full` measures.
  std::vector<std::string> bench_settings{};

  bool has_panel() const { return !options.empty() || !views.empty() || !commands.empty(); }
};

/// The command of that name; null if there is none.
const CommandInfo* find_command(const SolverInfo& solver, std::string_view name);
/// Rows that most solvers share: edits of lights and shapes, and settings that no solver owns.
std::span<const ChangeRow> default_changes();
/// All rows of a solver: its own, then the defaults that it does not override.
std::vector<ChangeRow> changes_of(const SolverInfo& solver);
/// What an edit invalidates by these rows; k_invalidates_all without a matching row.
Invalidation invalidated_by(const SolverInfo& solver, scene::Change edit);
/// What a setting invalidates, of this solver or of no solver; k_invalidates_all without a matching row.
/// Settings of other solvers invalidate nothing: see invalidated_by_setting() (registry.h).
Invalidation invalidated_by(const SolverInfo& solver, std::string_view key);

}  // namespace lucerna::solvers
