#include "solvers/photons/info.h"

namespace lucerna::photons {
namespace {

using scene::Change;
using namespace solvers;

std::vector<OptionInfo> option_rows() {
  return {
      with_zero(integer_option(
                    "photons.per_round", 0, 0, 1 << 24, "paths",
                    "Photons: paths from lights in a round, of which there is one for every sample of the "
                    "picture, or in the first map of irradiance; 0: as many as the picture has pixels, at "
                    "least 16384, for a map twice as many, at least 131072.",
                    "Paths a round"),
                "automatic"),
      real_option(
          "photons.radius", "1.5", 0.1, 1000, "pixels",
          "Photons: radius of the first round, as the camera sees it. Less: less blur, and more grain.",
          "First radius"),
      real_option("photons.floor", "0.5", 0, 1000, "pixels",
                  "Photons: least radius, from which on it shrinks no further.", "Least radius"),
      real_option("photons.alpha", "0.6667", 0.01, 1, "",
                  "Photons: how slowly the radius shrinks from round to round: grain falls with its power, "
                  "blur with that of the rest to 1; 1: it does not shrink.",
                  "Shrinking"),
      boolean_option(
          "photons.aim", "true",
          "Photons: aims light paths at what mirrors or refracts smoothly, and those of the sun and the sky "
          "at where their light gets in, by what a pilot finds that each pair of lamp and box brings to the "
          "picture.",
          "Aim light paths"),
      boolean_option(
          "photons.importons", "true",
          "Photons: stores them where paths from the eye look, by a short pilot; elsewhere one in four, for "
          "all.",
          "Only where looked at"),
      boolean_option("photons.efficiency", "true",
                     "Photons: bring caustics only in those parts of the picture where a pilot finds that "
                     "they have less noise for their time than paths from the eye; elsewhere these do. "
                     "Likewise secondary and tertiary light of the whole picture, where those paths have "
                     "less than half of the noise for their time.",
                     "Only where worth it"),
      boolean_option(
          "photons.borders", "true",
          "Photons: divides by the surface that there is around a place instead of by a whole disc, "
          "so that borders and creases are not darker than they are.",
          "Correct borders"),
      choice_option(
          "photons.irradiance_map", "all", {"off", "records", "all"}, "",
          "Photons: where tertiary light is looked up behind a diffuse surface irradiance is known "
          "beforehand, on pieces of surfaces that are as fine as there are photons; where these are "
          "too few, the path goes on by itself. For the rays of the irradiance cache's records, or "
          "for paths that gather as well. off: all photons around are added up, which is slow, and "
          "noisy where they are sparse.",
          "Irradiance map"),
      integer_option("photons.nearest", 8, 2, 1024, "photons",
                     "Photons: as many make up a piece of such a map at least, and as many again tell its "
                     "light. Less: finer pieces, and more grain.",
                     "Photons a piece"),
      without_restart(choice_option(
          "overlay.photon_density", "off", {"off", "photons", "irradiance", "importance", "caustics"}, "",
          "Shows over the picture how dense the photons of the last round lie, or what they "
          "bring: a heat map on "
          "surfaces, through glass and in mirrors as well, and under the pointer the disc within which "
          "photons count, with those. "
          "importance: how much of the picture hangs on photons there, by the pilot that "
          "decides which are stored; worth: where photons bring caustics.",
          "Show density")),
      without_restart(boolean_option(
          "overlay.photon_paths", "false",
          "Shows paths from the lights as they are traced: faint up to the first surface, then in the colour "
          "of their light.",
          "Show light paths")),
      without_restart(with_zero(
          integer_option("overlay.photon_paths_of", 0, 0, 65535, "",
                         "Of the lamp of this number alone, in the scene's order; 0: of all lights.",
                         "Paths of lamp"),
          "all")),
      without_restart(boolean_option("overlay.photon_aim", "false",
                                     "Shows what light paths are aimed at: a box around each caster and "
                                     "where light from afar gets in, and lines from lights to these, by "
                                     "the share of the paths.",
                                     "Show aim")),
      without_restart(
          choice_option("overlay.photons", "off", {"off", "flux", "bounce", "map", "light", "round"}, "",
                        "Shows the photons of the last round where they lie, in colours: flux of their "
                        "light, bounce by the number of surfaces before, map by the component that they "
                        "bring, light by where they come from, round another one each round.",
                        "Show photons")),
  };
}

/// Photons are another round's as soon as the picture begins anew; what is told here is whether the last ones
/// may serve until then.
std::vector<ChangeRow> change_rows() {
  return {
      {Change::camera, k_invalidates_nothing, "photons lie on surfaces, whoever looks"},
      {Change::size, k_invalidates_nothing, "photons lie on surfaces, whoever looks"},
      {"components.", k_invalidates_all, "which light is stored"},
      {"camera", k_invalidates_nothing, "photons lie on surfaces, whoever looks"},
      {"photons.", k_invalidates_light, "how many photons, and within which radius they count"},
  };
}

/// Light that is bundled, alone: against a path-traced reference, for path tracing as long as for photons.
/// The report extrapolates the time to an error by 1/t where path tracing does not reach it.
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

/// Whole pictures in which caustics are the hard part, the other light by paths or by records.
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

/// Secondary and tertiary light alone, by the choices of who computes them.
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
          "Photons: paths from the lights leave photons on surfaces, anew for every sample of the picture, "
          "and "
          "what lies within a shrinking radius counts; finds light behind glass and mirrors, blurs it a "
          "little at first.",
      .serves = {false, true, true, true},
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
            "bundled light alone: path tracing against photons and light tracing, on glass and ring; "
            "two hours",
            k_caustics_matrix},
           {"caustic-pictures",
            "whole pictures of glass and ring: path tracing against caustics by photons and light "
            "tracing, with other light by paths or records; two hours",
            k_caustic_pictures_matrix},
           {"deep",
            "light that has met diffuse surfaces before, by records, photons, and records or paths that "
            "end in photons, in three interiors; an hour and a half",
            k_deep_matrix}},
      .against_bias = {"photons.radius", "photons.floor"},
  };
  return all;
}

}  // namespace lucerna::photons
