#pragma once
// Runs a matrix: references first, then every cell missing in the report folder.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/folder.h"
#include "bench/matrix.h"
#include "bench/reference.h"
#include "scene/io/load.h"

namespace lucerna::bench {

struct Status {
  size_t step = 0, steps = 0;    ///< renders to do at the start of the bench, including references
  std::string what;              ///< "glass, adaptive, error 5 %, repeat 2 of 3"
  double fraction = 0;           ///< done part of this render
  std::optional<double> left_s;  ///< remaining time of the bench; nullopt until there is an estimate
};

struct Hooks {
  std::function<bool()> interrupted;            ///< called between work items
  std::function<void(const Status&)> progress;  ///< several times a second
  Message message;                              ///< receives lines to keep
};

struct RunOptions {
  std::string device;  ///< as in gpu::DeviceOptions
  std::filesystem::path references;
  scene::LoadOptions scenes = {};  ///< limits for scenes
};

struct RunSummary {
  bool complete = false;                  ///< false: interrupted; finished results are kept
  size_t measured = 0;                    ///< cells rendered now
  size_t kept = 0;                        ///< cells already present
  std::vector<ReferenceInfo> references;  ///< by scene, where known
  std::map<std::string, Result> results;  ///< by Matrix::id()
};

/// Every cell runs in a new renderer: load, render the warm-up, restart, then measure. A setting with a
/// separate program is rendered by it (outside.h). An interrupted render is discarded; the others are saved
/// as they end. The true error comes from the scene's reference. At the largest budget of every setting, the
/// first repeat also saves pictures. Throws Error like loading, rendering and writing.
RunSummary run_matrix(const Matrix& matrix, const Folder& folder, const RunOptions& options,
                      const Hooks& hooks);

/// pictures/SCENE.SETTING.png, and its errors: .exr with the layer "error", |difference in luminance| over
/// the reference's mean luminance; and .seen.exr, each pixel's error relative to its surroundings
/// (film::seen_difference()).
std::filesystem::path picture_file(const Folder& folder, const std::string& scene,
                                   const std::string& setting);
std::filesystem::path seen_file(const Folder& folder, const std::string& scene, const std::string& setting);
std::filesystem::path error_file(const Folder& folder, const std::string& scene, const std::string& setting);

}  // namespace lucerna::bench
