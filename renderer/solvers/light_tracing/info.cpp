#include "solvers/light_tracing/info.h"

namespace lucerna::light_tracing {
namespace {

using scene::Change;
using namespace solvers;

std::vector<OptionInfo> option_rows() {
  return {
      with_zero(integer_option("light.per_round", 0, 0, 1 << 24, "paths",
                               "Light tracing: light paths in a round; there is one round for every sample "
                               "of the picture. 0: one per pixel, 16,384 to 1,048,576.",
                               "Paths per round"),
                "automatic"),
      boolean_option("light.aim", "true",
                     "Light tracing: aims light paths at casters (specular surfaces), by the contributions "
                     "of each pair of lamp and caster in a pilot.",
                     "Aim at casters"),
      without_restart(boolean_option("overlay.light_paths", "false",
                                     "Draws light paths as they are traced: faint up to the first surface, "
                                     "then in the colour of their light.",
                                     "Show light paths")),
      without_restart(
          with_zero(integer_option(
                        "overlay.light_paths_of", 0, 0, 65535, "",
                        "Number of the only lamp whose paths are drawn, in the scene's order; 0: all lights.",
                        "Paths of lamp"),
                    "all")),
      without_restart(boolean_option("overlay.light_aim", "false",
                                     "Draws the targets of aimed light paths: a box around each caster, and "
                                     "lines from lights to casters, coloured by the share of the paths.",
                                     "Show aim")),
  };
}

/// Every picture has new rounds; these rows state whether lights and casters stay valid.
std::vector<ChangeRow> change_rows() {
  return {
      {Change::camera, k_invalidates_nothing, "lights and casters do not depend on the view"},
      {Change::size, k_invalidates_nothing, "lights and casters are the same"},
      {"components.", k_invalidates_all, "computed components"},
      {"camera", k_invalidates_nothing, "lights and casters do not depend on the view"},
      {"light.", k_invalidates_light, "number and targets of paths"},
  };
}

}  // namespace

const SolverInfo& info() {
  static const SolverInfo all{
      .name = "light",
      .label = "Light",
      .title = "light tracing",
      .help =
          "Light tracing: light paths are connected to the camera at diffuse surfaces that mirrors or glass "
          "light and the camera sees directly; sharp and unbiased. Mirror images of that light are path "
          "traced, or with light+photons looked up.",
      .serves = {false, false, false, true},
      .unbiased = true,
      .directly_visible_only = true,
      .finds_points = true,
      .by_groups = true,
      .options = option_rows(),
      .changes = change_rows(),
      .views = {{.option = "overlay.light_paths", .label = "Paths"},
                {.option = "overlay.light_aim", .label = "Aim"}},
      .against_noise = {"light.per_round"},
  };
  return all;
}

}  // namespace lucerna::light_tracing
