#pragma once
// Report of the irradiance cache: figures from the renderer, and the texts, tables, legends and colours made
// of them.
#include <optional>
#include <utility>

#include "base/options.h"
#include "solvers/irradiance_cache/inspector.h"
#include "solvers/report.h"

namespace lucerna::irradiance_cache {

struct CacheReport {
  CacheStatus status;
  PlacementShow placement = PlacementShow::off;  ///< what is drawn over the picture; never `stage`
  uint32_t placed = 0;                           ///< records so far, including the current pass
  bool refines = false;                          ///< records get more rays while the samples wait
  uint32_t room = 0;                             ///< capacity in records
  /// Over the pixels of the picture, as their first samples see the scene; nullopt while building.
  std::optional<Overlap> overlap;
  uint32_t color = 0;                   ///< shared::k_record_by_*: colour of the overlay
  std::pair<float, float> scale{1, 2};  ///< ends of the colour scale (Cache::scale)
  /// Inspected place, 0..1 to the right and down, and the result.
  std::optional<vec2> looked_at;
  Inspection inspection;
};

/// `settings` contains the solver's options (info().options) used for the figures.
solvers::Report make_report(const CacheReport& data, const OptionValues& settings);

}  // namespace lucerna::irradiance_cache
