#pragma once
// How soon the window shows something to work with: a session is driven as the window does it, an edit is
// made, and every picture that it publishes is held against a reference of the edited scene.
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

/// Whether a picture is good to work with: session::usable() of its true error.
bool usable(const PictureDistance& distance);
/// Seconds after the edit at which errors are listed.
inline constexpr std::array<double, 5> k_listed_s = {0.3, 1, 3, 10, 30};
/// The reported error of a picture is right if the true one lies within these multiples of it.
inline constexpr double k_right_low = 0.7, k_right_high = 1.4;

struct LatencyResult {
  std::string scene, solver, edit;
  std::optional<double> lit_s;     ///< until no more than 0.1 % of the lit pixels are black, and stay so
  std::optional<double> usable_s;  ///< until the picture is usable() and stays so
  /// Of the median tile at k_listed_s: the true error, and the reported one; none: not watched for so long.
  std::array<std::optional<double>, k_listed_s.size()> error{}, reported{};
  /// The same of the worst tenth of the tiles.
  std::array<std::optional<double>, k_listed_s.size()> worst{}, reported_worst{};
  /// The most by which the error has grown again from its least so far.
  double rise = 0;
  double loading_s = 0;         ///< of a load
  std::vector<Moment> moments;  ///< all that was shown; of a median none
};
/// Of one edit measured several times, each figure by itself: the middle one, of an even number the larger of
/// the two in the middle. What was not reached counts as later than all. Names are the first one's; at least
/// one run.
LatencyResult median_of(std::span<const LatencyResult> runs);
/// From the moments of an edit, in order, measured until `seconds`. Names are left empty.
LatencyResult latency_of(std::span<const Moment> moments, double seconds);

struct LatencyOptions {
  std::vector<std::filesystem::path> files;              ///< scenes
  std::vector<std::string> solvers = {"path", "cache"};  ///< of secondary and tertiary light
  std::vector<Edit> edits;                               ///< in this order, one on top of the other
  uint32_t width = 960, height = 540;
  uint32_t reference_samples = 64;
  /// Of secondary and tertiary light of the reference: "path", or "cache", whose bias of a few percent is
  /// small beside k_usable, and whose noise is that of direct light and caustics alone.
  std::string reference_solver = "path";
  double seconds = 10;   ///< that each edit is watched
  uint32_t repeats = 1;  ///< sessions of each scene and solver, each with all edits
  uint64_t seed = 0;     ///< of the edits' amounts: change_of()
  struct {
    double seconds = 120;  ///< that it may take to be complete
    uint32_t samples = 8;  ///< a pixel, that it then has
  } settle;                ///< of the picture before an edit
  std::string device;
  std::filesystem::path references;                      ///< folder; pictures that serve are kept
  std::filesystem::path pictures;                        ///< folder for PNGs at k_listed_s; empty: none
  std::vector<std::pair<std::string, std::string>> set;  ///< settings of the sessions, beyond the scene's
  scene::LoadOptions scenes = {};
};

/// Measures all; `done` is told of each edit as it ends. What an edit needs and a scene has not is told by
/// `message` and left out. Results of repeated sessions follow each other. Throws Error as loading, rendering
/// and writing do, and when `interrupted`.
std::vector<LatencyResult> measure_latency(const LatencyOptions& options, const Message& message,
                                           const std::function<void(const LatencyResult&)>& done,
                                           const std::function<bool()>& interrupted = {});

/// How well reported errors agree with the true ones, over all listed times of all edits.
struct ReportedErrors {
  size_t known = 0;               ///< pictures with a reported error, and a true error above k_least_true
  size_t median_right = 0;        ///< of these: the median tile's within k_right_low..k_right_high
  size_t worst_right = 0;         ///< ... the worst tenth's
  size_t said_usable = 0;         ///< pictures reported as usable
  size_t not_usable = 0;          ///< of these: are not, by more than a tenth
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
