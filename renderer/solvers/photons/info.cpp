#include "solvers/photons/info.h"

#include "solvers/photons/benches.h"

namespace lucerna::photons {
namespace {

using scene::Change;
using namespace solvers;

std::vector<OptionInfo> option_rows() {
  return {
      with_zero(
          integer_option(
              "photons.per_round", 0, 0, 1 << 24, "paths",
              "Photons: light paths in a round, one round for every sample of the picture, or in the first "
              "irradiance map. 0: one per pixel, at least 16384; for a map two per pixel, at least 131072.",
              "Paths per round"),
          "automatic"),
      real_option(
          "photons.radius", "1.5", 0.1, 1000, "pixels",
          "Photons: radius in the first round, as seen from the camera. Smaller: less blur, more noise.",
          "First radius"),
      real_option("photons.floor", "0.5", 0, 1000, "pixels", "Photons: minimum radius.", "Minimum radius"),
      real_option("photons.alpha", "0.6667", 0.01, 1, "",
                  "Photons: exponent alpha of the shrinking radius: over n rounds the variance falls with "
                  "n^-alpha, the bias with n^(alpha - 1). 1: constant radius.",
                  "Radius exponent"),
      boolean_option(
          "photons.aim", "true",
          "Photons: aims light paths at casters (specular surfaces), and those of the sun and the sky at "
          "entrances of their light, by the contributions of each pair of lamp and box in a pilot.",
          "Aim light paths"),
      boolean_option("photons.importons", "true",
                     "Photons: stores all photons near lookups of a short pilot; elsewhere Russian roulette "
                     "with probability 1/4.",
                     "Store by importance"),
      boolean_option(
          "photons.efficiency", "true",
          "Photons: compute caustics only in regions where they are more efficient (less variance "
          "× time) than path tracing in a pilot. Secondary and tertiary light are delegated to "
          "path tracing in the whole picture if its variance × time is less than half. Primary light is "
          "not delegated.",
          "Only where more efficient"),
      boolean_option("photons.borders", "true",
                     "Photons: divides by the actual surface area around a place instead of a full disc, so "
                     "that borders and creases are not too dark.",
                     "Correct borders"),
      choice_option("photons.irradiance_map", "all", {"off", "records", "all"}, "",
                    "Photons: lookups of tertiary light behind a diffuse surface read precomputed irradiance "
                    "of surface cells, as fine as the photon density permits; in cells with too few photons "
                    "the path continues. records: for rays of the irradiance cache; all: for gathering paths "
                    "too. off: sums nearby photons, which is slow, and noisy where photons are sparse.",
                    "Irradiance map"),
      without_restart(choice_option(
          "overlay.photon_density", "off", {"off", "photons", "irradiance", "importance", "caustics"}, "",
          "Draws the density of the last round's photons or their irradiance: a heat map on surfaces, also "
          "through glass and in mirrors, and under the pointer the disc of the lookup with its photons. "
          "importance: importance of lookups in the pilot that decides which photons are stored; caustics: "
          "share of the samples whose caustics photons compute.",
          "Density")),
      without_restart(boolean_option("overlay.photon_paths", "false",
                                     "Draws light paths as they are traced: faint up to the first surface, "
                                     "then in the colour of their light.",
                                     "Show light paths")),
      without_restart(
          with_zero(integer_option(
                        "overlay.photon_paths_of", 0, 0, 65535, "",
                        "Number of the only lamp whose paths are drawn, in the scene's order; 0: all lights.",
                        "Paths of lamp"),
                    "all")),
      without_restart(boolean_option(
          "overlay.photon_aim", "false",
          "Draws the targets of aimed light paths: a box around each caster and each entrance of distant "
          "light, and lines from lights to these, coloured by the share of the paths.",
          "Show aim")),
      without_restart(choice_option("overlay.photons", "off",
                                    {"off", "flux", "bounce", "map", "light", "round"}, "",
                                    "Draws the photons of the last round. Colours: flux: colour of their "
                                    "light; bounce: number of surfaces before; map: component that they "
                                    "contribute to; light: their light source; round: changes every round.",
                                    "Show photons")),
  };
}

/// Every picture has new rounds; these rows state whether the present photons stay usable until then.
std::vector<ChangeRow> change_rows() {
  return {
      {Change::camera, k_invalidates_nothing, "photons do not depend on the view"},
      {Change::size, k_invalidates_nothing, "photons do not depend on the view"},
      {"components.", k_invalidates_all, "stored components"},
      {"camera", k_invalidates_nothing, "photons do not depend on the view"},
      {"photons.", k_invalidates_light, "number and radius of photons"},
  };
}

}  // namespace

const SolverInfo& info() {
  static const SolverInfo all{
      .name = "photons",
      .label = "Photons",
      .title = "the photons",
      .help =
          "Photons: light paths store photons on surfaces, in a new round for every sample of the picture; "
          "those within a shrinking radius are averaged. Finds light behind glass and mirrors; its blur "
          "shrinks with the samples.",
      .serves = {true, true, true, true},
      .primary_part = "direct light on diffuse surfaces",
      .looked_up = true,
      .finds_points = true,
      .provides_lookups = true,
      .by_groups = true,
      .prospect = prospect,
      .options = option_rows(),
      .changes = change_rows(),
      .views = {{.option = "overlay.photons", .label = "Photons", .shortcut = 'O'},
                {.option = "overlay.photon_density",
                 .label = "Density",
                 .shortcut = 'M',
                 .inspects_pointer = true},
                {.option = "overlay.photon_paths", .label = "Paths"},
                {.option = "overlay.photon_aim", .label = "Aim"}},
      .benches = bench_rows(),
      .against_bias = {"photons.radius", "photons.floor"},
  };
  return all;
}

}  // namespace lucerna::photons
