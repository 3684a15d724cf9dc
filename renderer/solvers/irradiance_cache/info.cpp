#include "solvers/irradiance_cache/info.h"

#include "solvers/irradiance_cache/options.h"

namespace lucerna::irradiance_cache {
namespace {

using scene::Change;
using namespace solvers;

/// What each change spoils. Lights and materials move no surface: whatever rays measured of the scene's shape
/// stays true. `components.*` spoil nothing here: what records lack of what is then looked up is known only
/// when the cache is made for it (Cache::adopt). The test goes through all rows.
std::vector<ChangeRow> change_rows() {
  return {
      {Change::camera, k_invalidates_coverage, "records lie on surfaces, whoever looks"},
      {Change::size, k_invalidates_coverage, "more pixels ask at more places"},
      {Change::material, k_invalidates_light_and_coverage, "what was a mirror may be diffuse now, and asks"},
      {"components.", k_invalidates_nothing, "as far as records hold what is then looked up"},
      {"relight.", k_invalidates_nothing,
       "where records hold light another mix comes as an edit of the lamps"},
      {"camera", k_invalidates_coverage, "records lie on surfaces, whoever looks"},
      {"lights.", k_invalidates_light, "the rays' noise"},
      {"path.roulette_depth", k_invalidates_light, "the rays' noise"},
      {"path.max_depth", k_invalidates_light_and_coverage,
       "how far rays go, and from where lookups are made"},
      {"seed", k_invalidates_all, "another cache, as good as this one"},
      {"cache.rays", k_invalidates_light, "first level of the rays"},
      {"cache.max_rays", k_invalidates_light, "last level of the rays"},
      {"cache.noise", k_invalidates_light, "who gets further levels"},
      {"cache.environment", k_invalidates_light, "what of the sky records hold; its threshold too"},
      {"cache.passes", k_invalidates_coverage, "when building ends"},
      {"cache.stop", k_invalidates_coverage, "when building ends"},
      {"cache.max_records", k_invalidates_coverage, "room; all, where there are more records than that"},
      {"cache.branches", k_invalidates_nothing, "of the picture alone"},
      {"cache.pause", k_invalidates_nothing, "where building waits to be looked at"},
      {"cache.", k_invalidates_all, "where records lie and how far they serve: radii, metric, placement"},
  };
}

}  // namespace

const solvers::SolverInfo& info() {
  static const SolverInfo all{
      .name = "cache",
      .label = "Cache",
      .title = "the irradiance cache",
      .help =
          "Irradiance cache: light is gathered at few points and interpolated between them; smooth and "
          "quick on large surfaces, with an error that more samples do not take away.",
      .serves = {false, true, true, false},
      .looked_up = true,
      .consumes_lookups = true,
      .by_groups = true,
      .options = option_rows(),
      .changes = change_rows(),
      .views =
          {{.option = "overlay.records",
            .label = "Records",
            .shortcut = 'C',
            .inspects_pointer = true,
            .refined_by = {"overlay.records_by"}},
           {.option = "overlay.overlap", .label = "Overlap", .shortcut = 'V', .inspects_pointer = true},
           {.option = "overlay.normals",
            .label = "Normals",
            .shortcut = 'N',
            .inspects_pointer = true,
            .refined_by = {"overlay.records_by"}},
           {.option = "overlay.placement", .label = "Placement", .shortcut = 'P', .ring = {"off", "stage"}},
           {.option = "overlay.discontinuity", .label = "Detail", .shortcut = 'G'}},
      .commands = {{.name = "step",
                    .label = "Next stage",
                    .help =
                        "Goes on building the irradiance cache to the end of the next stage and waits there "
                        "(see cache.pause); a script goes on when it waits, or is complete.",
                    .shortcut = 'X',
                    .until_still = true},
                   {.name = "run",
                    .label = "Go on",
                    .help = "Goes on building the irradiance cache without a pause until it is complete.",
                    .shortcut = 'J'}},
      .file = FileInfo{.extension = ".cache",
                       .content = "the records of the irradiance cache",
                       .fits = "of the same scene, lit alike; what this view is missing is added"},
      .benches = bench_rows(),
      .against_noise = {"cache.rays", "cache.noise"},
      .against_bias = {"cache.error"},
      .bench_settings = bench_settings(),
      .lookup_ways = lookup_ways(),
  };
  return all;
}

}  // namespace lucerna::irradiance_cache
