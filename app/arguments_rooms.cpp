// lucerna bench interiors, auto: the error as seen of scenes after some seconds, by each choice of methods.
#include <fmt/ranges.h>

#include "app/arguments.h"
#include "app/verbs.h"

namespace lucerna::app {
namespace {

void add_rooms_options(CLI::App* verb, BenchInteriorsArguments& arguments, Common& common) {
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
  add_scene_options(*verb, common);
}

Verb add_interiors(CLI::App& parent, Common& common) {
  const auto arguments = std::make_shared<BenchInteriorsArguments>();
  BenchInteriorsArguments& a = *arguments;
  CLI::App* verb = parent.add_subcommand(
      "interiors",
      "error as seen of rooms after 4, 15 and 60 s, and the time to 5, 2 and 1 %, by path tracing, learned "
      "lights, cached light and both; hours (--interiors is the same)");
  add_rooms_options(verb, a, common);
  bench::InteriorsOptions& o = a.options;
  verb->add_option("--against", o.against,
                   "another lucerna, such as the previous commit in a separate checkout: rendered "
                   "alternately with this one, every setting beside its counterpart")
      ->check(named());
  verb->add_flag(
      "--quick", o.quick,
      "three rooms in small pictures after 0.8 and 4 s: two to three minutes, plus their references once");
  return {verb, runs(bench_interiors, arguments, common)};
}

Verb add_auto(CLI::App& parent, Common& common) {
  const auto arguments = std::make_shared<BenchInteriorsArguments>();
  BenchInteriorsArguments& a = *arguments;
  CLI::App* verb = parent.add_subcommand(
      "auto",
      "solvers chosen for the scene (components.X=auto) against fixed choices: error as seen of all scenes "
      "after 10 and 60 s, and the time to 5, 2 and 1 %; hours (--auto is the same)");
  a.options.every_solver = true;
  a.report = "auto-report";
  add_rooms_options(verb, a, common);
  return {verb, runs(bench_interiors, arguments, common)};
}

}  // namespace

std::vector<Verb> add_rooms_benches(CLI::App& parent, Common& common) {
  return {add_interiors(parent, common), add_auto(parent, common)};
}

}  // namespace lucerna::app
