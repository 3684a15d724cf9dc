#pragma once
// Measurements of `lucerna bench`: scenes x settings x budgets x repeats, from a JSON file or built in.
#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"

namespace lucerna::bench {

/// Criterion that ends a render.
enum class BudgetKind {
  samples,  ///< samples a pixel, equal for all
  errors,   ///< relative error of every tile; adaptive sampling only
  seconds   ///< seconds of rendering
};
inline constexpr std::array<const char*, 3> k_budget_names = {"samples", "errors", "seconds"};

struct Budget {
  BudgetKind kind = BudgetKind::samples;
  double value = 0;
  /// "256 samples", "error 5 %", "10 s".
  std::string text() const;
};

using SettingValues = std::map<std::string, std::string>;

/// One method of rendering, as changes of options (plan/settings.h).
struct Setting {
  std::string name, about;
  SettingValues set;
  /// "" or the curve of this point: settings of one curve differ in the number of records of a solver, and
  /// the report connects them by a line, error against records.
  std::string curve;
  BudgetKind budget = BudgetKind::samples;
  /// "" or the file of another lucerna, whose verb `render` makes the pictures in a separate process; only
  /// the figures of the final picture are available.
  std::string program{};
  /// "" or the name of another setting to compare with besides the first, such as the same method in another
  /// program.
  std::string beside{};
};

struct SceneEntry {
  std::string name;
  std::filesystem::path file;
  uint32_t width = 0, height = 0;
  std::string camera;  ///< "": the scene's own
  SettingValues set;   ///< options of all settings for this scene, and of its reference
  uint32_t reference_samples = 0;
  std::array<std::vector<double>, 3> budgets;  ///< by BudgetKind, in order of effort
};

/// A render to measure.
struct Cell {
  size_t scene = 0, setting = 0, budget = 0;  ///< indices; budget into SceneEntry::budgets[setting's kind]
  int repeat = 0;
  bool operator==(const Cell&) const = default;
};

struct Matrix {
  std::string name;
  int repeats = 3;
  uint32_t warmup = 8;  ///< samples a pixel rendered and discarded before the measurement
  uint32_t seed = 1, reference_seed = 900001;  ///< repeat k has seed + k
  SettingValues set;                           ///< for all
  bool as_seen = false;                        ///< the page shows only the error as seen
  std::vector<SceneEntry> scenes;
  std::vector<Setting> settings;  ///< the first is the baseline of comparisons

  const std::vector<double>& budgets(size_t scene, size_t setting) const {
    return scenes[scene].budgets[size_t(settings[setting].budget)];
  }
  Budget budget(const Cell& c) const {
    return {settings[c.setting].budget, budgets(c.scene, c.setting)[c.budget]};
  }
  /// All cells in the order of measurement: scene by scene, and within a scene the repeats outermost, every
  /// second one backwards, so that a drift of the machine affects all settings equally.
  std::vector<Cell> cells() const;
  /// A name for a cell, suitable for files: "glass.adaptive.2.0".
  std::string id(const Cell& c) const;
};

/// Its index in Matrix::settings.
std::optional<size_t> find_setting(const Matrix& matrix, const std::string& name);

/// Reads a matrix; `where` locates messages, `folder` is what relative scene files start from. Throws Error,
/// located at the element ("m.json: settings[1].set"), for JSON that does not parse, unknown keys, wrong
/// types, values out of range, unknown settings, programs that cannot be run, names used twice, scenes that
/// do not exist, and settings without a budget. k_matrix_help describes the format.
Matrix parse_matrix(const std::string& text, const std::string& where, const std::filesystem::path& folder);
/// Likewise, from a file; relative scene files start from its folder.
Matrix read_matrix(const std::filesystem::path& file);

struct BuiltinInfo {
  std::string name, help;
  std::string matrix;  ///< JSON
};
/// "quick": three scenes in small pictures, within ten minutes on two cores. "full": larger, with the atrium,
/// more budgets and the solvers' bench settings. Then the matrices of solvers.
std::vector<BuiltinInfo> builtin_matrices();
/// One of them, with scenes taken from `scenes`. Throws Error when there is none of that name.
Matrix builtin_matrix(const std::string& name, const std::filesystem::path& scenes);

/// The matrix with every default written out; parse_matrix() reads it back to the same.
nlohmann::ordered_json to_json(const Matrix& matrix);

/// For --help: the keys of a matrix file with an example.
extern const char* const k_matrix_help;

}  // namespace lucerna::bench
