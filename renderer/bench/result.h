#pragma once
// Result of one render of the bench, stored in the report folder: cells/ID.json.
#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "stats/ledger.h"

namespace lucerna::bench {

using Layers = std::array<double, stats::k_layers>;  ///< the sum, then the components

/// One line of the render's ledger.
struct CurvePoint {
  double wall_s = 0, device_s = 0;
  uint64_t rays = 0;
  double samples = 0;  ///< a pixel, on average
  /// Rms error over mean luminance, by the render itself: of the sum stats::Entry::OfMean::sum, of the
  /// components the paths' noise.
  Layers estimated{};
  Layers truth{};     ///< likewise, against the reference, without its noise; 0: lost in that noise
  double tiles = 0;   ///< estimated relative error that nine tiles in ten are under
  double relmse = 0;  ///< like Result::relmse
  double seen = 0;    ///< like Result::seen
};

/// Forecast at a tenth of the render's time, and the final value.
struct ForecastResult {
  double at_s = 0;  ///< when the forecast was made
  stats::Band seconds, rays;
};

struct Result {
  std::string scene, setting;
  std::string budget;  ///< Budget::text()
  int repeat = 0;
  uint32_t seed = 0;
  std::string scene_hash;      ///< hash of the files when it was rendered
  std::string reference_hash;  ///< hash of its reference
  std::string tracer;
  double wall_s = 0, device_s = 0;  ///< rendering only
  double setup_s = 0;               ///< loading, compiling, warming up: not in wall_s
  uint64_t rays = 0, paths = 0;
  double samples = 0;
  Layers estimated{}, truth{}, component_s{};
  struct {
    double paths = 0, records = 0, interpolation = 0;
  } parts;         ///< parts of estimated[0] (base/error_sum.h); 0 in files from before they were
                   ///< separated
  double mse = 0;  ///< squared true rms error in luminance, without the reference's noise
  /// Relative mean squared error of R, G, B against the reference's halves, without the worst pixels
  /// (film/io/relative_mse.h), and with them; 0: below 0, lost in their noise.
  double relmse = 0, relmse_all = 0;
  /// The squared error as seen, without the worst pixels (film/io/relative_mse.h), and with them; 0: below 0,
  /// lost in the references' noise, or in files from before it was measured.
  double seen = 0, seen_all = 0;
  bool in_reference_noise = false;  ///< truth is not distinguishable from the reference's noise
  struct {
    double median = 0, decile = 0, worst = 0;  ///< estimated relative errors
    uint64_t heavy = 0;                        ///< number with light in rare large amounts
    uint64_t over = 0;  ///< adaptive: number above the target with the maximum of samples
  } tiles;
  uint64_t dropped = 0;  ///< number of contributions that were not finite
  /// Final number of records for lookups, and their rays; 0 without records, and in files from before they
  /// were counted.
  uint64_t records = 0, record_rays = 0;
  std::optional<ForecastResult> forecast;
  std::vector<CurvePoint> curve;
};

nlohmann::ordered_json to_json(const Result& result);
/// Throws Error, located at `where`, for anything that to_json() does not write: truncated files, missing or
/// wrong values (only records, record_rays, relmse_all, a point's relmse and values as seen may be missing),
/// a curve that is not rising in time.
Result parse_result(const std::string& text, const std::string& where);
Result result_from_json(const nlohmann::ordered_json& json, const std::string& where);

}  // namespace lucerna::bench
