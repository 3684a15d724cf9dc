// The time until the window shows a usable picture after an edit.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/interrupt.h"
#include "app/size.h"
#include "app/verbs.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/log.h"
#include "bench/latency.h"
#include "bench/machine.h"

namespace lucerna::app {
namespace {

namespace fs = std::filesystem;

/// A file, or the name of a scene that comes with the program.
fs::path scene_file(const std::string& name) {
  const fs::path own = fs::path(LUCERNA_SOURCE_DIR) / "scenes" / name / (name + ".gltf");
  return file_exists(name) || !file_exists(own) ? fs::path(name) : own;
}

/// The runs of each edit, in the order of the first ones.
std::vector<std::vector<bench::LatencyResult>> by_edit(const std::vector<bench::LatencyResult>& results) {
  std::vector<std::vector<bench::LatencyResult>> rows;
  for (const bench::LatencyResult& r : results) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& of) {
      const bench::LatencyResult& first = of.front();
      return first.scene == r.scene && first.solver == r.solver && first.edit == r.edit;
    });
    if (row == rows.end())
      rows.push_back({r});
    else
      row->push_back(r);
  }
  return rows;
}

}  // namespace

int bench_latency(const BenchLatencyArguments& a) {
  bench::LatencyOptions o;
  for (const std::string& name : a.files) o.files.push_back(scene_file(name));
  if (!a.solvers.empty()) o.solvers = a.solvers;
  for (const std::string& name : a.edits) o.edits.push_back(bench::edit_of(name));
  if (a.edits.empty())
    for (const char* name : bench::k_edit_names) o.edits.push_back(bench::edit_of(name));
  std::tie(o.width, o.height) = parse_size(a.size);
  o.reference_samples = a.reference_samples, o.reference_solver = a.reference_solver, o.seconds = a.seconds,
  o.settle.seconds = a.settle;
  o.repeats = a.repeats, o.seed = a.seed;
  o.device = a.device, o.references = a.references, o.pictures = a.pictures, o.scenes = a.scenes;
  for (const std::string& pair : a.set) {
    const size_t at = pair.find('=');
    if (at == std::string::npos) throw_error("--set", "'{}': expected KEY=VALUE", pair);
    o.set.emplace_back(pair.substr(0, at), pair.substr(at + 1));
  }
  log::set_console_level(log::Level::error);
  const Interrupt interrupt;
  std::printf("%s\n", bench::latency_heading().c_str());
  const std::vector<bench::LatencyResult> results = bench::measure_latency(
      o, [](const std::string& line) { std::fprintf(stderr, "lucerna: %s\n", line.c_str()); },
      [](const bench::LatencyResult& r) {
        std::printf("%s\n", bench::latency_row(r).c_str());
        std::fflush(stdout);
      },
      [&] { return interrupt.signal() != 0; });
  const std::vector<std::vector<bench::LatencyResult>> rows = by_edit(results);
  if (a.repeats > 1) {
    std::printf("\nmedian of %u\n", a.repeats);
    for (const auto& runs : rows) std::printf("%s\n", bench::latency_row(bench::median_of(runs)).c_str());
  }
  std::printf("%s\n", bench::text_of(bench::reported_errors(results)).c_str());
  if (a.json.empty()) return 0;
  const bench::Machine machine = bench::this_machine();
  nlohmann::ordered_json j{{"version", LUCERNA_VERSION},
                           {"date", bench::now_utc()},
                           {"cpu", machine.cpu},
                           {"cores", machine.cores},
                           {"load", bench::load_average()},
                           {"size", a.size},
                           {"reference_samples", a.reference_samples},
                           {"reference_solver", a.reference_solver}};
  for (const auto& runs : rows) {
    nlohmann::ordered_json row = bench::to_json(bench::median_of(runs));
    if (a.repeats > 1)
      for (const bench::LatencyResult& run : runs) row["runs"].push_back(bench::to_json(run));
    j["rows"].push_back(row);
  }
  write_file(a.json, json_text(j, 2) + "\n");
  return 0;
}

}  // namespace lucerna::app
