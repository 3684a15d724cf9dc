#pragma once
// How long building will go on, told from what its passes have taken so far. No device: pure state.
#include <optional>

#include "solvers/irradiance_cache/cache.h"

namespace lucerna::irradiance_cache {

struct BuildForecast {
  double done = 0;     ///< of the work, 0..1
  double left_ms = 0;  ///< of what CachePass::ms measures
};

/// Nothing while building has stopped, or as long as too little is known. `stop_share`:
/// CacheOptions::stop_share. On scenes whose passes were measured it is within a factor of 1.7 of what they
/// took.
std::optional<BuildForecast> forecast_of(const CacheStatus& status, double stop_share);

}  // namespace lucerna::irradiance_cache
