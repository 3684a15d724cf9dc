#pragma once
// What `lucerna render` tells of a picture when it is done: figures for --stats, and tiles that stay over the
// target.
#include <nlohmann/json.hpp>
#include <string>

#include "session/renderer.h"

namespace lucerna::app {

/// For --stats: scene, settings, times, rays, errors by tile and component, the ledger, and what solvers
/// tell. `wall`: seconds that rendering has taken.
nlohmann::ordered_json make_stats(session::Renderer& renderer, double wall);

/// Warns of tiles that are over the target error though they have all the samples they may have, by what
/// keeps them there. `advice`: what helps where it is records.
void report_unreached(const schedule::AdaptiveSchedule& schedule, const std::string& advice);

/// Warns where most of the picture is shown as white or as black, so that adaptive sampling sees no error
/// there.
void report_unseen(session::Renderer& renderer);

}  // namespace lucerna::app
