#pragma once
// What a person is told of an irradiance cache: its figures as the renderer has them, and all words, tables,
// legends and colours that are made of them. Whoever draws these knows nothing of records.
#include <optional>
#include <utility>

#include "base/options.h"
#include "solvers/irradiance_cache/inspector.h"
#include "solvers/report.h"

namespace lucerna::irradiance_cache {

struct CacheReport {
  CacheStatus status;
  PlacementShow placement = PlacementShow::off;  ///< what of it lies over the picture; never `stage`
  uint32_t placed = 0;                           ///< records so far, those of the pass in progress too
  uint32_t room = 0;                             ///< records that there is room for
  /// Of the pixels of the picture, as their first samples see the scene; none while it is being built.
  std::optional<Overlap> overlap;
  uint32_t color = 0;                   ///< shared::k_record_by_*: what the overlay colours records by
  std::pair<float, float> scale{1, 2};  ///< ends of that scale (Cache::scale)
  /// Where somebody looks, 0..1 to the right and down; and what is there.
  std::optional<vec2> looked_at;
  Inspection inspection;
};

/// `settings` has the solver's options (info().options), as the figures were made with.
solvers::Report make_report(const CacheReport& data, const OptionValues& settings);

}  // namespace lucerna::irradiance_cache
