#include "solvers/light_tracing/info.h"

namespace lucerna::light_tracing {
namespace {

using scene::Change;
using namespace solvers;

std::vector<OptionInfo> option_rows() {
  return {
      with_zero(integer_option(
                    "light.per_round", 0, 0, 1 << 24, "paths",
                    "Light tracing: paths from lights in a round, of which there is one for every sample of "
                    "the picture; 0: as many as the picture has pixels, 16,384 to 1,048,576.",
                    "Paths a round"),
                "automatic"),
      boolean_option("light.aim", "true",
                     "Light tracing: aims light paths at what mirrors or refracts smoothly, by what a pilot "
                     "finds that each pair of lamp and caster brings to the picture.",
                     "Aim at casters"),
      without_restart(boolean_option(
          "overlay.light_paths", "false",
          "Shows paths from the lights as they are traced: faint up to the first surface, then in the colour "
          "of their light.",
          "Show light paths")),
      without_restart(with_zero(
          integer_option("overlay.light_paths_of", 0, 0, 65535, "",
                         "Of the lamp of this number alone, in the scene's order; 0: of all lights.",
                         "Paths of lamp"),
          "all")),
      without_restart(boolean_option("overlay.light_aim", "false",
                                     "Shows what light paths are aimed at: a box around each caster, and "
                                     "lines from lights to casters, by "
                                     "the share of the paths.",
                                     "Show aim")),
  };
}

/// A round is another as soon as the picture begins anew; what is told here is whether lights and casters may
/// be those that there are.
std::vector<ChangeRow> change_rows() {
  return {
      {Change::camera, k_invalidates_nothing, "lights and casters are the same, whoever looks"},
      {Change::size, k_invalidates_nothing, "lights and casters are the same"},
      {"components.", k_invalidates_all, "which light is brought"},
      {"camera", k_invalidates_nothing, "lights and casters are the same, whoever looks"},
      {"light.", k_invalidates_light, "how many paths, and where they go"},
  };
}

}  // namespace

const SolverInfo& info() {
  static const SolverInfo all{
      .name = "light",
      .label = "Light",
      .title = "light tracing",
      .help =
          "Light tracing: paths from the lights are joined to the camera where they leave mirrors and glass "
          "for a surface that it sees straight; sharp and without bias. What it sees of that light in "
          "mirrors and through glass is path traced, or with light+photons looked up.",
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
