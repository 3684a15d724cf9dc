// Developer tools: measurements of single parts of the renderer, one subcommand each.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "base/huge_pages.h"
#include "tools/tools.h"

namespace {

using namespace lucerna;

template <class Arguments>
void add_measurement_options(CLI::App* tool, Arguments& a, int least_repeats) {
  tool->add_option("--repeats", a.repeats, "measurements of each figure")
      ->check(CLI::Range(least_repeats, 1000))
      ->capture_default_str();
  tool->add_option("--json", a.json, "file to write the figures to");
  tool->add_option("--device", a.device, "device: index, part of a name, cpu or gpu (also LUCERNA_DEVICE)");
}

template <class Arguments>
void add_scene_options(CLI::App* tool, Arguments& a) {
  tool->add_option("SCENE", a.scene, "glTF scene")->required();
  tool->add_option("--width", a.width, "of the picture")
      ->check(CLI::Range(16u, 4096u))
      ->capture_default_str();
  tool->add_option("--height", a.height, "its height")->check(CLI::Range(16u, 4096u))->capture_default_str();
  tool->add_option("--samples", a.samples, "samples per pixel")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
  tool->add_option("--set", a.set, "KEY=VALUE, as of lucerna render")->allow_extra_args(false);
  tool->add_flag("--allow-outside", a.scenes.outside, "allow scenes to read files outside their folder");
}

int run(int argc, char** argv) {
  CLI::App app{"Developer tools: measurements of single parts of the renderer"};
  app.require_subcommand(1);

  tools::SortArguments sorts;
  CLI::App* sort = app.add_subcommand(
      "sort", "elements per second of prefix sum and radix sort on the device, and of the C++ library's");
  sort->add_option("--sizes", sorts.sizes, "elements to sort")->check(CLI::Range(1u, 1u << 22));
  sort->add_option("--seed", sorts.seed, "seed of the keys")->capture_default_str();
  add_measurement_options(sort, sorts, 5);

  tools::LookupArguments lookups;
  CLI::App* lookup = app.add_subcommand(
      "lookup", "build and query times of the octree of spheres, compared with a plain grid");
  lookup->add_option("--sizes", lookups.sizes, "spheres")->check(CLI::Range(1u, 1u << 22));
  lookup->add_option("--queries", lookups.queries, "points to look up")
      ->check(CLI::Range(1u, 1u << 22))
      ->capture_default_str();
  lookup->add_option("--seed", lookups.seed, "seed of spheres and points")->capture_default_str();
  add_measurement_options(lookup, lookups, 1);

  tools::InterpolationArguments interpolations;
  CLI::App* interpolation = app.add_subcommand(
      "interpolation",
      "lookups per second in the irradiance cache of a scene, with and without removal of overlapping "
      "records");
  add_scene_options(interpolation, interpolations);
  interpolation->add_option("--reference", interpolations.reference,
                            "converged EXR of the same picture: adds errors");
  add_measurement_options(interpolation, interpolations, 1);

  tools::MixArguments mixes;
  CLI::App* mix = app.add_subcommand(
      "mix", "time until another light mix of a scene is shown, and the cost of tracking light groups");
  add_scene_options(mix, mixes);
  mix->add_option("--keep", mixes.keep, "how groups are tracked, as relight.enabled: compact or on")
      ->check(CLI::IsMember({"compact", "on"}))
      ->capture_default_str();
  add_measurement_options(mix, mixes, 1);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 1;
  }
  if (*sort) return tools::measure_sort(sorts);
  if (*lookup) return tools::measure_lookup(lookups);
  if (*interpolation) return tools::measure_interpolation(interpolations);
  return tools::measure_mix(mixes);
}

}  // namespace

int main(int argc, char** argv) {
  lucerna::separate_large_allocations();
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "lucerna-tools: %s\n", e.what());
    return 1;
  }
}
