#pragma once
// Measurements of `lucerna bench interiors`: rooms by path tracing, with learned lights, with cached light
// and with both, each by this program and, if given, by another one for comparison.
#include <filesystem>
#include <string>
#include <vector>

#include "bench/matrix.h"

namespace lucerna::bench {

/// The interiors among the project's scenes, and the three of the quick form.
extern const std::vector<std::string> k_own_interiors, k_quick_interiors;
/// The project's other scenes, for lucerna bench auto.
extern const std::vector<std::string> k_own_showpieces;
/// Settings of lucerna bench interiors, and of lucerna bench auto; the first is the baseline.
extern const std::vector<std::string> k_interior_settings, k_auto_settings;

struct InteriorsOptions {
  std::filesystem::path own;                   ///< folder of the project's own scenes
  std::vector<std::filesystem::path> folders;  ///< folders with rooms, or files; empty: `own`
  std::filesystem::path program;               ///< lucerna
  std::filesystem::path against;               ///< another program; "": none
  bool quick = false;                          ///< three rooms in about two minutes
  // 0, "" or empty: the default of the form, full or quick.
  int repeats = 0;
  std::vector<double> seconds;  ///< budgets
  std::vector<uint32_t>
      samples;       ///< budgets instead of seconds, so that figures do not depend on the machine
  std::string size;  ///< WIDTHxHEIGHT; exchanged for rooms taller than wide
  uint32_t reference_samples = 0;
  std::vector<std::string> settings;  ///< some of the settings; none: all of the form
  bool every_solver = false;          ///< lucerna bench auto: k_auto_settings, and all scenes of `own`
};

/// The rooms in a folder: the interiors of `own` if it is that; otherwise every .gltf and .glb in it and in
/// its subfolders, by path; a file is a room itself. Throws Error located at the folder if it is missing or
/// has no rooms.
std::vector<std::filesystem::path> find_interiors(const std::filesystem::path& folder,
                                                  const std::filesystem::path& own);

/// The matrix. Rooms with equal names get numbers (kitchen, kitchen-2). Settings of the other program are
/// "before-path" .. and follow their counterparts. `help_of_other`: output of its `render
/// --help`; settings that need a missing option are left out and listed in `left_out`. Throws Error like
/// find_interiors() and parse_matrix().
Matrix interiors_matrix(const InteriorsOptions& options, const std::string& help_of_other,
                        std::vector<std::string>& left_out);

/// Width over height of the scene's first camera, from the file; 0 if not given.
double camera_aspect(const std::filesystem::path& scene);

}  // namespace lucerna::bench
