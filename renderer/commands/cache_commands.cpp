// Commands that keep the irradiance cache and lead its building from stage to stage.
#include "base/error.h"
#include "commands/workspace.h"

namespace lucerna::commands {

void Workspace::needs_cache() const {
  needs_scene();
  if (setting("components.secondary") != "cache" && setting("components.tertiary") != "cache")
    throw Error("", "no component takes its light from the cache; set components.secondary cache");
}

void Workspace::add_cache_commands() {
  const Parameter limit = time_limit();
  registry.add({.name = "cache.save",
                .help = "Writes the records of the irradiance cache for cache.load, as soon as they are "
                        "complete; a script waits for that, and fails when it cannot be.",
                .parameters = {file_to_write({".cache"}), limit},
                .run =
                    [this](const Arguments& a) {
                      needs_scene();
                      saved_ = session.save_cache(a.text("file"));
                    },
                .done = [this](const Arguments&) { return saved(); }});
  registry.add({.name = "cache.load",
                .help = "Takes the records of the irradiance cache from a file of the same scene, lit alike, "
                        "and adds what this view is missing.",
                .parameters = {file_named({".cache"})},
                .run = [this](const Arguments& a) {
                  needs_scene();
                  session.load_cache(a.text("file"));
                }});
  // True once building waits or is complete, with all in force that was commanded.
  const auto stands = [this](const Arguments&) {
    return up_to_date() && !camera_moved && snapshot->cache &&
           (snapshot->cache->status.waits ||
            snapshot->cache->status.stop != irradiance_cache::StopReason::building);
  };
  registry.add({.name = "cache.step",
                .help =
                    "Goes on building the irradiance cache to the end of the next stage and waits there (see "
                    "cache.pause); a script goes on when it waits, or is complete.",
                .parameters = {limit},
                .run = [this](const Arguments&) { needs_cache(), session.step_cache(); },
                .done = stands});
  registry.add({.name = "cache.run",
                .help = "Goes on building the irradiance cache without a pause until it is complete.",
                .parameters = {},
                .run = [this](const Arguments&) { needs_cache(), session.run_cache(); }});
  registry.add({.name = "wait_cache",
                .help =
                    "In a script: waits until building of the irradiance cache waits (see cache.pause) or "
                    "is complete.",
                .parameters = {limit},
                .run = [this](const Arguments&) { needs_cache(); },
                .done = stands});
}

}  // namespace lucerna::commands
