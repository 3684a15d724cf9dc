#pragma once
// Latency of the window: drives a session like the window, makes an edit, and compares every published
// picture with a reference of the edited scene.
#include <array>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/edit.h"
#include "bench/folder.h"
#include "bench/orbit.h"
#include "bench/picture_distance.h"
#include "scene/io/load.h"
#include "session/session.h"

namespace lucerna::bench {

/// One picture, shown until the next one.
struct Moment {
  double seconds = 0;  ///< since the edit
  PictureDistance distance;
  std::optional<film::ShownError> reported;  ///< the window's own estimate (Snapshot::shown_error)
};

/// True if a picture is good enough for work: session::usable() of its true error.
bool usable(const PictureDistance& distance);
/// Seconds after the edit at which errors are listed.
inline constexpr std::array<double, 5> k_listed_s = {0.3, 1, 3, 10, 30};
/// Range of the true error over the reported one in which the latter is right.
inline constexpr double k_right_low = 0.7, k_right_high = 1.4;

struct LatencyResult {
  std::string scene, solver, edit;
  std::optional<double> lit_s;     ///< until at most 0.1 % of the lit pixels are black, permanently
  std::optional<double> usable_s;  ///< until the picture is usable(), permanently
  /// Median tile at k_listed_s: true error and reported error; none if not measured for so long.
  std::array<std::optional<double>, k_listed_s.size()> error{}, reported{};
  /// Likewise, of the worst tenth of the tiles.
  std::array<std::optional<double>, k_listed_s.size()> worst{}, reported_worst{};
  /// Maximum increase of the error over its minimum so far.
  double rise = 0;
  double loading_s = 0;         ///< loading time, of Edit::load
  std::optional<Orbit> orbit;   ///< of Edit::orbit, which has none of the figures above
  std::vector<Moment> moments;  ///< all shown pictures; empty for medians
};
/// Median of repeated measurements of one edit, for each figure separately; of an even number the larger of
/// the two in the middle. Times not reached count as the largest. Names are those of the first run; needs at
/// least one run.
LatencyResult median_of(std::span<const LatencyResult> runs);
/// From the moments of an edit, in order, measured until `seconds`. Names are left empty.
LatencyResult latency_of(std::span<const Moment> moments, double seconds);

struct LatencyOptions {
  std::vector<std::filesystem::path> files;              ///< scenes
  std::vector<std::string> solvers = {"path", "cache"};  ///< solvers of secondary and tertiary light
  std::vector<Edit> edits;                               ///< in this order, each on the result of the last
  uint32_t width = 960, height = 540;
  uint32_t reference_samples = 64;
  /// Solver of secondary and tertiary light for the reference: "path", or "cache", whose bias of a few
  /// percent is small relative to k_usable, and whose noise is only that of direct light and caustics.
  std::string reference_solver = "path";
  double seconds = 10;   ///< duration of the measurement of each edit
  uint32_t repeats = 1;  ///< sessions of each scene and solver, each with all edits
  uint64_t seed = 0;     ///< seed of the edits' amounts: change_of()
  struct {
    double seconds = 120;  ///< maximum time until complete
    uint32_t samples = 8;  ///< required samples a pixel
  } settle;                ///< state of the picture before an edit
  std::string device;
  std::filesystem::path references;  ///< folder; matching pictures are reused
  std::filesystem::path pictures;    ///< folder for PNGs at k_listed_s; empty: none
  std::vector<std::pair<std::string, std::string>>
      set;  ///< settings of the sessions, in addition to the scene's
  scene::LoadOptions scenes = {};
};

/// Measures all edits; calls `done` after each. Edits that a scene does not support are reported by
/// `message` and omitted. Results of repeated sessions are consecutive. Throws Error like loading, rendering
/// and writing, and if `interrupted`.
std::vector<LatencyResult> measure_latency(const LatencyOptions& options, const Message& message,
                                           const std::function<void(const LatencyResult&)>& done,
                                           const std::function<bool()>& interrupted = {});

/// Agreement of reported errors with the true ones, over all listed times of all edits.
struct ReportedErrors {
  size_t known = 0;               ///< pictures with a reported error, and a true error above k_least_true
  size_t median_right = 0;        ///< median tiles among these within k_right_low..k_right_high
  size_t worst_right = 0;         ///< worst tenths among these within that range
  size_t said_usable = 0;         ///< pictures reported as usable
  size_t not_usable = 0;          ///< number of these that are not usable, by more than a tenth
  std::array<double, 3> ratio{};  ///< true over reported median: its lower decile, median, upper decile
};
/// Smaller true errors are lost in the rounding to 8 bits.
inline constexpr double k_least_true = 0.01;
ReportedErrors reported_errors(std::span<const LatencyResult> results);
std::string text_of(const ReportedErrors& errors);

/// A row of the table, under latency_heading().
std::string latency_row(const LatencyResult& result);
std::string latency_heading();
nlohmann::ordered_json to_json(const LatencyResult& result);

}  // namespace lucerna::bench
