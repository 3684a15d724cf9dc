#pragma once
// What `lucerna bench interiors` measures: rooms by path tracing, by lights that are learned, by cached light
// and by both, each by the program itself and, where one is named, by another beside it.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/matrix.h"

namespace lucerna::bench {

/// The interiors among the project's scenes, and the three of the quick form.
extern const std::vector<std::string> k_own_interiors, k_quick_interiors;

struct InteriorsOptions {
  std::filesystem::path own;                   ///< folder of the project's own scenes
  std::vector<std::filesystem::path> folders;  ///< that rooms are taken from, or files; none: `own`
  std::filesystem::path program;               ///< lucerna
  std::filesystem::path against;               ///< another one; "": none
  bool quick = false;                          ///< three rooms in about two minutes
  // What is 0, "" or empty is as the form, full or quick, has it.
  int repeats = 0;
  std::vector<double> seconds;    ///< budgets
  std::vector<uint32_t> samples;  ///< budgets in place of seconds: then figures do not depend on the machine
  std::string size;               ///< WIDTHxHEIGHT; rooms that are taller than wide have it turned
  uint32_t reference_samples = 0;
  std::vector<std::string> settings;  ///< some of k_interior_settings; none: all
};

inline constexpr std::array<const char*, 4> k_interior_settings = {"path", "learned", "cache",
                                                                   "cache-learned"};

/// The rooms in a folder: the interiors of `own` where it is that; otherwise every .gltf and .glb in it and
/// in the folders in it, by their paths; a file is itself. Throws Error located at the folder when it is
/// missing or holds none.
std::vector<std::filesystem::path> find_interiors(const std::filesystem::path& folder,
                                                  const std::filesystem::path& own);

/// The matrix. Rooms with equal names get numbers (kitchen, kitchen-2). Settings of the other program are
/// "before-path" .. and follow the ones they are compared with. `help_of_other`: output of its `render
/// --help`; settings that need a missing option are left out and listed in `left_out`. Throws Error like
/// find_interiors() and parse_matrix().
Matrix interiors_matrix(const InteriorsOptions& options, const std::string& help_of_other,
                        std::vector<std::string>& left_out);

/// Width over height of the scene's first camera, as the file says; 0 where it says nothing.
double camera_aspect(const std::filesystem::path& scene);

}  // namespace lucerna::bench
