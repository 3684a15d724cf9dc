#pragma once
// Figures of a finished picture of `lucerna render`: for --stats, and tiles above the target.
#include <nlohmann/json.hpp>
#include <string>

#include "session/renderer.h"

namespace lucerna::app {

/// For --stats: scene, settings, times, rays, errors by tile and component, the ledger, and the solvers'
/// statistics. `wall`: seconds of rendering.
nlohmann::ordered_json make_stats(session::Renderer& renderer, double wall);

/// Error of a filtered picture over its mean luminance: noise and bias of the filter, and the error of
/// lookups.
double filtered_error(session::Renderer& renderer, const session::Filtered& filtered);

/// Warns of tiles above the target error with the maximum of samples, by cause. `advice`: remedies if records
/// are the cause.
void report_unreached(const schedule::AdaptiveSchedule& schedule, const std::string& advice);

/// Warns if most of the picture is white or black, where adaptive sampling sees no error.
void report_unseen(session::Renderer& renderer);

}  // namespace lucerna::app
