#include "solvers/irradiance_cache/options.h"

namespace lucerna::irradiance_cache {

namespace {

/// How far records serve.
std::vector<OptionInfo> radius_rows() {
  return {
      choice_option(
          "cache.metric", "hessian", {"split-sphere", "hessian"}, "",
          "Irradiance cache: what decides how far a record serves. hessian: how its light bends from "
          "place to place, with ellipses that are longer where it bends less; split-sphere: how far "
          "things are that it sees, in whatever light.",
          "Metric"),
      real_option(
          "cache.error", "0.3", 0.01, 1, "",
          "Irradiance cache: how far records serve: radii are in proportion to it, by either metric. "
          "Smaller: more records, less error. split-sphere: radius over the harmonic mean distance of what "
          "a record sees.",
          "Error bound"),
      real_option(
          "cache.nearest", "1", 0.1, 1, "of the distance",
          "Irradiance cache: greatest radius of a record over the distance of the nearest thing that it or "
          "a record that it reaches sees. Less: more records, and less error, where narrow things stand "
          "before a surface."),
      real_option("cache.min_radius", "6", 0, 100, "pixels",
                  "Irradiance cache: least radius of a record, as the camera sees it.",
                  "Radius \xE2\x89\xA5"),
      real_option("cache.max_radius", "0.1", 0.001, 1, "of the scene's radius",
                  "Irradiance cache: greatest radius of a record.", "Radius \xE2\x89\xA4"),
      boolean_option(
          "cache.gather", "false",
          "Irradiance cache: where something is nearer than twice the least radius, along edges, records "
          "only "
          "tell where light comes from. Paths gather it from there and end in records one vertex later: "
          "grain that more samples take away, instead of specks that further rays of records do, and several "
          "times dearer."),
      integer_option(
          "cache.branches", 4, 1, 64, "paths",
          "Irradiance cache: paths by which each sample of the picture gathers where it does "
          "(cache.gather). More: less grain along edges, and more time a sample where there are many.",
          "Paths along edges"),
      real_option(
          "cache.thinning", "0.6", 0, 1, "of the radius",
          "Irradiance cache: within that a record makes others superfluous that are tried with it. Less: "
          "more "
          "records, and more of them serve a point; 0: all that are tried are kept."),
  };
}

/// What they hold, and how many there are.
std::vector<OptionInfo> light_rows() {
  return {
      choice_option("cache.rays", "256", {"64", "256", "1024", "4096"}, "rays",
                    "Irradiance cache: rays from a record over its hemisphere, at first.", "First rays"),
      choice_option(
          "cache.max_rays", "65536", {"64", "256", "1024", "4096", "16384", "65536"}, "rays",
          "Irradiance cache: rays of the last level that a noisy record gets, each four times the one "
          "before.",
          "Most rays"),
      real_option(
          "cache.noise", "0.3", 0, 10, "",
          "Irradiance cache: relative standard error above which a record with a radius of 3 % of the "
          "picture's height gets more rays than the first level. Those that more of the picture reads get "
          "more of them, others fewer, for what they are worth to it. While samples grow more it is lowered "
          "where that pays more than they do.",
          "More rays above"),
      boolean_option(
          "cache.environment", "false",
          "Irradiance cache: records also hold the light straight from the sky, so that surfaces that it "
          "lights need no noisy shadow rays to it. Where secondary light is cached, only while primary "
          "light is on."),
      real_option(
          "cache.environment_threshold", "16", 2, 1000000, "x mean",
          "Irradiance cache: texels of the environment brighter than so many times its mean radiance are no "
          "sky but a sun, and are sampled directly everywhere."),
      integer_option(
          "cache.max_records", 300000, 16, 400000, "records",
          "Irradiance cache: room for records, of 592 bytes each and 1.9 kB with the tree that finds them; "
          "building ends when it is used up.",
          "Room"),
      integer_option("cache.passes", 12, 1, 64, "passes", "Irradiance cache: passes of building at most.",
                     "Most passes"),
      real_option(
          "cache.stop", "0.02", 0, 1, "",
          "Irradiance cache: building ends when no greater share of the paths still asks for records; "
          "these are "
          "path traced.",
          "Stop at"),
  };
}

/// Where the picture asks for them.
std::vector<OptionInfo> candidate_rows() {
  return {
      real_option(
          "cache.candidates", "1", 0, 16, "a cell",
          "Irradiance cache: candidates for records, on every scale, in a cell of the picture in which "
          "geometry or irradiance changes fully; few fall on smooth walls. 0: every pixel that no record "
          "serves asks.",
          "Candidates"),
      real_option(
          "cache.irradiance_weight", "1", 0, 1000, "",
          "Irradiance cache: how much a relative difference of irradiance between neighbouring cells counts "
          "as detail in later passes; 0: not at all.",
          "Light weighs"),
  };
}

/// What a person sees of it.
std::vector<OptionInfo> shown_rows() {
  return {
      without_restart(choice_option(
          "cache.pause", "off", {"off", "pass", "stage"}, "",
          "Irradiance cache: building waits after every pass, or every stage of it, for cache.step or "
          "cache.run. In the window and its scripts alone: batch rendering goes on.")),
      without_restart(boolean_option(
          "overlay.records", "false",
          "Shows over the picture the irradiance cache's records as discs of their validity.", "Records")),
      without_restart(choice_option(
          "overlay.records_by", "pass", {"pass", "origin", "rays", "distance", "error"}, "",
          "What records are coloured by: the pass that placed them, what asked for them, their rays, "
          "the harmonic "
          "mean of the distances that they see, their error.",
          "Coloured by")),
      without_restart(boolean_option("overlay.normals", "false",
                                     "Shows over the picture the normals of the irradiance cache's "
                                     "records, as short lines from their centres.",
                                     "Normals")),
      without_restart(choice_option(
          "overlay.placement", "off", {"off", "stage", "candidates", "clusters", "chosen"}, "",
          "Shows over the picture how the last pass of building chose the places of the irradiance "
          "cache's records: the candidates that asked, their clusters with what is tried, or what of "
          "that is chosen; stage: as far as building has come.",
          "Placement")),
      without_restart(boolean_option("overlay.overlap", "false",
                                     "Shows over the picture how many records serve each pixel.", "Overlap")),
      without_restart(choice_option(
          "overlay.discontinuity", "off", {"off", "geometry", "irradiance"}, "",
          "Shows over the picture how much geometry, or the irradiance that the present records give, "
          "changes there: by this the irradiance cache picks candidates in the picture.",
          "Detail of")),
      without_restart(
          integer_option("overlay.discontinuity_level", 0, 0, 12, "",
                         "Level of the discontinuity's pyramid that is shown: its cells are 2 to that power "
                         "pixels wide.",
                         "Level")),
  };
}

}  // namespace

std::vector<OptionInfo> option_rows() {
  std::vector<OptionInfo> all;
  for (const auto& rows : {radius_rows(), light_rows(), candidate_rows(), shown_rows()})
    all.insert(all.end(), rows.begin(), rows.end());
  return all;
}

}  // namespace lucerna::irradiance_cache
