#include "bench/matrix.h"
#include "solvers/registry.h"

namespace lucerna::bench {
namespace {

const char* const k_quick_matrix = R"({
  "name": "quick",
  "repeats": 3,
  "scenes": [
    {"file": "cornell/cornell.gltf", "size": "128x128", "reference_samples": 2560,
     "budgets": {"samples": [512], "errors": [0.1, 0.06]}},
    {"file": "glass/glass.gltf", "size": "128x128", "reference_samples": 2048,
     "budgets": {"samples": [256], "errors": [0.2, 0.1]}},
    {"file": "studio/studio.gltf", "size": "160x120", "reference_samples": 2560,
     "budgets": {"samples": [512], "errors": [0.05, 0.03]}}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing, samples for all pixels alike"},
    {"name": "adaptive", "about": "path tracing, samples for the tiles that are still noisy",
     "set": {"sampling.mode": "adaptive"}},
    {"name": "compute-bvh", "about": "as plain, rays traced by the compute shaders instead of Embree",
     "set": {"tracer": "compute-bvh"}}
  ]
})";

const char* const k_full_matrix = R"({
  "name": "full",
  "repeats": 5,
  "reference": {"samples": 16384},
  "budgets": {"samples": [16, 64, 256, 1024], "errors": [0.2, 0.1, 0.05]},
  "scenes": [
    {"file": "cornell/cornell.gltf", "size": "256x256"},
    {"file": "glass/glass.gltf", "size": "256x256"},
    {"file": "studio/studio.gltf", "size": "320x240"},
    {"file": "atrium/atrium.gltf", "size": "320x180", "reference_samples": 8192,
     "budgets": {"samples": [16, 64, 256]}},
    {"file": "hall/hall.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}},
    {"file": "teapot/teapot.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}},
    {"file": "sun-patch/sun-patch.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}},
    {"file": "classroom/classroom.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}},
    {"file": "window/window.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing, samples for all pixels alike"},
    {"name": "adaptive", "about": "path tracing, samples for the tiles of 16x16 pixels that are still noisy",
     "set": {"sampling.mode": "adaptive", "sampling.max_samples": 4096}},
    {"name": "adaptive-8", "about": "the same with tiles of 8x8 pixels",
     "set": {"sampling.mode": "adaptive", "sampling.max_samples": 4096, "sampling.tile": 8}},
@SOLVERS@    {"name": "coherent", "about": "as plain, the pixels of a tile share their sequences",
     "set": {"sampling.coherent": true}},
    {"name": "compute-bvh", "about": "as plain, rays traced by the compute shaders instead of Embree",
     "set": {"tracer": "compute-bvh"}}
  ]
})";

/// k_full_matrix with the settings that solvers provide for it.
std::string full_matrix() {
  std::string text = k_full_matrix, rows;
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const std::string& row : solver->bench_settings) rows += "    " + row + ",\n";
  const std::string mark = "@SOLVERS@";
  return text.replace(text.find(mark), mark.size(), rows);
}

}  // namespace

std::vector<BuiltinInfo> builtin_matrices() {
  std::vector<BuiltinInfo> all{
      {"quick", "three scenes in small pictures, under ten minutes on two cores", k_quick_matrix},
      {"full", "larger pictures, the atrium too, more budgets; hours", full_matrix()}};
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const solvers::BenchInfo& bench : solver->benches)
      all.push_back({bench.name, bench.help, bench.matrix});
  return all;
}

Matrix builtin_matrix(const std::string& name, const std::filesystem::path& scenes) {
  std::vector<std::string> known;
  for (const BuiltinInfo& info : builtin_matrices()) {
    if (name == info.name) return parse_matrix(info.matrix, name, scenes);
    known.push_back(info.name);
  }
  throw_error("bench", "there is no matrix '{}'; there are {}", name, fmt::join(known, ", "));
}

const char* const k_matrix_help = R"(
A matrix file is a JSON object; an unknown key is an error:
  name       name of the matrix [that of the file]
  about      description
  repeats    renders of each cell, 1 to 100 [3]; 1 gives no estimate of which differences are noise
  warmup     samples per pixel before the clock starts, in every cell; long preparation is not completed in it [8]
  seed       seed of the first repeat; each further one takes the next [1]
  reference  {"samples": N, "seed": N}: the path-traced reference pictures [4096, 900001]
  set        {"KEY": VALUE}: settings of all cells and references (keys: lucerna render --help)
  as_seen    true: the page has only the error as seen [false]
  budgets    what ends a render: {"samples": [..], "errors": [..], "seconds": [..]}
  scenes     [{"file": F.gltf (relative to the matrix file), "size": "WxH", "name", "camera", "set", "budgets",
              "reference_samples"}]
  settings   [{"name", "about", "set": {..}, "curve", "program", "beside", "budget": "samples" |
              "errors" | "seconds"}]
The first setting is the baseline; "beside" names another one to compare with. "program" is another lucerna that
renders these cells. Without "budget", adaptive settings end at errors, others at samples. Settings with the same
"curve" (a text) differ in their number of records; the page joins them by a line of error against records.
Example:
  {"budgets": {"samples": [64], "errors": [0.1]},
   "scenes": [{"file": "cornell.gltf", "size": "128x128"}],
   "settings": [{"name": "plain"}, {"name": "adaptive", "set": {"sampling.mode": "adaptive"}}]}
)";

}  // namespace lucerna::bench
