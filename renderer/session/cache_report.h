#pragma once
// What the window shows of the irradiance cache. Made on the session's thread, published as a whole.
#include <optional>
#include <utility>

#include "solvers/irradiance_cache/inspector.h"

namespace lucerna::session {

struct CacheReport {
  irradiance_cache::CacheStatus status;
  irradiance_cache::PlacementShow placement =
      irradiance_cache::PlacementShow::off;  ///< what of it lies over the picture; never `stage`
  uint32_t room = 0;                         ///< records that there is room for
  /// Of the pixels of the picture, as their first samples see the scene; none while it is being built.
  std::optional<irradiance_cache::Overlap> overlap;
  uint32_t color = 0;                   ///< shared::k_record_by_*: what the overlay colours records by
  std::pair<float, float> scale{1, 2};  ///< ends of that scale (irradiance_cache::Cache::scale)
  /// Where somebody looks (Session::inspect), 0..1 to the right and down; and what is there.
  std::optional<vec2> looked_at;
  irradiance_cache::Inspection inspection;
};

}  // namespace lucerna::session
