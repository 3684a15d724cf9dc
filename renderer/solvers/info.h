#pragma once
// What a way of computing light says of itself: plain tables, without a device, from which settings, help,
// the window, scripts and the renderer take all that they know of it.
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

namespace lucerna::solvers {

inline constexpr int k_components = 4;  ///< primary, secondary, tertiary, caustic

/// What a change spoils of a solver's work; each without the ones before it.
struct Invalidation {
  bool coverage = false;  ///< what there is holds, but something may be missing: more is added
  bool light = false;     ///< places hold, and their light is computed anew
  bool places = false;    ///< all is made anew
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

/// One row of a solver's table of changes.
struct ChangeRow {
  /// An edit, or the settings whose keys begin with this ("cache.rays", "film."); of several rows the longest
  /// counts, and a solver's own before a default.
  std::variant<scene::Change, std::string_view> change;
  Invalidation invalidates;
  std::string_view why;
};

/// Something that can be drawn over the picture: a setting that turns it on, with a place in the window.
struct ViewInfo {
  std::string option;  ///< a boolean, or a choice whose first value is "off"
  std::string label;   ///< in panel and menu: "Records"
  char shortcut = 0;   ///< key in the window, 'A' to 'Z'; 0: none
  /// Of a choice: the values that the key goes through, in a ring; none: all of them.
  std::vector<std::string> ring;
  bool inspects_pointer = false;  ///< while it is on, a pointer at rest in the picture asks what lies there
  std::vector<std::string> refined_by{};  ///< choices that the menu offers while it is on
};

/// Something that a person can tell the solver to do: the command SOLVER.NAME.
struct CommandInfo {
  std::string name;   ///< "step"
  std::string label;  ///< in panel and menu: "Next stage"
  std::string help;   ///< one sentence
  char shortcut = 0;
  /// A script goes on when preparation waits or is complete, with all in force that was commanded.
  bool until_still = false;
};

/// Files that keep its work: the commands SOLVER.save and SOLVER.load.
struct FileInfo {
  std::string extension;  ///< ".cache"
  std::string content;    ///< for messages: "the photons of the map"
  std::string fits;       ///< behind "a file": "of the same scene; what this view is missing is added"
};

/// A matrix for `lucerna bench --NAME` (bench/matrix.h).
struct BenchInfo {
  std::string name, help;
  std::string matrix;  ///< JSON
};

/// A way of looking light up whose speed is worth measuring (`lucerna bench interpolation`).
struct LookupWay {
  std::string name;
  std::map<std::string, std::string> set;  ///< settings
};

struct SolverInfo {
  std::string name;   ///< as in settings: components.secondary = NAME; its options begin with it
  std::string label;  ///< of its panel: "Cache"
  std::string title;  ///< in sentences: "the photon map"
  std::string help;   ///< one sentence
  std::array<bool, k_components> serves{};  ///< components that it can compute
  /// Whether its mean is the true image at every number of samples: then noise is all its error.
  bool unbiased = false;
  /// Whether its light is looked up at a diffuse vertex (paths::lookup_routes), not traced on from there.
  bool looked_up = false;
  /// Whether it brings no more of a component than what the camera sees straight, without mirrors and glass
  /// between: the rest is path traced, or looked up by another solver (components.X = NAME+OTHER).
  bool directly_visible_only = false;
  /// Whether it finds light of points and directions behind what refracts or mirrors it, which paths from the
  /// eye cannot aim at.
  bool finds_points = false;
  /// Whether rays that another solver traces to prepare its own light may end in lookups of this one's; and
  /// whether this one's do, where it computes secondary light and the other one tertiary light.
  bool provides_lookups = false, consumes_lookups = false;
  /// Whether its light comes by groups of lights where films keep them in short
  /// (film::GroupStorage::compact).
  bool by_groups = false;
  std::vector<OptionInfo> options{};
  std::vector<ChangeRow> changes{};  ///< its own rows; default_changes() has those that most solvers share
  std::vector<ViewInfo> views{};
  std::vector<CommandInfo> commands{};
  std::optional<FileInfo> file{};
  std::vector<BenchInfo> benches{};
  /// Settings by which its work gets less noise, and less bias, that samples do not take away: for advice.
  std::vector<std::string> against_noise{}, against_bias{};
  /// Settings (JSON objects as in a matrix) that `lucerna bench --full` measures besides its own.
  std::vector<std::string> bench_settings{};
  std::vector<LookupWay> lookup_ways{};

  bool has_panel() const { return !options.empty() || !views.empty() || !commands.empty(); }
};

/// Null when there is no such command.
const CommandInfo* find_command(const SolverInfo& solver, std::string_view name);
/// Rows that are the same for most solvers: edits of lights and shapes, and settings that no solver owns.
std::span<const ChangeRow> default_changes();
/// All rows that count for a solver: its own, then the defaults of which it has no row of its own.
std::vector<ChangeRow> changes_of(const SolverInfo& solver);
/// By these rows: of an edit, k_invalidates_all where there is no row.
Invalidation invalidated_by(const SolverInfo& solver, scene::Change edit);
/// Of a setting that is the solver's own or nobody's: k_invalidates_all where no row fits. Settings of
/// another solver invalidate nothing; the registry knows whose they are (registry.h).
Invalidation invalidated_by(const SolverInfo& solver, std::string_view key);

}  // namespace lucerna::solvers
