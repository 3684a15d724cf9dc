#pragma once
// Synthetic results of a bench: the error falls as c / sqrt(t), with a c for each setting.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/report.h"
#include "bench/result.h"
#include "support/folder.h"

namespace lucerna::test {

inline const char* const k_small_matrix = R"({
  "name": "small <&> matrix", "budgets": {"samples": [16, 64], "errors": [0.05]},
  "scenes": [{"file": "cornell/cornell.gltf", "size": "16x16"}, {"file": "glass/glass.gltf", "size": "24x16"}],
  "settings": [{"name": "plain", "about": "as it comes"},
               {"name": "adaptive", "about": "tiles", "set": {"sampling.mode": "adaptive"}}]
})";

inline bench::Matrix small_matrix() {
  return bench::parse_matrix(k_small_matrix, "small", std::string(LUCERNA_SOURCE_DIR) + "/scenes");
}

/// A render of `seconds` whose error is c / sqrt(t); repeats differ by a few per cent.
inline bench::Result fake_result(const bench::Matrix& m, const bench::Cell& cell, double c, double seconds) {
  bench::Result r;
  r.scene = m.scenes[cell.scene].name, r.setting = m.settings[cell.setting].name;
  r.budget = m.budget(cell).text(), r.repeat = cell.repeat, r.seed = m.seed + uint32_t(cell.repeat);
  r.scene_hash = "0123456789abcdef", r.reference_hash = "fedcba9876543210", r.tracer = "host";
  c *= 1 + 0.02 * (cell.repeat - 1);
  for (double t = seconds / 64; t < seconds * 1.001; t *= 2) {
    bench::CurvePoint p;
    p.wall_s = t, p.device_s = 0.9 * t, p.rays = uint64_t(1e6 * t), p.samples = 8 * t;
    for (size_t k = 0; k < p.truth.size(); ++k)
      p.truth[k] = c / std::sqrt(t) / double(k + 1), p.estimated[k] = 1.05 * p.truth[k];
    p.tiles = 2 * p.truth[0];
    p.relmse = 0.01 * p.truth[0] * p.truth[0];
    r.curve.push_back(p);
  }
  const bench::CurvePoint& last = r.curve.back();
  r.wall_s = last.wall_s, r.device_s = last.device_s, r.setup_s = 0.5, r.rays = last.rays,
  r.paths = last.rays / 5;
  r.samples = last.samples, r.truth = last.truth, r.estimated = last.estimated,
  r.component_s[0] = last.device_s;
  for (size_t k = 1; k < r.component_s.size(); ++k) r.component_s[k] = last.device_s / 4;
  r.mse = 0.25 * last.truth[0] * last.truth[0], r.relmse = last.relmse, r.relmse_all = 2 * r.relmse;
  r.tiles.median = 1.5 * last.truth[0], r.tiles.decile = last.tiles, r.tiles.worst = 4 * last.truth[0];
  r.forecast = bench::ForecastResult{.at_s = 0.1 * seconds,
                                     .seconds = {0.8 * seconds, 1.1 * seconds, 1.5 * seconds},
                                     .rays = {0.8e6 * seconds, 1.1e6 * seconds, 1.5e6 * seconds}};
  return r;
}

/// Plain: c 0.19 on cornell, 0.4 on glass. Adaptive: `gain` times faster (c falls with its root). Render
/// times are 4 s for the small budget, 16 s for the others; `cells` of them are finished.
inline bench::RunSummary fake_summary(const bench::Matrix& m, double gain, size_t cells = ~size_t{0}) {
  bench::RunSummary s;
  for (const bench::Cell& c : m.cells()) {
    if (s.results.size() == cells) break;
    const double constant = (c.scene == 0 ? 0.19 : 0.4) / std::sqrt(c.setting == 0 ? 1 : gain);
    s.results.emplace(m.id(c), fake_result(m, c, constant, c.setting == 0 && c.budget == 0 ? 4 : 16));
  }
  s.complete = s.results.size() == m.cells().size();
  for (const bench::SceneEntry& scene : m.scenes)
    s.references.push_back({.file = scene.name + ".exr",
                            .key = "fedcba9876543210",
                            .samples = 4096,
                            .seed = 900001,
                            .seconds = 77,
                            .noise = {0.004, 0.003, 0.002, 0.001, 0.001},
                            .relmse_noise = 0.0000123});
  return s;
}

inline nlohmann::ordered_json fake_about() {
  return {
      {"version", "9.9"},
      {"date", "2026-01-02 03:04 UTC"},
      {"command", "lucerna bench --quick"},
      {"wall_s", 321.0},
      {"machine",
       {{"cpu", "A Processor"}, {"cores", 2}, {"memory_gib", 3.5}, {"system", "A System"}, {"load", 0.25}}},
      {"device", {{"name", "a device"}, {"driver", "a driver"}}}};
}

}  // namespace lucerna::test
