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

#include "bench/folder.h"
#include "scene/io/load.h"
#include "session/session.h"
#include "shaders/shared/preview.h"

namespace lucerna::bench {

enum class Edit {
  load,      ///< the scene is loaded; the clock runs from when that is done
  strength,  ///< the brightest lamp to a third; without lamps so the emissive material that sends most light
  move,      ///< that lamp a tenth of the scene's radius aside; one without a place turns by 25 degrees;
             ///< without lamps nothing is measured
  sky,       ///< the environment turns by 90 degrees; without an image nothing is measured
  material,  ///< the material of the largest surface without a texture becomes red
  camera,    ///< turns by 12 degrees and steps aside by 2 % of the scene's radius
  solver     ///< from path tracing to the solver, or back
};
inline constexpr std::array<const char*, 7> k_edit_names = {"load",     "strength", "move",  "sky",
                                                            "material", "camera",   "solver"};
/// Throws Error listing the names.
Edit edit_of(const std::string& name);

/// Of pictures, in the linear luminance that is shown: 0 black, 1 white. Both of one size, row by row.
struct PictureDistance {
  /// Mean over the pixels of the difference over the reference, after a mean over 3x3 pixels of both; pixels
  /// darker than k_dark are held against k_dark. In tiles of 16x16 pixels, what the reference's own noise has
  /// in its mean square is taken off; tiles where more than all of it seems to be noise count below 0.
  double error = 0;
  double black = 0;  ///< share of the pixels with light in the reference that show none, 3x3 likewise
};
inline constexpr float k_dark = shared::k_preview_dark;
/// `half_difference`: of two independent halves of the reference, whose mean it is; empty: it has no noise.
PictureDistance picture_distance(std::span<const float> shown, std::span<const float> reference,
                                 uint32_t width, std::span<const float> half_difference = {});
/// Luminance that a published picture with the linear tone curve shows.
std::vector<float> shown_luminance(std::span<const uint8_t> rgba);

/// What was shown from then on, until the next one. Seconds since the edit.
struct Moment {
  double seconds = 0;
  PictureDistance distance;
  std::optional<double> estimated;  ///< the window's own estimate of the error (Snapshot::shown_error)
};

/// Relative error below which a picture is usable.
inline constexpr double k_usable = session::k_usable_error;
/// Seconds after the edit of which errors are told.
inline constexpr std::array<double, 5> k_reported_s = {0.3, 1, 3, 10, 30};

struct LatencyResult {
  std::string scene, solver, edit;
  std::optional<double> lit_s;     ///< until no more than 0.1 % of the lit pixels are black, and stay so
  std::optional<double> usable_s;  ///< until the error is below k_usable and stays there
  std::array<std::optional<double>, k_reported_s.size()> error{};  ///< where measured for so long
  std::array<std::optional<double>, k_reported_s.size()>
      estimated{};  ///< the window's own estimate of it, then
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
  struct {
    double seconds = 120;  ///< that it may take to be complete
    uint32_t samples = 8;  ///< a pixel, that it then has
  } settle;                ///< of the picture before an edit
  std::string device;
  std::filesystem::path references;                      ///< folder; pictures that serve are kept
  std::filesystem::path pictures;                        ///< folder for PNGs at k_reported_s; empty: none
  std::vector<std::pair<std::string, std::string>> set;  ///< settings of the sessions, beyond the scene's
  scene::LoadOptions scenes = {};
};

/// Measures all; `done` is told of each edit as it ends. What an edit needs and a scene has not is told by
/// `message` and left out. Results of repeated sessions follow each other. Throws Error as loading, rendering
/// and writing do, and when `interrupted`.
std::vector<LatencyResult> measure_latency(const LatencyOptions& options, const Message& message,
                                           const std::function<void(const LatencyResult&)>& done,
                                           const std::function<bool()>& interrupted = {});

/// A row of the table, under latency_heading().
std::string latency_row(const LatencyResult& result);
std::string latency_heading();
nlohmann::ordered_json to_json(const LatencyResult& result);

}  // namespace lucerna::bench
