#include "solvers/irradiance_cache/options.h"

namespace lucerna::irradiance_cache {

namespace {

/// Radii of validity.
std::vector<OptionInfo> radius_rows() {
  return {
      choice_option(
          "cache.metric", "split-sphere", {"split-sphere", "hessian"}, "",
          "Irradiance cache: measure that sets the radii of records. split-sphere: distances of the "
          "surfaces around, independent of the light. hessian: curvature of the irradiance; the "
          "region of validity is an ellipse, longer where the light changes less. It takes a quarter "
          "more time to build, which pays where radii are far above the minimum.",
          "Metric"),
      real_option(
          "cache.error", "0.3", 0.01, 1, "",
          "Irradiance cache: scale of the radii of records, for either metric. Smaller: more records, less "
          "error. split-sphere: radius over the harmonic mean distance of the surfaces around.",
          "Error bound"),
      real_option(
          "cache.nearest", "1", 0.1, 1, "of the distance",
          "Irradiance cache: maximum radius of a record over the distance of the nearest surface that it or "
          "a record in reach sees. Smaller: more records, and less error near narrow objects."),
      real_option("cache.min_radius", "4", 0, 100, "pixels",
                  "Irradiance cache: minimum radius of a record as seen from the camera.",
                  "Radius \xE2\x89\xA5"),
      real_option("cache.max_radius", "0.1", 0.001, 1, "of the scene's radius",
                  "Irradiance cache: maximum radius of a record.", "Radius \xE2\x89\xA4"),
      boolean_option(
          "cache.gather", "false",
          "Irradiance cache: paths gather near edges, where surfaces are nearer than twice the minimum "
          "radius. Records there only store where light comes from; paths sample these directions and end in "
          "records one vertex later. The error is noise that more samples reduce, instead of blotches that "
          "only more rays reduce; it costs several times as much."),
      integer_option("cache.branches", 4, 1, 64, "paths",
                     "Irradiance cache: gathering paths per sample of the picture (cache.gather). More: less "
                     "noise near edges, more time per sample.",
                     "Paths along edges"),
      real_option(
          "cache.thinning", "0.6", 0, 1, "of the radius",
          "Irradiance cache: fraction of its radius within which a record removes others tried in the same "
          "pass. Smaller: more records, and more of them serve each point; 0: none is removed."),
  };
}

/// Rays, light and number of records.
std::vector<OptionInfo> light_rows() {
  return {
      choice_option("cache.rays", "256", {"64", "256", "1024", "4096"}, "rays",
                    "Irradiance cache: rays of a record's first level, over its hemisphere.", "First rays"),
      choice_option("cache.max_rays", "65536", {"64", "256", "1024", "4096", "16384", "65536"}, "rays",
                    "Irradiance cache: rays of the last level of a noisy record; each level has four times "
                    "the rays of the one before.",
                    "Most rays"),
      real_option("cache.noise", "0.3", 0, 10, "",
                  "Irradiance cache: relative standard error above which a record gets more rays than the "
                  "first level. Valid for a record with a radius of 3 % of the picture's height; records "
                  "that more of the picture reads get more rays, others fewer, and a pass at most 16 further "
                  "rays per pixel in all (four times as many for half the bound). The bound falls as samples "
                  "accumulate, where more rays are more efficient than more samples.",
                  "Noise bound"),
      boolean_option("cache.smooth", "true",
                     "Irradiance cache: smooths the light of records over their neighbours on the same "
                     "surface, as far as the difference is not more than noise. Their rays stay the same.",
                     "Smooth records"),
      real_option("cache.environment_threshold", "16", 2, 1000000, "x mean",
                  "Irradiance cache, with components.primary=cache: texels of the environment brighter than "
                  "this times its mean radiance count as the sun, which is always sampled directly."),
      integer_option("cache.max_records", 300000, 16, 400000, "records",
                     "Irradiance cache: maximum number of records, which sets its memory; building ends when "
                     "it is reached.",
                     "Most records"),
      integer_option("cache.passes", 12, 1, 64, "passes",
                     "Irradiance cache: maximum number of passes of building.", "Most passes"),
      real_option("cache.stop", "0.02", 0, 1, "",
                  "Irradiance cache: building ends when at most this share of the paths finds no record; "
                  "those paths are path traced.",
                  "Share to stop"),
  };
}

/// Candidates in the picture.
std::vector<OptionInfo> candidate_rows() {
  return {
      real_option("cache.irradiance_weight", "1", 0, 1000, "",
                  "Irradiance cache: weight of the relative difference of irradiance between neighbouring "
                  "cells as detail, in later passes; 0: ignored.",
                  "Weight of light"),
  };
}

/// Display.
std::vector<OptionInfo> shown_rows() {
  return {
      without_restart(
          choice_option("cache.pause", "off", {"off", "pass", "stage"}, "",
                        "Irradiance cache: pauses building after every pass or stage, until cache.step or "
                        "cache.run. Only in the window and its scripts; batch rendering ignores it.")),
      without_restart(boolean_option(
          "overlay.records", "false",
          "Draws the records of the irradiance cache over the picture, as discs of their validity.",
          "Records")),
      without_restart(
          choice_option("overlay.records_by", "pass", {"pass", "origin", "rays", "distance", "error"}, "",
                        "Colour of drawn records: the pass that placed them, the origin of their candidate, "
                        "their rays, the harmonic mean distance of the surfaces around, or their error.",
                        "Coloured by")),
      without_restart(boolean_option("overlay.normals", "false",
                                     "Draws the normals of the irradiance cache's records over the picture, "
                                     "as short lines from their centres.",
                                     "Normals")),
      without_restart(choice_option(
          "overlay.placement", "off", {"off", "stage", "candidates", "clusters", "chosen"}, "",
          "Draws how the last pass of building chose the places of records: all candidates, their clusters "
          "with the tried places, or the chosen places; stage: the current state of building.",
          "Placement")),
      without_restart(boolean_option("overlay.overlap", "false",
                                     "Draws the number of records that serve each pixel, as a heat map.",
                                     "Overlap")),
      without_restart(choice_option("overlay.discontinuity", "off", {"off", "geometry", "irradiance"}, "",
                                    "Draws the detail of geometry, or of the present irradiance, from which "
                                    "candidates in the picture are selected.",
                                    "Detail of")),
      without_restart(integer_option(
          "overlay.discontinuity_level", 0, 0, 12, "",
          "Level of the detail pyramid that is drawn; its cells are 2^level pixels wide.", "Level")),
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
