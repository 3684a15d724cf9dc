#include "solvers/irradiance_cache/changes.h"

#include <cassert>

namespace lucerna::irradiance_cache {
namespace {

constexpr Change k_changes[] = {
    // Edits.
    {"camera", false, k_spoils_coverage, "records lie on surfaces, whoever looks"},
    {"size", false, k_spoils_coverage, "more pixels ask at more places"},
    {"lamp", false, k_spoils_light, "other light on the same surfaces"},
    {"environment", false, k_spoils_light, "other light on the same surfaces"},
    {"colour", false, k_spoils_light, "of a material, or its emission: other light on the same surfaces"},
    {"material", false, k_spoils_light_and_coverage, "what was a mirror may be diffuse now, and asks"},
    {"scene", false, k_spoils_all, "other surfaces"},
    {"shaders", false, k_spoils_all, "whatever they compute"},
    {"restart", false, k_spoils_all, "asked for: all anew"},
    // Settings.
    {"components.", true, k_spoils_nothing, "as far as records hold what is then looked up"},
    {"samples", true, k_spoils_nothing, "of the picture alone"},
    {"sampling.", true, k_spoils_nothing, "of the picture alone"},
    {"film.", true, k_spoils_nothing, "how it is shown"},
    {"show.", true, k_spoils_nothing, "how it is shown"},
    {"overlay.", true, k_spoils_nothing, "how it is shown"},
    {"about", true, k_spoils_nothing, "words"},
    {"camera", true, k_spoils_coverage, "records lie on surfaces, whoever looks"},
    {"tracer", true, k_spoils_nothing, "all tracers find the same surfaces"},
    {"path.batch", true, k_spoils_nothing, "how work is cut"},
    {"path.roulette_depth", true, k_spoils_light, "the rays' noise"},
    {"path.max_depth", true, k_spoils_light_and_coverage, "how far rays go, and from where lookups are made"},
    {"seed", true, k_spoils_all, "another cache, as good as this one"},
    {"cache.rays", true, k_spoils_light, "first level of the rays"},
    {"cache.max_rays", true, k_spoils_light, "last level of the rays"},
    {"cache.noise", true, k_spoils_light, "who gets further levels"},
    {"cache.environment", true, k_spoils_light, "what of the sky records hold; its threshold too"},
    {"cache.passes", true, k_spoils_coverage, "when building ends"},
    {"cache.stop", true, k_spoils_coverage, "when building ends"},
    {"cache.max_records", true, k_spoils_coverage, "room; all, where there are more records than that"},
    {"cache.", true, k_spoils_all, "where records lie and how far they serve: radii, metric, placement"},
};

}  // namespace

std::span<const Change> changes() { return k_changes; }

Spoilt spoilt_by_edit(std::string_view what) {
  for (const Change& c : k_changes)
    if (!c.setting && c.what == what) return c.spoils;
  assert(!"a row of the matrix");
  return k_spoils_all;
}

Spoilt spoilt_by_setting(std::string_view key) {
  const Change* best = nullptr;
  for (const Change& c : k_changes)
    if (c.setting && key.starts_with(c.what) && (!best || c.what.size() > best->what.size())) best = &c;
  return best ? best->spoils : k_spoils_all;
}

}  // namespace lucerna::irradiance_cache
