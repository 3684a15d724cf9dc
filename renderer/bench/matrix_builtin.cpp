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
  name       of the matrix [the file's]
  about      a text, for people
  repeats    renders of each cell, 1 to 100 [3]; with 1 it stays unknown what of a factor is noise
  warmup     samples a pixel rendered before the clock runs, in every cell (of what a solver is long in preparing
             only the beginning) [8]
  seed       of the first repeat; every further one has the next [1]
  reference  {"samples": N, "seed": N}: of the long plain path-traced renders taken for the truth [4096, 900001]
  set        {"KEY": VALUE}: settings for all cells and references (keys: lucerna render --help)
  as_seen    true: the page is of the error as seen alone [false]
  budgets    what ends a render; lists of {"samples": [..], "errors": [..], "seconds": [..]}
  scenes     [{"file": F.gltf (relative to the matrix file), "size": "WxH", "name", "camera", "set", "budgets",
              "reference_samples"}]
  settings   [{"name", "about", "set": {..}, "curve", "program", "beside", "budget": "samples" |
              "errors" | "seconds"}]; the first is what the others are held against, and besides it the setting named
              as "beside". With "program" (another lucerna) that one renders, by its verb render. Without "budget", adaptive settings take errors, the others
              samples. Settings of one "curve" (a text) differ in how many records a solver comes to; the page joins
              them by a line, error against records.
The smallest one:
  {"budgets": {"samples": [64], "errors": [0.1]},
   "scenes": [{"file": "cornell.gltf", "size": "128x128"}],
   "settings": [{"name": "plain"}, {"name": "adaptive", "set": {"sampling.mode": "adaptive"}}]}
)";

}  // namespace lucerna::bench
