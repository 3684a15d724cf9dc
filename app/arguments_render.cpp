// lucerna render: a scene to files.
#include "app/arguments.h"
#include "app/verbs.h"
#include "commands/lens.h"
#include "scene/range.h"
#include "solvers/registry.h"

namespace lucerna::app {
namespace {

void add_files(CLI::App* verb, RenderArguments& a) {
  verb->add_option("SCENE", a.scene, "glTF scene")->required();
  verb->add_option("-o,--output", a.outputs,
                   "OUT.exr or OUT.png; can be given several times, or not at all if --stats or --ledger is")
      ->allow_extra_args(false);
  verb->add_flag(
      "--filter", a.filter,
      "filter the finished picture: a PNG shows the filtered picture, an EXR has it in separate layers "
      "(filtered, filtered.primary, ..., filtered.error) beside the samples, and --stats reports its error");
  verb->add_option(
          "--tev", a.tev,
          "HOST:PORT: send all layers to a running tev, or a viewer with its protocol, during the render "
          "[127.0.0.1:14158]; the render goes on without one")
      ->expected(0, 1);
  verb->add_option("--stats", a.stats, "write figures of the run as JSON")->check(named());
  verb->add_option("--ledger", a.ledger, "write time, rays and error during the render as CSV")
      ->check(named());
  verb->add_option(
          "--reference", a.reference,
          "converged EXR of the same picture: ledger and figures then contain the true error of the mean")
      ->check(named());
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    if (!solver->file) continue;
    verb->add_option("--" + solver->name + "-load", a.solver_load[solver->name],
                     "start with " + solver->file->content + " in this file, of the same scene and settings")
        ->check(named());
    verb->add_option("--" + solver->name + "-save", a.solver_save[solver->name],
                     "write " + solver->file->content + ", when complete")
        ->check(named());
  }
}

void add_camera(CLI::App* verb, RenderArguments& a) {
  verb->add_option("--camera", a.camera, "name of a scene camera, or its number from 1");
  verb->add_option(
          "--projection", a.projection,
          "of the camera, instead of the scene's: perspective; panorama, all directions by longitude "
          "and latitude (best twice as wide as high); fisheye, 180 degrees in a circle")
      ->check(CLI::IsMember(commands::projection_names()));
  verb->add_flag(
      "--upright", a.upright,
      "level the camera and shift the lens so that the middle of the picture stays: vertical lines "
      "become vertical");
  verb->add_option("--shift", a.shift, "RIGHT UP, shift of the lens in widths and heights of the picture")
      ->expected(2)
      ->check(finite() & CLI::Range(-scene::k_max_shift, scene::k_max_shift));
  verb->add_option("--f-number", a.f_number, "give the camera a lens, for depth of field; film 36 mm wide")
      ->check(finite() & CLI::Range(scene::k_least_f_number, scene::k_max_f_number));
  verb->add_option(
          "--focus", a.focus,
          "metres to the lens's plane of focus, along the view axis; by default the scene's, or else "
          "to the surface in the middle of the picture")
      ->check(finite() & CLI::Range(scene::k_least_focus, scene::k_max_coordinate));
  verb->add_option("--blades", a.blades, "corners of the lens's aperture, at least 3; 0: round")
      ->check(CLI::Range(int64_t(0), int64_t(scene::k_max_blades)));
  verb->add_option(
          "--turntable", a.turntable,
          "N pictures around what the camera looks at, in equal steps, counter-clockwise seen from above; "
          "OUT.png becomes OUT.0001.png and so on. Limits are for each picture")
      ->check(CLI::Range(1u, k_most_views));
}

void add_pixels_and_limits(CLI::App* verb, RenderArguments& a) {
  verb->add_option("--size", a.size, "picture, WIDTHxHEIGHT")->capture_default_str();
  verb->add_option("--region", a.region,
                   "X Y WIDTH HEIGHT: render only these pixels; an EXR stores them as its data window within "
                   "the picture, a PNG has black around them")
      ->expected(4);
  verb->add_option("--samples", a.samples, "samples per pixel; with --error, the maximum")
      ->check(CLI::Range(int64_t(1), int64_t(1) << 20));
  verb->add_option(
      "--error", a.error,
      "target error as seen of every tile, such as 0.02: tiles above it get more samples. The error is "
      "relative to the light around each pixel; pixels that the exposure (film.ev) shows as white or black "
      "have none. A render ends at the first of --error, --samples and --time that it reaches. With --time "
      "the others apply only if given; without it the number of samples always does (with --error "
      "sampling.max_samples). With --filter: target error of the filtered picture, over its mean luminance; "
      "all pixels then get the same number of samples");
  verb->add_option(
      "--time", a.seconds,
      "stop after this many seconds, of which solvers prepare for half, at most three quarters, or earlier "
      "at --error or a number of samples that is given (also by --set or the scene). Alone, and "
      "without sampling.* there, samples go where they lower the error most; without components.* and "
      "relight.* too, the program chooses the solvers (auto)");
}

void add_recording(CLI::App* verb, RenderArguments& a) {
  verb->add_option("--record-paths", a.record_paths,
                   "OUT.lpath: record paths of the finished picture, by tracing them again; 'lucerna paths' "
                   "searches them")
      ->check(named());
  verb->add_option("--record-every", a.record_every, "record every n-th path")
      ->check(CLI::Range(uint64_t(1), uint64_t(1) << 31))
      ->capture_default_str();
  verb->add_option("--record-over", a.record_over, "record only paths that contribute a luminance above this")
      ->check(finite() & CLI::NonNegativeNumber);
  verb->add_option("--record-region", a.record_region, "X Y WIDTH HEIGHT: record only these pixels")
      ->expected(4);
}

}  // namespace

Verb add_render(CLI::App& app, Common& common) {
  const auto arguments = std::make_shared<RenderArguments>();
  RenderArguments& a = *arguments;
  CLI::App* verb = app.add_subcommand("render", "render a scene to files, without a window");
  add_files(verb, a);
  add_pixels_and_limits(verb, a);
  add_camera(verb, a);
  add_recording(verb, a);
  verb->add_option("--set", a.set, "KEY=VALUE; see below")->allow_extra_args(false);
  verb->add_option("--seed", a.seed, "seed of all random numbers")
      ->check(CLI::Range(int64_t(0), int64_t(4294967295)));
  verb->add_option("--device", a.device, k_device_help);
  verb->add_flag("--quiet", a.quiet, "no progress line");
  add_scene_options(*verb, common);
  const auto run = runs(render, arguments, common);
  return {verb, run, settings_help()};
}

}  // namespace lucerna::app
