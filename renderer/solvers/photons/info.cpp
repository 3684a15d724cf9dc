#include "solvers/photons/info.h"

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

/// Caustics alone, against a path-traced reference, in equal times for path tracing and photons. Where path
/// tracing does not reach an error, the report extrapolates the time by 1/t.
constexpr const char* k_caustics_matrix = R"({
  "name": "caustics",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 16384},
  "set": {"components.primary": "off", "components.secondary": "off", "components.tertiary": "off",
          "components.caustic": "path"},
  "budgets": {"seconds": [4, 16, 60]},
  "scenes": [
    {"file": "glass/glass.gltf", "size": "160x160"},
    {"file": "ring/ring.gltf", "size": "192x108"}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing", "budget": "seconds"},
    {"name": "photons", "about": "photons, aimed", "set": {"components.caustic": "photons"}, "budget": "seconds"},
    {"name": "unaimed", "about": "photons, not aimed", "budget": "seconds",
     "set": {"components.caustic": "photons", "photons.aim": false}},
    {"name": "light", "about": "light tracing", "set": {"components.caustic": "light"}, "budget": "seconds"},
    {"name": "both", "about": "light tracing, photons for mirror images", "budget": "seconds",
     "set": {"components.caustic": "light+photons"}}
  ]
})";

/// Whole pictures with difficult caustics; other light by paths or by records.
constexpr const char* k_caustic_pictures_matrix = R"({
  "name": "caustic-pictures",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 16384},
  "budgets": {"seconds": [3, 5, 10, 60]},
  "scenes": [
    {"file": "glass/glass.gltf", "size": "256x256"},
    {"file": "ring/ring.gltf", "size": "256x144"}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing", "budget": "seconds"},
    {"name": "photons", "about": "caustics by photons, else path tracing", "budget": "seconds",
     "set": {"components.caustic": "photons"}},
    {"name": "photons-cache", "about": "caustics by photons, secondary and tertiary light by records",
     "budget": "seconds",
     "set": {"components.caustic": "photons", "components.secondary": "cache", "components.tertiary": "cache"}},
    {"name": "both-cache", "about": "caustics by light tracing and photons, secondary and tertiary light by records",
     "budget": "seconds",
     "set": {"components.caustic": "light+photons", "components.secondary": "cache",
             "components.tertiary": "cache"}}
  ]
})";

/// Secondary and tertiary light alone, by each choice of solvers.
constexpr const char* k_deep_matrix = R"({
  "name": "deep",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 2048},
  "set": {"components.primary": "off", "components.caustic": "off"},
  "budgets": {"seconds": [15, 60]},
  "scenes": [
    {"file": "hall/hall.gltf", "size": "256x256"},
    {"file": "sun-patch/sun-patch.gltf", "size": "256x256"},
    {"file": "atrium/atrium.gltf", "size": "256x256"}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing", "budget": "seconds"},
    {"name": "cache", "about": "secondary and tertiary light from records", "budget": "seconds",
     "set": {"components.secondary": "cache", "components.tertiary": "cache"}},
    {"name": "cache-photons", "about": "records whose rays end in photons", "budget": "seconds",
     "set": {"components.secondary": "cache", "components.tertiary": "photons"}},
    {"name": "path-photons", "about": "final gathering: paths that end in irradiance of photons", "budget": "seconds",
     "set": {"components.tertiary": "photons"}},
    {"name": "path-rounds", "about": "... that add up the photons of rounds instead", "budget": "seconds",
     "set": {"components.tertiary": "photons", "photons.irradiance_map": "off"}}
  ]
})";

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
      .options = option_rows(),
      .changes = change_rows(),
      .views = {{.option = "overlay.photons", .label = "Photons", .shortcut = 'O'},
                {.option = "overlay.photon_density",
                 .label = "Density",
                 .shortcut = 'M',
                 .inspects_pointer = true},
                {.option = "overlay.photon_paths", .label = "Paths"},
                {.option = "overlay.photon_aim", .label = "Aim"}},
      .benches =
          {{"caustics",
            "caustics alone: path tracing against photons and light tracing, on glass and ring; two hours",
            k_caustics_matrix},
           {"caustic-pictures",
            "whole pictures of glass and ring: path tracing against caustics by photons and light tracing, "
            "with other light by paths or records; two hours",
            k_caustic_pictures_matrix},
           {"deep",
            "secondary and tertiary light in three interiors: by records, by photons, and by records or "
            "paths that end in photons; an hour and a half",
            k_deep_matrix}},
      .against_bias = {"photons.radius", "photons.floor"},
  };
  return all;
}

}  // namespace lucerna::photons
