// lucerna bench, with its verbs rays, latency and photons.
#include "app/arguments.h"
#include "app/verbs.h"
#include "bench/matrix.h"

namespace lucerna::app {
namespace {

Verb add_rays(CLI::App& parent, Common& common) {
  const auto arguments = std::make_shared<BenchRaysArguments>();
  BenchRaysArguments& a = *arguments;
  CLI::App* verb = parent.add_subcommand("rays", "rays per second of every tracer, and of unmodified Embree");
  verb->add_option("SCENE", a.scene, "glTF scene")->required();
  verb->add_option("--camera", a.camera, "name of a scene camera, or its number from 1");
  verb->add_option("--rays", a.rays, "primary rays")->check(CLI::Range(64u, 1u << 22))->capture_default_str();
  verb->add_option("--repeats", a.repeats, "measurements of each figure")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--width", a.width, "width of the path-traced frame")
      ->check(CLI::Range(1u, 16384u))
      ->capture_default_str();
  verb->add_option("--height", a.height, "its height")->check(CLI::Range(1u, 16384u))->capture_default_str();
  verb->add_option("--samples", a.samples, "its samples per pixel; 0: no frame")
      ->check(CLI::Range(0u, 1u << 20))
      ->capture_default_str();
  verb->add_option("--seed", a.seed, "seed of the rays")->capture_default_str();
  verb->add_option("--flat", a.flat, "write the flattened scene for lucerna-raybench")->check(named());
  verb->add_option("--device", a.device, k_device_help);
  verb->add_flag("--json", a.json, "as JSON");
  add_scene_options(*verb, common);
  const auto run = runs(bench_rays, arguments, common);
  return {verb, run};
}

Verb add_latency(CLI::App& parent, Common& common) {
  const auto arguments = std::make_shared<BenchLatencyArguments>();
  BenchLatencyArguments& a = *arguments;
  CLI::App* verb = parent.add_subcommand(
      "latency", "seconds until the window shows a usable picture after an edit (--latency is the same)");
  verb->add_option("SCENES", a.files, "glTF scenes, or names of folders in scenes/")->required();
  verb->add_option("--edits", a.edits,
                   "some of load, strength, move (of the brightest lamp), sky (rotation), material, undo, "
                   "camera, solver (switch); each on top of those before; orbit: pictures per second while "
                   "the camera moves")
      ->delimiter(',');
  verb->add_option("--solvers", a.solvers, "of secondary and tertiary light [path,cache]")->delimiter(',');
  verb->add_option("--size", a.size, "picture, WIDTHxHEIGHT")->capture_default_str();
  verb->add_option("--seconds", a.seconds, "seconds to watch each edit")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  verb->add_option("--repeats", a.repeats,
                   "sessions of each scene and solver; the median of each figure is reported")
      ->check(CLI::Range(1u, 1000u))
      ->capture_default_str();
  verb->add_option("--seed", a.seed, "seed of the edits' amounts; 0: fixed amounts")->capture_default_str();
  verb->add_option("--settle", a.settle, "maximum seconds to wait before an edit for a finished picture")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  verb->add_option("--reference-samples", a.reference_samples,
                   "samples per pixel of the reference pictures, in two halves for their noise")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
  verb->add_option(
          "--reference-solver", a.reference_solver,
          "solver of their secondary and tertiary light; cache: far less noise, and a bias of a few per cent")
      ->check(CLI::IsMember({"path", "cache"}))
      ->capture_default_str();
  verb->add_option("--references", a.references, "folder that keeps the reference pictures")
      ->capture_default_str();
  verb->add_option("--pictures", a.pictures, "folder for the pictures shown at 0.3, 1, 3, 10 and 30 s");
  verb->add_option("--set", a.set, "KEY=VALUE, as of the viewer")->allow_extra_args(false);
  verb->add_option("--json", a.json, "file to write the figures to");
  verb->add_option("--device", a.device, k_device_help);
  add_scene_options(*verb, common);
  const auto run = runs(bench_latency, arguments, common);
  return {verb, run};
}

Verb add_photons(CLI::App& parent, Common& common) {
  const auto arguments = std::make_shared<BenchPhotonsArguments>();
  BenchPhotonsArguments& a = *arguments;
  CLI::App* verb =
      parent.add_subcommand("photons",
                            "how photons' errors fall with passes and radii, and the cost of passes; "
                            "ten minutes (--photons is the same)");
  bench::PhotonBenchOptions& o = a.options;
  verb->add_option("--parts", o.parts,
                   "some of slopes (of noise and bias), rounds (their cost by light paths), lamps (by their "
                   "number), free (without surfaces that focus light) [all]")
      ->delimiter(',')
      ->check(CLI::IsMember(
          std::vector<std::string>(bench::k_photon_parts.begin(), bench::k_photon_parts.end())));
  verb->add_option("--report", a.report, "report folder; a folder of the same bench is continued")
      ->capture_default_str();
  verb->add_option("--side", o.side, "pixels along a side of the pictures for slopes")
      ->check(CLI::Range(8u, 1024u))
      ->capture_default_str();
  verb->add_option("--seeds", o.seeds, "renders of each, with different seeds")
      ->check(CLI::Range(3u, 64u))
      ->capture_default_str();
  verb->add_option("--rounds", o.rounds, "passes of each")
      ->check(CLI::Range(8u, 65536u))
      ->capture_default_str();
  verb->add_option("--reference-samples", o.reference_samples,
                   "samples per pixel of each of the references, one for every render")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
  verb->add_option("--paths", o.paths, "light paths per pass [1e4 to 1e7]")
      ->delimiter(',')
      ->check(CLI::Range(1u, 1u << 24));
  verb->add_option("--lamps", o.lamps, "numbers of lamps [1,10,100,1000]")
      ->delimiter(',')
      ->check(CLI::Range(1u, 100000u));
  verb->add_option("--repeats", o.repeats, "passes that are timed")
      ->check(CLI::Range(1u, 1000u))
      ->capture_default_str();
  verb->add_option("--pairs", o.pairs, "renders with and without photons where they are not needed")
      ->check(CLI::Range(1u, 1000u))
      ->capture_default_str();
  verb->add_flag("--quiet", a.quiet, "no progress line");
  verb->add_option("--device", a.device, k_device_help);
  const auto run = runs(bench_photons, arguments, common);
  return {verb, run};
}

Verb add_matrices(CLI::App* verb, Common& common) {
  const auto arguments = std::make_shared<BenchArguments>();
  BenchArguments& a = *arguments;
  verb->require_subcommand(0, 1);
  verb->add_option("MATRIX", a.matrix, "matrix file (JSON), see below");
  for (const bench::BuiltinInfo& info : bench::builtin_matrices())
    verb->add_flag_callback(
        "--" + info.name, [&a, name = info.name] { a.built_in.push_back(name); }, info.help);
  verb->add_option("--report", a.report, "report folder; a folder of the same bench is continued")
      ->capture_default_str();
  verb->add_option("--references", a.references,
                   "folder of the reference pictures [references in the report folder]");
  verb->add_option("--repeats", a.repeats, "renders of each cell, instead of the matrix's number")
      ->check(CLI::Range(1, 100));
  verb->add_option("--device", a.device, k_device_help);
  verb->add_flag("--quiet", a.quiet, "no progress line");
  verb->add_option("--compare", a.compare, "OLD NEW: ratios of two reports (folders or report.json)")
      ->expected(2);
  verb->add_option("--page", a.page, "write report.html of a report folder again, without measuring");
  add_scene_options(*verb, common);
  const auto run = runs(bench_matrix, arguments, common);
  return {verb, run, bench::k_matrix_help};
}

}  // namespace

std::vector<Verb> add_bench_verbs(CLI::App& app, Common& common) {
  CLI::App* bench =
      app.add_subcommand("bench", "measure error over time: scenes x settings x budgets, with a report page");
  std::vector<Verb> verbs{add_rays(*bench, common), add_latency(*bench, common), add_photons(*bench, common)};
  for (Verb& verb : add_rooms_benches(*bench, common)) verbs.push_back(std::move(verb));
  verbs.push_back(add_matrices(bench, common));
  return verbs;
}

}  // namespace lucerna::app
