// Parses the command line and runs the verb.
#include "app/program.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "app/interrupt.h"
#include "app/verbs.h"
#include "base/error.h"
#include "base/huge_pages.h"
#include "base/log.h"
#include "bench/matrix.h"
#include "commands/lens.h"
#include "commands/script.h"
#include "plan/settings.h"
#include "scene/range.h"
#include "solvers/registry.h"
#include "ui/viewer.h"

namespace lucerna::app {
namespace {

constexpr double k_gib = 1024.0 * 1024 * 1024;

std::string settings_help() {
  std::string text = "\nSettings for --set KEY=VALUE (and settings.json beside a scene):\n";
  for (const OptionInfo& o : plan::options()) {
    const std::string range = describe_values(o);
    text +=
        fmt::format("  {:<24}{} [{}] {}\n", o.key, o.help, o.fallback.empty() ? "none" : o.fallback, range);
  }
  return text;
}

/// Rejects NaN, which CLI11's ranges accept.
CLI::Validator finite() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0;
        return CLI::detail::lexical_cast(text, value) && std::isfinite(value)
                   ? std::string()
                   : fmt::format("'{}': expected a finite number", text);
      },
      "");
}

/// Rejects an empty name, which is usually an unset shell variable.
CLI::Validator named() {
  return CLI::Validator(
      [](std::string& text) {
        return text.empty() ? std::string("'': expected a file name") : std::string();
      },
      "");
}

/// The command line: the options of each verb, and the chosen verb.
class Program {
 public:
  Program();
  int run(int argc, char** argv);

 private:
  void add_viewer();
  void add_render();
  void add_small_verbs();
  void add_path_verb();
  void add_script_verbs();
  void add_bench();
  void add_bench_rays();
  void add_bench_latency();
  void add_bench_photons();
  void add_bench_interiors();
  void add_bench_auto();
  void add_rooms_options(CLI::App* verb, BenchInteriorsArguments& arguments);
  void add_scene_options(CLI::App* verb);
  int view();

  CLI::App app_{"Lucerna: interactive lookdev viewer for global illumination, component by component"};
  std::string scene_, device_, script_;
  std::vector<std::string> set_;
  bool verbose_ = false, stay_ = false;
  scene::LoadOptions scenes_;
  double scene_memory_ = double(scene::k_scene_bytes) / k_gib;

  CLI::App *render_ = nullptr, *info_ = nullptr, *convert_ = nullptr, *devices_ = nullptr,
           *compare_ = nullptr, *paths_ = nullptr, *bench_ = nullptr, *rays_ = nullptr, *latency_ = nullptr,
           *photons_ = nullptr, *interiors_ = nullptr, *auto_ = nullptr, *scripts_ = nullptr,
           *help_ = nullptr;
  RenderArguments r;
  InfoArguments i;
  ConvertArguments v;
  bool devices_json_ = false;
  CompareArguments c;
  PathsArguments p;
  ScriptArguments s;
  std::string topic_;
  BenchArguments bm;
  BenchRaysArguments b;
  BenchLatencyArguments bt;
  BenchPhotonsArguments bp;
  BenchInteriorsArguments bn, ba;
};

constexpr const char* k_device_help = "device: index, part of a name, cpu or gpu (also LUCERNA_DEVICE)";

Program::Program() {
  app_.set_version_flag("--version", LUCERNA_VERSION);
  add_viewer();
  add_render();
  add_small_verbs();
  add_path_verb();
  add_script_verbs();
  add_bench();
  add_bench_rays();
  add_bench_latency();
  add_bench_photons();
  add_bench_interiors();
  add_bench_auto();
  app_.require_subcommand(0, 1);
  // Footers come last: a new verb inherits the footer of its parent.
  app_.footer(settings_help());
  render_->footer(settings_help());
  paths_->footer(describe_path_fields());
  bench_->footer(bench::k_matrix_help);
}

void Program::add_viewer() {
  app_.add_option("SCENE", scene_, "glTF scene (.gltf or .glb) to open in the viewer");
  app_.add_option("--device", device_, k_device_help);
  app_.add_option("--set", set_, "viewer: KEY=VALUE; see below")->allow_extra_args(false);
  app_.add_option("--script", script_,
                  "viewer: file with commands, one per line; 'help' in the console lists them. After its "
                  "last line the program ends, with 1 after an error")
      ->check(named());
  app_.add_flag("-v,--verbose", verbose_, "print debug messages to standard error");
  app_.add_flag("--stay", stay_, "viewer: keep the window open after the script");
  add_scene_options(&app_);
}

void Program::add_scene_options(CLI::App* verb) {
  verb->add_flag("--allow-outside", scenes_.outside,
                 "allow scenes to read files outside their folder (\"..\", absolute paths, symbolic links)");
  verb->add_option("--scene-memory", scene_memory_,
                   "memory limit in GiB for a scene's files, images and geometry, counting every instance; "
                   "larger scenes are refused")
      ->check(finite() & CLI::Range(0.001, 1e6))
      ->capture_default_str();
}

void Program::add_render() {
  render_ = app_.add_subcommand("render", "render a scene to files, without a window");
  render_->add_option("SCENE", r.scene, "glTF scene")->required();
  render_
      ->add_option("-o,--output", r.outputs,
                   "OUT.exr or OUT.png; can be given several times, or not at all if --stats or --ledger is")
      ->allow_extra_args(false);
  render_->add_option("--size", r.size, "picture, WIDTHxHEIGHT")->capture_default_str();
  render_->add_option("--camera", r.camera, "name of a scene camera, or its number from 1");
  render_
      ->add_option("--f-number", r.f_number, "gives the camera a lens, for depth of field; film 36 mm wide")
      ->check(finite() & CLI::Range(scene::k_least_f_number, scene::k_max_f_number));
  render_
      ->add_option(
          "--focus", r.focus,
          "metres to the lens's plane of focus, along the view axis; by default the scene's, or else "
          "to the surface in the middle of the picture")
      ->check(finite() & CLI::Range(scene::k_least_focus, scene::k_max_coordinate));
  render_
      ->add_option(
          "--projection", r.projection,
          "of the camera, instead of the scene's: perspective; panorama, all directions by longitude "
          "and latitude (best twice as wide as high); fisheye, 180 degrees in a circle")
      ->check(CLI::IsMember(commands::projection_names()));
  render_->add_flag(
      "--upright", r.upright,
      "level the camera and shift the lens so that the middle of the picture stays: vertical lines "
      "become vertical");
  render_->add_option("--shift", r.shift, "RIGHT UP, shift of the lens in widths and heights of the picture")
      ->expected(2)
      ->check(finite() & CLI::Range(-scene::k_max_shift, scene::k_max_shift));
  render_->add_option("--blades", r.blades, "corners of the lens's aperture, at least 3; 0: round")
      ->check(CLI::Range(int64_t(0), int64_t(scene::k_max_blades)));
  render_->add_option(
      "--error", r.error,
      "target error as seen of every tile, such as 0.02: tiles above it get more samples. The error is "
      "relative to the light around each pixel; pixels that the exposure (film.ev) shows as white or black "
      "have none. A render ends at the first of --error, --samples and --time that it reaches. With --time "
      "the others apply only if given; without it the number of samples always does (with --error "
      "sampling.max_samples). With --filter: target error of the filtered picture, over its mean luminance; "
      "all "
      "pixels then get the same number of samples");
  render_->add_option("--samples", r.samples, "samples per pixel; with --error, the maximum")
      ->check(CLI::Range(int64_t(1), int64_t(1) << 20));
  render_->add_option("--time", r.seconds,
                      "stop after this many seconds, of which solvers prepare for at most half, or earlier "
                      "at --error or a number of samples that is given (also by --set or the scene)");
  render_->add_option("--seed", r.seed, "seed of all random numbers")
      ->check(CLI::Range(int64_t(0), int64_t(4294967295)));
  render_
      ->add_option("--record-paths", r.record_paths,
                   "OUT.lpath: record paths of the finished picture, by tracing them again; 'lucerna paths' "
                   "searches them")
      ->check(named());
  render_->add_option("--record-every", r.record_every, "record every n-th path")
      ->check(CLI::Range(uint64_t(1), uint64_t(1) << 31))
      ->capture_default_str();
  render_
      ->add_option("--record-over", r.record_over,
                   "record only paths that bring more light than this (luminance)")
      ->check(finite() & CLI::NonNegativeNumber);
  render_->add_option("--record-region", r.record_region, "X Y WIDTH HEIGHT: record only these pixels")
      ->expected(4);
  render_
      ->add_option("--region", r.region,
                   "X Y WIDTH HEIGHT: render only these pixels; an EXR stores them as its data window within "
                   "the picture, a PNG has black around them")
      ->expected(4);
  render_
      ->add_option(
          "--turntable", r.turntable,
          "N pictures around what the camera looks at, in equal steps, counter-clockwise seen from above; "
          "OUT.png becomes OUT.0001.png and so on. Limits are for each picture")
      ->check(CLI::Range(1u, k_most_views));
  render_
      ->add_option(
          "--tev", r.tev,
          "HOST:PORT: send all layers to a running tev, or a viewer with its protocol, during the render "
          "[127.0.0.1:14158]; the render goes on without one")
      ->expected(0, 1);
  render_->add_option("--set", r.set, "KEY=VALUE; see below")->allow_extra_args(false);
  render_->add_option("--device", r.device, k_device_help);
  render_->add_option("--ledger", r.ledger, "write time, rays and error during the render as CSV")
      ->check(named());
  render_
      ->add_option(
          "--reference", r.reference,
          "converged EXR of the same picture: ledger and figures then contain the true error of the mean")
      ->check(named());
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    if (!solver->file) continue;
    render_
        ->add_option("--" + solver->name + "-load", r.solver_load[solver->name],
                     "start with " + solver->file->content + " in this file, of the same scene and settings")
        ->check(named());
    render_
        ->add_option("--" + solver->name + "-save", r.solver_save[solver->name],
                     "write " + solver->file->content + ", when complete")
        ->check(named());
  }
  render_->add_option("--stats", r.stats, "write figures of the run as JSON")->check(named());
  render_->add_flag(
      "--filter", r.filter,
      "filter the finished picture: a PNG shows the filtered picture, an EXR has it in separate layers "
      "(filtered, filtered.primary, ..., filtered.error) beside the samples, and --stats reports its error");
  render_->add_flag("--quiet", r.quiet, "no progress line");
  add_scene_options(render_);
}

void Program::add_small_verbs() {
  info_ =
      app_.add_subcommand("info", "describe a scene: contents, and effects that it calls for, with evidence");
  info_->add_option("SCENE", i.scene, "glTF scene")->required();
  info_->add_flag("--json", i.json, "as JSON");
  info_->add_flag("--pilot", i.pilot,
                  "trace a few samples: light, noise and the solver that components.X=auto chooses for each "
                  "component, with its reason, and a forecast");
  info_->add_flag("--cost", i.cost,
                  "trace small pictures without each of the effects: what it costs per sample, the light and "
                  "the noise that are in it, and how much of it is seen; about a minute");
  info_->add_option("--size", i.size, "--pilot, --cost: size of the picture, WIDTHxHEIGHT")
      ->capture_default_str();
  info_->add_option("--camera", i.camera,
                    "--pilot, --cost: name of a camera of the scene, or its number from 1");
  info_->add_option("--set", i.set, "--pilot, --cost: KEY=VALUE")->allow_extra_args(false);
  info_->add_option("--device", i.device, k_device_help);
  add_scene_options(info_);
  convert_ = app_.add_subcommand(
      "convert", "write a scene as another .gltf or .glb file; what Lucerna does not know is kept");
  convert_->add_option("SCENE", v.scene, "glTF scene")->required();
  convert_->add_option("OUTPUT", v.output, "file to write: .gltf or .glb")->required()->check(named());
  convert_->add_flag("--replace", v.replace, "writes over the scene itself");
  add_scene_options(convert_);
  devices_ = app_.add_subcommand("devices", "list the Vulkan devices");
  devices_->add_flag("--json", devices_json_, "as JSON");
  compare_ = app_.add_subcommand("compare", "compare two images");
  compare_->add_option("A", c.a, "image")->required();
  compare_->add_option("B", c.b, "reference")->required();
  compare_->add_option("--layer", c.layer, "layer instead of R, G, B: primary, secondary, ...");
  compare_->add_flag("--json", c.json, "as JSON");
  compare_
      ->add_option("--max-relmse", c.max_relmse,
                   "exit with 1 if the relative MSE is above this, or a value of any layer is not finite")
      ->check(finite() & CLI::Range(0.0, 1e300));
}

void Program::add_path_verb() {
  paths_ = app_.add_subcommand("paths", "search recorded paths (render --record-paths)");
  paths_->add_option("FILE", p.file, "recorded paths (.lpath)")->required();
  paths_->add_option(
      "--where", p.where,
      "rows that are wanted: FIELD == != < <= > >= VALUE, word ~ 'E[SG]*DL', joined by and, or, "
      "not, ( )");
  paths_->add_option("--group-by", p.group_by, "sums per value of this field");
  paths_->add_flag("--csv", p.csv, "all rows, or sums, as CSV");
  paths_->add_flag("--json", p.json, "... as JSON");
  paths_->add_option("--most", p.most, "rows of the table, the brightest first")->capture_default_str();
}

void Program::add_script_verbs() {
  scripts_ = app_.add_subcommand(
      "script", "run scripts as tests: status 0 if all passed, 1 if one failed, 2 if one cannot be read");
  scripts_
      ->add_option(
          "FILE", s.words,
          "scripts (.lucerna), and variables NAME=VALUE for ${NAME} in them; see 'lucerna help scripts'")
      ->required();
  scripts_->add_flag(
      "--headless", s.headless,
      "use no display: the session alone, or an X server of its own (xvfb-run) where a script needs "
      "the window");
  scripts_
      ->add_option(
          "--report", s.report,
          "folder for junit.xml, report.html and pictures that differ [lucerna-report, made if a picture "
          "differs]")
      ->check(named());
  scripts_->add_option("--device", s.device, k_device_help);
  add_scene_options(scripts_);
  help_ = app_.add_subcommand("help", "explain a command of scripts and of the console, or list them");
  help_->add_option("COMMAND", topic_, "a command, a setting, or one of settings, values, scripts");
}

void Program::add_bench() {
  bench_ = app_.add_subcommand("bench",
                               "measure error over time: scenes x settings x budgets, with a report page");
  bench_->require_subcommand(0, 1);
  bench_->add_option("MATRIX", bm.matrix, "matrix file (JSON), see below");
  for (const bench::BuiltinInfo& info : bench::builtin_matrices())
    bench_->add_flag_callback(
        "--" + info.name, [this, name = info.name] { bm.built_in.push_back(name); }, info.help);
  bench_->add_option("--report", bm.report, "report folder; a folder of the same bench is continued")
      ->capture_default_str();
  bench_->add_option("--references", bm.references,
                     "folder of the reference pictures [references in the report folder]");
  bench_->add_option("--repeats", bm.repeats, "renders of each cell, instead of the matrix's number")
      ->check(CLI::Range(1, 100));
  bench_->add_option("--device", bm.device, k_device_help);
  bench_->add_flag("--quiet", bm.quiet, "no progress line");
  bench_->add_option("--compare", bm.compare, "OLD NEW: ratios of two reports (folders or report.json)")
      ->expected(2);
  bench_->add_option("--page", bm.page, "write report.html of a report folder again, without measuring");
  add_scene_options(bench_);
}

void Program::add_bench_rays() {
  rays_ = bench_->add_subcommand("rays", "rays per second of every tracer, and of unmodified Embree");
  rays_->add_option("SCENE", b.scene, "glTF scene")->required();
  rays_->add_option("--camera", b.camera, "name of a scene camera, or its number from 1");
  rays_->add_option("--rays", b.rays, "primary rays")
      ->check(CLI::Range(64u, 1u << 22))
      ->capture_default_str();
  rays_->add_option("--repeats", b.repeats, "measurements of each figure")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  rays_->add_option("--width", b.width, "width of the path-traced frame")
      ->check(CLI::Range(1u, 16384u))
      ->capture_default_str();
  rays_->add_option("--height", b.height, "its height")->check(CLI::Range(1u, 16384u))->capture_default_str();
  rays_->add_option("--samples", b.samples, "its samples per pixel; 0: no frame")
      ->check(CLI::Range(0u, 1u << 20))
      ->capture_default_str();
  rays_->add_option("--seed", b.seed, "seed of the rays")->capture_default_str();
  rays_->add_option("--flat", b.flat, "write the flattened scene for lucerna-raybench")->check(named());
  rays_->add_option("--device", b.device, k_device_help);
  rays_->add_flag("--json", b.json, "as JSON");
  add_scene_options(rays_);
}

void Program::add_bench_latency() {
  latency_ = bench_->add_subcommand(
      "latency", "seconds until the window shows a usable picture after an edit (--latency is the same)");
  latency_->add_option("SCENES", bt.scenes, "glTF scenes, or names of folders in scenes/")->required();
  latency_
      ->add_option("--edits", bt.edits,
                   "some of load, strength, move (of the brightest lamp), sky (rotation), material, undo, "
                   "camera, solver (switch); each on top of those before; orbit: pictures per second while "
                   "the camera moves")
      ->delimiter(',');
  latency_->add_option("--solvers", bt.solvers, "of secondary and tertiary light [path,cache]")
      ->delimiter(',');
  latency_->add_option("--size", bt.size, "picture, WIDTHxHEIGHT")->capture_default_str();
  latency_->add_option("--seconds", bt.seconds, "seconds to watch each edit")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  latency_
      ->add_option("--repeats", bt.repeats,
                   "sessions of each scene and solver; the median of each figure is reported")
      ->check(CLI::Range(1u, 1000u))
      ->capture_default_str();
  latency_->add_option("--seed", bt.seed, "seed of the edits' amounts; 0: fixed amounts")
      ->capture_default_str();
  latency_->add_option("--settle", bt.settle, "maximum seconds to wait before an edit for a finished picture")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  latency_
      ->add_option("--reference-samples", bt.reference_samples,
                   "samples per pixel of the reference pictures, in two halves for their noise")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
  latency_
      ->add_option(
          "--reference-solver", bt.reference_solver,
          "solver of their secondary and tertiary light; cache: far less noise, and a bias of a few per cent")
      ->check(CLI::IsMember({"path", "cache"}))
      ->capture_default_str();
  latency_->add_option("--references", bt.references, "folder that keeps the reference pictures")
      ->capture_default_str();
  latency_->add_option("--pictures", bt.pictures, "folder for the pictures shown at 0.3, 1, 3, 10 and 30 s");
  latency_->add_option("--set", bt.set, "KEY=VALUE, as of the viewer")->allow_extra_args(false);
  latency_->add_option("--json", bt.json, "file to write the figures to");
  latency_->add_option("--device", bt.device, k_device_help);
  add_scene_options(latency_);
}

void Program::add_bench_photons() {
  photons_ = bench_->add_subcommand("photons",
                                    "how photons' errors fall with passes and radii, and the cost of passes; "
                                    "ten minutes (--photons is the same)");
  bench::PhotonBenchOptions& o = bp.options;
  photons_
      ->add_option("--parts", o.parts,
                   "some of slopes (of noise and bias), rounds (their cost by light paths), lamps (by their "
                   "number), free (without surfaces that focus light) [all]")
      ->delimiter(',')
      ->check(CLI::IsMember(
          std::vector<std::string>(bench::k_photon_parts.begin(), bench::k_photon_parts.end())));
  photons_->add_option("--report", bp.report, "report folder; a folder of the same bench is continued")
      ->capture_default_str();
  photons_->add_option("--side", o.side, "pixels along a side of the pictures for slopes")
      ->check(CLI::Range(8u, 1024u))
      ->capture_default_str();
  photons_->add_option("--seeds", o.seeds, "renders of each, with different seeds")
      ->check(CLI::Range(3u, 64u))
      ->capture_default_str();
  photons_->add_option("--rounds", o.rounds, "passes of each")
      ->check(CLI::Range(8u, 65536u))
      ->capture_default_str();
  photons_
      ->add_option("--reference-samples", o.reference_samples,
                   "samples per pixel of each of the references, one for every render")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
  photons_->add_option("--paths", o.paths, "light paths per pass [1e4 to 1e7]")
      ->delimiter(',')
      ->check(CLI::Range(1u, 1u << 24));
  photons_->add_option("--lamps", o.lamps, "numbers of lamps [1,10,100,1000]")
      ->delimiter(',')
      ->check(CLI::Range(1u, 100000u));
  photons_->add_option("--repeats", o.repeats, "passes that are timed")
      ->check(CLI::Range(1u, 1000u))
      ->capture_default_str();
  photons_->add_option("--pairs", o.pairs, "renders with and without photons where they are not needed")
      ->check(CLI::Range(1u, 1000u))
      ->capture_default_str();
  photons_->add_flag("--quiet", bp.quiet, "no progress line");
  photons_->add_option("--device", o.device, k_device_help);
}

void Program::add_bench_interiors() {
  interiors_ = bench_->add_subcommand(
      "interiors",
      "error as seen of rooms after 4, 15 and 60 s, and the time to 5, 2 and 1 %, by path tracing, learned "
      "lights, cached light and both; hours (--interiors is the same)");
  add_rooms_options(interiors_, bn);
  bench::InteriorsOptions& o = bn.options;
  interiors_
      ->add_option("--against", o.against,
                   "another lucerna, such as the previous commit in a separate checkout: rendered "
                   "alternately with this one, every setting beside its counterpart")
      ->check(named());
  interiors_->add_flag(
      "--quick", o.quick,
      "three rooms in small pictures after 0.8 and 4 s: two to three minutes, plus their references once");
}

void Program::add_bench_auto() {
  auto_ = bench_->add_subcommand(
      "auto",
      "solvers chosen for the scene (components.X=auto) against fixed choices: error as seen of all scenes "
      "after 10 and 60 s, and the time to 5, 2 and 1 %; hours (--auto is the same)");
  ba.options.every_solver = true;
  ba.report = "auto-report";
  add_rooms_options(auto_, ba);
}

void Program::add_rooms_options(CLI::App* verb, BenchInteriorsArguments& arguments) {
  bench::InteriorsOptions& o = arguments.options;
  const bool all = o.every_solver;
  const std::vector<std::string>& settings = all ? bench::k_auto_settings : bench::k_interior_settings;
  verb->add_option("--scenes", o.folders,
                   fmt::format("folder with glTF scenes, each of which is measured, or one such file; can be "
                               "given several times [the program's own {}]",
                               all ? "scenes" : "interiors"))
      ->allow_extra_args(false)
      ->check(named());
  verb->add_option("--report", arguments.report, "report folder; a folder of the same bench is continued")
      ->capture_default_str();
  verb->add_option("--references", arguments.references,
                   "folder that keeps the reference pictures, for this and later benches")
      ->capture_default_str()
      ->check(named());
  verb->add_option("--settings", o.settings,
                   fmt::format("some of {}; the first is the baseline [all]", fmt::join(settings, ", ")))
      ->delimiter(',')
      ->check(CLI::IsMember(settings));
  verb->add_option("--seconds", o.seconds,
                   all ? "seconds per render [10,60]" : "seconds per render [4,15,60; quick 0.8,4]")
      ->delimiter(',')
      ->check(finite() & CLI::Range(0.01, 1e6));
  verb->add_option("--samples", o.samples,
                   "samples per pixel that end renders instead of time: then errors do not depend on the "
                   "machine")
      ->delimiter(',')
      ->check(CLI::Range(1u, 1u << 20))
      ->excludes("--seconds");
  verb->add_option("--size", o.size,
                   fmt::format("picture, WIDTHxHEIGHT; swapped for upright cameras [320x180{}]",
                               all ? "" : "; quick 192x108"));
  verb->add_option("--repeats", o.repeats,
                   fmt::format("renders of each, with different seeds [{}]", all ? "1" : "3; quick 2"))
      ->check(CLI::Range(1, 100));
  verb->add_option("--reference-samples", o.reference_samples,
                   fmt::format("samples per pixel of the reference pictures, in two halves [2048{}]",
                               all ? "" : "; quick 1024"))
      ->check(CLI::Range(2u, 1u << 20));
  verb->add_flag("--quiet", arguments.quiet, "no progress line");
  verb->add_option("--device", arguments.device, k_device_help);
  add_scene_options(verb);
}

int Program::run(int argc, char** argv) {
  // They are also accepted in the form of built-in matrices.
  std::string latency = "latency", photons = "photons", interiors = "interiors", autos = "auto";
  for (std::string* name : {&latency, &photons, &interiors, &autos})
    if (argc > 2 && argv[1] == std::string("bench") && argv[2] == "--" + *name) argv[2] = name->data();
  try {
    app_.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app_.exit(e) == 0 ? 0 : 1;
  }
  if (verbose_) log::set_console_level(log::Level::debug);
  scenes_.most_bytes = uint64_t(scene_memory_ * k_gib);
  r.scenes = b.scenes = bm.scenes = bt.load = bn.scenes = ba.scenes = scenes_;
  for (std::string* device :
       {&r.device, &b.device, &bm.device, &bt.device, &bp.options.device, &bn.device, &ba.device})
    if (device->empty()) *device = device_;
  if (*render_) return render(r);
  if (*info_) {
    i.scenes = scenes_;
    return info(i);
  }
  if (*convert_) {
    v.scenes = scenes_;
    return convert(v);
  }
  if (*devices_) return devices(devices_json_);
  if (*compare_) return compare(c);
  if (*paths_) return search_paths(p);
  if (*help_) return help(topic_);
  if (*scripts_) {
    s.scenes = scenes_;
    if (s.device.empty()) s.device = device_;
    s.typed.assign(argv + 1, argv + argc);
    return run_scripts(s);
  }
  if (*rays_) return bench_rays(b);
  if (*latency_) return bench_latency(bt);
  const auto typed = [&] {
    std::string line;
    for (int i = 0; i < argc; ++i) line += std::string(i ? " " : "") + (i ? argv[i] : "lucerna");
    return line;
  };
  if (*photons_) {
    bp.command = typed();
    return bench_photons(bp);
  }
  if (*interiors_) {
    bn.command = typed();
    return bench_interiors(bn);
  }
  if (*auto_) {
    ba.command = typed();
    return bench_interiors(ba);
  }
  if (*bench_) {
    bm.command = typed();
    return bench_matrix(bm);
  }
  return view();
}

int Program::view() {
  // From here on, so that saves in progress finish and the window's state is saved.
  const Interrupt interrupt;
  ui::ViewerOptions options;
  options.scene = scene_;
  options.set = set_;
  options.stay = stay_;
  if (!script_.empty()) {
    options.script = commands::read_script(script_);
    if (options.script.empty()) options.script.emplace_back();  // an empty script ends too
    options.script_name = script_;
  }
  session::Session session({.device = device_, .validation = false, .shaders = {}, .scenes = scenes_});
  options.interrupted = [&] { return interrupt.signal() != 0; };
  const int status = ui::run_viewer(session, options);
  return interrupt.signal() ? interrupt.status() : status;
}

}  // namespace

int run(int argc, char** argv) {
  separate_large_allocations();
  try {
    return Program().run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "lucerna: %s\n", e.what());
    return 1;
  }
}

}  // namespace lucerna::app
