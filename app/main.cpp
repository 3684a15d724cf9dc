// What a person starts: the viewer, or a batch verb.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "app/verbs.h"
#include "base/error.h"
#include "base/huge_pages.h"
#include "base/log.h"
#include "bench/matrix.h"
#include "plan/settings.h"
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

int main_checked(int argc, char** argv) {
  CLI::App app{"Lucerna: watch global illumination being computed, component by component"};
  app.set_version_flag("--version", LUCERNA_VERSION);
  app.footer(settings_help());
  std::string scene, device, script;
  bool verbose = false;
  app.add_option("SCENE", scene, "glTF scene (.gltf or .glb) to open in the viewer");
  app.add_option("--device", device, "device: index, part of a name, cpu or gpu (also LUCERNA_DEVICE)");
  std::vector<std::string> set;
  app.add_option("--set", set, "viewer: KEY=VALUE; see below")->allow_extra_args(false);
  app.add_option("--script", script,
                 "viewer: file with commands, one a line; 'help' under the log lists them. Its end ends the "
                 "program, with 1 after an error");
  app.add_flag("-v,--verbose", verbose, "say more on standard error");
  bool stay = false;
  // CLI11's ranges let a NaN through.
  const CLI::Validator finite(
      [](std::string& text) {
        double value = 0;
        return CLI::detail::lexical_cast(text, value) && std::isfinite(value)
                   ? std::string()
                   : fmt::format("'{}': expected a finite number", text);
      },
      "");
  app.add_flag("--stay", stay, "viewer: the window stays when the script has ended");
  scene::LoadOptions scenes;
  double scene_memory = double(scene::k_scene_bytes) / k_gib;
  const auto add_scene_options = [&](CLI::App* verb) {
    verb->add_flag("--allow-outside", scenes.outside,
                   "let scenes name files outside their folder (\"..\", absolute paths, symbolic links)");
    verb->add_option("--scene-memory", scene_memory,
                     "GiB that a scene's files, images and geometry may take, every instance counted; a "
                     "scene that asks for more is refused")
        ->check(finite & CLI::Range(0.001, 1e6))
        ->capture_default_str();
  };
  add_scene_options(&app);

  RenderArguments r;
  CLI::App* render_verb = app.add_subcommand("render", "render a scene to files, without a window");
  render_verb->add_option("SCENE", r.scene, "glTF scene")->required();
  render_verb
      ->add_option(
          "-o,--output", r.outputs,
          "OUT.exr or OUT.png; may be given several times, or not at all where --stats or --ledger is")
      ->allow_extra_args(false);
  render_verb->add_option("--size", r.size, "picture, WIDTHxHEIGHT")->capture_default_str();
  render_verb->add_option("--camera", r.camera, "name of a scene camera");
  render_verb->add_option(
      "--error", r.error,
      "relative error that every tile is to reach, such as 0.02: samples go where it is not reached yet");
  render_verb->add_option("--samples", r.samples, "samples a pixel; with --error, the most that one may get")
      ->check(CLI::Range(int64_t(1), int64_t(1) << 20));
  render_verb->add_option("--time", r.seconds, "stop after this many seconds");
  render_verb->add_option("--seed", r.seed, "seed of all random decisions")
      ->check(CLI::Range(int64_t(0), int64_t(4294967295)));
  render_verb->add_option("--set", r.set, "KEY=VALUE; see below")->allow_extra_args(false);
  render_verb->add_option("--device", r.device, "as above");
  render_verb->add_option("--ledger", r.ledger, "time, rays and error as they went on, as CSV");
  render_verb->add_option("--reference", r.reference,
                          "EXR of the same picture, converged: ledger and figures then tell the true error");
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    if (!solver->file) continue;
    render_verb->add_option(
        "--" + solver->name + "-load", r.solver_load[solver->name],
        "begin with " + solver->file->content + " in this file, of the same scene and settings");
    render_verb->add_option("--" + solver->name + "-save", r.solver_save[solver->name],
                            "write " + solver->file->content + ", once they are complete");
  }
  render_verb->add_option("--stats", r.stats, "write figures of the run as JSON");
  render_verb->add_flag("--quiet", r.quiet, "no progress line");
  add_scene_options(render_verb);
  render_verb->footer(settings_help());

  std::string info_scene;
  bool info_json = false, devices_json = false;
  CLI::App* info_verb = app.add_subcommand("info", "say what is in a scene");
  info_verb->add_option("SCENE", info_scene, "glTF scene")->required();
  info_verb->add_flag("--json", info_json, "as JSON");
  add_scene_options(info_verb);
  CLI::App* devices_verb = app.add_subcommand("devices", "list the Vulkan devices");
  devices_verb->add_flag("--json", devices_json, "as JSON");

  CompareArguments c;
  CLI::App* compare_verb = app.add_subcommand("compare", "compare two images");
  compare_verb->add_option("A", c.a, "image")->required();
  compare_verb->add_option("B", c.b, "reference")->required();
  compare_verb->add_option("--layer", c.layer, "layer instead of R, G, B: primary, secondary, ...");
  compare_verb->add_flag("--json", c.json, "as JSON");
  compare_verb->add_option("--max-relmse", c.max_relmse, "exit with 1 when the relative MSE is above this")
      ->check(finite);

  BenchRaysArguments b;
  BenchArguments bm;
  CLI::App* bench_verb = app.add_subcommand(
      "bench", "measure what accuracy costs in time: scenes x settings x budgets, with a page to read");
  bench_verb->require_subcommand(0, 1);
  bench_verb->add_option("MATRIX", bm.matrix, "matrix file (JSON), see below");
  for (const bench::BuiltinInfo& info : bench::builtin_matrices())
    bench_verb->add_flag_callback(
        "--" + info.name, [&bm, name = info.name] { bm.built_in.push_back(name); }, info.help);
  bench_verb->add_option("--report", bm.report, "folder to write to and to go on in; new, empty or a bench's")
      ->capture_default_str();
  bench_verb->add_option("--references", bm.references,
                         "folder of the reference pictures [references in the report folder]");
  bench_verb->add_option("--repeats", bm.repeats, "renders of each cell, instead of the matrix's")
      ->check(CLI::Range(1, 100));
  bench_verb->add_option("--device", bm.device, "as above");
  bench_verb->add_flag("--quiet", bm.quiet, "no progress");
  bench_verb->add_option("--compare", bm.compare, "OLD NEW: ratios of two reports (folders or report.json)")
      ->expected(2);
  bench_verb->add_option("--page", bm.page, "make report.html of a report folder again, measuring nothing");
  add_scene_options(bench_verb);
  bench_verb->footer(bench::k_matrix_help);
  CLI::App* rays_verb =
      bench_verb->add_subcommand("rays", "rays a second of every tracer, and of Embree as it comes");
  rays_verb->add_option("SCENE", b.scene, "glTF scene")->required();
  rays_verb->add_option("--camera", b.camera, "name of a scene camera");
  rays_verb->add_option("--rays", b.rays, "primary rays")
      ->check(CLI::Range(64u, 1u << 22))
      ->capture_default_str();
  rays_verb->add_option("--repeats", b.repeats, "measurements of each figure")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  rays_verb->add_option("--width", b.width, "width of the path-traced frame")
      ->check(CLI::Range(1u, 16384u))
      ->capture_default_str();
  rays_verb->add_option("--height", b.height, "its height")
      ->check(CLI::Range(1u, 16384u))
      ->capture_default_str();
  rays_verb->add_option("--samples", b.samples, "its samples a pixel; 0: no frame")
      ->check(CLI::Range(0u, 1u << 20))
      ->capture_default_str();
  rays_verb->add_option("--seed", b.seed, "seed of the rays")->capture_default_str();
  rays_verb->add_option("--flat", b.flat, "write the flattened scene for lucerna-raybench");
  rays_verb->add_option("--device", b.device, "as above");
  rays_verb->add_flag("--json", b.json, "as JSON");
  add_scene_options(rays_verb);
  // What the small benches share.
  const auto measured = [](CLI::App* verb, auto& a, int least_repeats, const char* seed_of) {
    verb->add_option("--repeats", a.repeats, "measurements of each figure")
        ->check(CLI::Range(least_repeats, 1000))
        ->capture_default_str();
    verb->add_option("--seed", a.seed, seed_of)->capture_default_str();
    verb->add_option("--json", a.json, "file to write the figures to");
    verb->add_option("--device", a.device, "as above");
  };
  BenchSortArguments bs;
  CLI::App* sort_verb = bench_verb->add_subcommand(
      "sort", "elements a second of prefix sum and radix sort on the device, and of the C++ library's");
  sort_verb->add_option("--sizes", bs.sizes, "elements to sort")->check(CLI::Range(1u, 1u << 22));
  measured(sort_verb, bs, 5, "seed of the keys");
  BenchLookupArguments bl;
  CLI::App* lookup_verb = bench_verb->add_subcommand(
      "lookup", "building the octree of spheres and asking it, against a plain grid");
  lookup_verb->add_option("--sizes", bl.sizes, "spheres")->check(CLI::Range(1u, 1u << 22));
  lookup_verb->add_option("--queries", bl.queries, "points to look up")
      ->check(CLI::Range(1u, 1u << 22))
      ->capture_default_str();
  measured(lookup_verb, bl, 1, "seed of spheres and points");
  BenchInterpolationArguments bi;
  CLI::App* interpolation_verb =
      bench_verb->add_subcommand("interpolation",
                                 "lookups a second in what solvers have prepared for a scene, by the ways of "
                                 "looking up that they offer");
  interpolation_verb->add_option("SCENE", bi.scene, "glTF scene")->required();
  interpolation_verb->add_option("--width", bi.width, "of the picture")
      ->check(CLI::Range(16u, 4096u))
      ->capture_default_str();
  interpolation_verb->add_option("--height", bi.height, "its height")
      ->check(CLI::Range(16u, 4096u))
      ->capture_default_str();
  interpolation_verb->add_option("--samples", bi.samples, "samples a pixel")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
  interpolation_verb->add_option("--set", bi.set, "KEY=VALUE, as of render")->allow_extra_args(false);
  interpolation_verb->add_option("--reference", bi.reference,
                                 "EXR of the same picture, converged: tells errors too");
  interpolation_verb->add_option("--repeats", bi.repeats, "measurements of each figure")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  interpolation_verb->add_option("--json", bi.json, "file to write the figures to");
  interpolation_verb->add_option("--device", bi.device, "as above");
  add_scene_options(interpolation_verb);
  app.require_subcommand(0, 1);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 1;
  }
  if (verbose) log::set_console_level(log::Level::info);
  scenes.most_bytes = uint64_t(scene_memory * k_gib);
  r.scenes = b.scenes = bi.scenes = bm.scenes = scenes;
  if (r.device.empty()) r.device = device;
  if (*render_verb) return render(r);
  if (*info_verb) return info(info_scene, info_json, scenes);
  if (*devices_verb) return devices(devices_json);
  if (*compare_verb) return compare(c);
  if (b.device.empty()) b.device = device;
  if (*rays_verb) return bench_rays(b);
  if (bs.device.empty()) bs.device = device;
  if (*sort_verb) return bench_sort(bs);
  if (bl.device.empty()) bl.device = device;
  if (*lookup_verb) return bench_lookup(bl);
  if (bi.device.empty()) bi.device = device;
  if (*interpolation_verb) return bench_interpolation(bi);
  if (*bench_verb) {
    if (bm.device.empty()) bm.device = device;
    for (int i = 0; i < argc; ++i) bm.command += std::string(i ? " " : "") + (i ? argv[i] : "lucerna");
    return bench_matrix(bm);
  }
  session::Session session({.device = device, .validation = false, .shaders = {}, .scenes = scenes});
  ui::ViewerOptions options;
  options.scene = scene;
  options.set = set;
  options.stay = stay;
  if (!script.empty()) {
    std::ifstream in(script);
    if (!in) throw Error(script, "cannot be read");
    for (std::string line; std::getline(in, line);) options.script.push_back(line);
    if (options.script.empty()) options.script.emplace_back();  // an empty script ends, too
    options.script_name = script;
  }
  return ui::run_viewer(session, options);
}

}  // namespace
}  // namespace lucerna::app

int main(int argc, char** argv) {
  lucerna::separate_large_allocations();
  try {
    return lucerna::app::main_checked(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "lucerna: %s\n", e.what());
    return 1;
  }
}
