#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/bench_timing.h"
#include "app/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "session/renderer.h"

namespace lucerna::app {
namespace {

using Json = nlohmann::ordered_json;

struct Candidate {
  const solvers::SolverInfo& solver;
  const solvers::LookupWay& way;
  std::unique_ptr<session::Renderer> renderer;
  Timed timed;
};

Json figures(const Candidate& c, const Timing& t) {
  session::Renderer& r = *c.renderer;
  const Json statistics = r.solver_statistics().at(c.solver.name), &overlap = statistics.at("overlap");
  Json j{{"way", c.way.name},
         {"records", statistics.at("records")},
         {"rays", statistics.at("rays")},
         {"served_by_mean", overlap.at("mean")},
         {"served_by_most", overlap.at("most")},
         {"listed", overlap.at("listed")},
         {"lookups_per_s", overlap.at("pixels").get<double>() / t.median},
         {"lookups_s", {{"median", t.median}, {"low", t.low}, {"high", t.high}}}};
  if (!r.ledger().entries().empty() && r.ledger().entries().back().truth)
    j["relative_error"] = (*r.ledger().entries().back().truth)[0];
  return j;
}

}  // namespace

int bench_interpolation(const BenchInterpolationArguments& a) {
  std::vector<Candidate> candidates;
  std::vector<session::SettingChange> own{{"samples", std::to_string(a.samples), "--samples"}};
  for (const std::string& text : a.set) {
    const auto [key, value] = split_change(text, "--set");
    own.push_back({key, value, "--set"});
  }
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const solvers::LookupWay& way : solver->lookup_ways) {
      auto r = std::make_unique<session::Renderer>(session::RendererOptions{
          .device = a.device, .validation = false, .shaders = {}, .defines = {}, .scenes = a.scenes});
      r->set_size(a.width, a.height);
      std::vector<session::SettingChange> changes = own;
      for (const auto& [key, value] : way.set) changes.push_back({key, value, way.name});
      r->load(a.scene, {}, changes);
      if (!a.reference.empty()) r->set_reference(a.reference);
      while (!r->done() && r->step()) {
      }
      session::Renderer* const renderer = r.get();
      candidates.push_back({*solver, way, std::move(r), {{}, [renderer] { renderer->look_up_picture(); }}});
    }
  std::vector<Timed> timed;
  for (const Candidate& c : candidates) timed.push_back(c.timed);
  const std::vector<Timing> times = take_turns(timed, a.repeats);

  Json all{{"scene", a.scene},
           {"device", candidates.front().renderer->device().info().name},
           {"width", a.width},
           {"height", a.height},
           {"repeats", a.repeats}};
  std::printf("a lookup for every pixel, median of %d (range), %s, on %s\n", a.repeats, a.scene.c_str(),
              candidates.front().renderer->device().info().name.c_str());
  for (size_t i = 0; i < candidates.size(); ++i) {
    const Json j = figures(candidates[i], times[i]);
    std::printf(
        "%s", fmt::format("  {:<22} {:>7} records  {:>4.1f} used per pixel, {} at most, of {:>5.1f} listed  "
                          "{:>7.3f} M lookups/s ({:.3f} to {:.3f})  {:.2f} times as fast as the first{}\n",
                          candidates[i].way.name, j["records"].get<uint32_t>(),
                          j["served_by_mean"].get<double>(), j["served_by_most"].get<uint32_t>(),
                          j["listed"].get<double>(), 1e-6 * j["lookups_per_s"].get<double>(),
                          1e-6 * j["lookups_per_s"].get<double>() * times[i].median / times[i].high,
                          1e-6 * j["lookups_per_s"].get<double>() * times[i].median / times[i].low,
                          times[0].median / times[i].median,
                          j.contains("relative_error")
                              ? fmt::format("  relative error {:.4f}", j["relative_error"].get<double>())
                              : "")
                  .c_str());
    all["ways"].push_back(j);
  }
  if (!a.json.empty()) write_file(a.json, json_text(all, 2) + "\n");
  return 0;
}

}  // namespace lucerna::app
