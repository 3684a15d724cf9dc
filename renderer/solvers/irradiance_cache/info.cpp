#include "solvers/irradiance_cache/info.h"

#include "solvers/irradiance_cache/options.h"

namespace lucerna::irradiance_cache {
namespace {

using scene::Change;
using namespace solvers;

/// Lights and materials do not move surfaces, so geometric measurements stay valid; moved objects invalidate
/// those around them (Cache::drop_near). `components.*`
/// invalidates nothing here: what records lack for new lookups is known when the cache is made for them
/// (Cache::adopt). A test checks all rows.
std::vector<ChangeRow> change_rows() {
  return {
      {Change::camera, k_invalidates_coverage,
       "records do not depend on the view; other surfaces become visible"},
      {Change::size, k_invalidates_coverage, "other places become visible"},
      {Change::material, k_invalidates_light_and_coverage,
       "a former mirror may be diffuse now and need records"},
      {Change::place, k_invalidates_light_and_coverage, "records near the objects are dropped"},
      {"components.", k_invalidates_nothing, "handled by Cache::adopt"},
      {"relight.", k_invalidates_nothing, "a mix that changes record light arrives as an edit of the lamps"},
      {"camera", k_invalidates_coverage, "records do not depend on the view; other surfaces become visible"},
      {"lights.", k_invalidates_light, "noise of the rays"},
      {"path.roulette_depth", k_invalidates_light, "noise of the rays"},
      {"path.max_depth", k_invalidates_light_and_coverage, "length of rays, and places of lookups"},
      {"seed", k_invalidates_all, "another, equally valid cache"},
      {"cache.rays", k_invalidates_light, "first level of the rays"},
      {"cache.max_rays", k_invalidates_light, "last level of the rays"},
      {"cache.noise", k_invalidates_light, "which records get further levels"},
      {"cache.environment_threshold", k_invalidates_light, "sky light in records"},
      {"cache.passes", k_invalidates_coverage, "when building ends"},
      {"cache.stop", k_invalidates_coverage, "when building ends"},
      {"cache.max_records", k_invalidates_coverage, "capacity; invalidates all if there are more records"},
      {"cache.smooth", k_invalidates_nothing, "light as lookups read it"},
      {"cache.branches", k_invalidates_nothing, "affects the picture only"},
      {"cache.pause", k_invalidates_nothing, "pauses of building"},
      {"cache.", k_invalidates_all, "places and radii of records"},
  };
}

}  // namespace

const solvers::SolverInfo& info() {
  static const SolverInfo all{
      .name = "cache",
      .label = "Cache",
      .title = "the irradiance cache",
      .help =
          "Irradiance cache: computes light at few points and interpolates between them. Fast and smooth on "
          "large surfaces; its error does not fall with more samples.",
      .serves = {true, true, true, false},
      .primary_part = "the sky's direct light on diffuse surfaces, except the sun",
      .primary_with_secondary = true,
      .looked_up = true,
      .consumes_lookups = true,
      .by_groups = true,
      .prospect = prospect,
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
                    .help = "Builds the irradiance cache to the end of the next stage and pauses there (see "
                            "cache.pause). A script continues when it has paused or is complete.",
                    .shortcut = 'X',
                    .until_still = true},
                   {.name = "run",
                    .label = "Continue",
                    .help = "Builds the irradiance cache without a pause until it is complete.",
                    .shortcut = 'J'}},
      .file = FileInfo{.extension = ".cache",
                       .content = "the records of the irradiance cache",
                       .fits = "of the same scene and lighting; missing records of this view are added"},
      .benches = bench_rows(),
      .against_noise = {"cache.rays", "cache.noise"},
      .against_bias = {"cache.error"},
      .bench_settings = bench_settings(),
  };
  return all;
}

}  // namespace lucerna::irradiance_cache
