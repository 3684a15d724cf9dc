#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "session/renderer.h"
#include "solvers/irradiance_cache/solver.h"
#include "tools/timing.h"
#include "tools/tools.h"

namespace lucerna::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Settings of the irradiance cache whose lookups are timed.
struct Way {
  std::string name, thinning;  ///< cache.thinning
};

/// With and without removal of overlapping records.
const std::array<Way, 2> k_ways{{{"as they were placed", "0"}, {"thinned", "0.6"}}};

/// Looks light up in the cache at every sampled pixel and discards it.
void look_up_picture(session::Renderer& r) {
  r.overlays().visit_solvers(
      [](solvers::Solver& solver, const overlay::Canvas& canvas, const solvers::Picture& picture) {
        if (auto* cached = dynamic_cast<irradiance_cache::CacheSolver*>(&solver))
          cached->look_up_picture(canvas, picture);
      });
}

struct Candidate {
  const Way& way;
  std::unique_ptr<session::Renderer> renderer;
  Timed timed;
};

Json figures(const Candidate& c, const Timing& t) {
  session::Renderer& r = *c.renderer;
  const Json statistics = r.solvers().statistics().at("cache"), &overlap = statistics.at("overlap");
  Json j{{"way", c.way.name},
         {"records", statistics.at("records")},
         {"rays", statistics.at("rays")},
         {"served_by_mean", overlap.at("mean")},
         {"served_by_most", overlap.at("most")},
         {"listed", overlap.at("listed")},
         {"lookups_per_s", overlap.at("pixels").get<double>() / t.median},
         {"lookups_s", {{"median", t.median}, {"low", t.low}, {"high", t.high}}}};
  if (!r.progress().ledger().entries().empty() && r.progress().ledger().entries().back().truth)
    j["relative_error"] = (*r.progress().ledger().entries().back().truth)[0];
  return j;
}

}  // namespace

int measure_interpolation(const InterpolationArguments& a) {
  std::vector<Candidate> candidates;
  std::vector<session::SettingChange> own{{"samples", std::to_string(a.samples), "--samples"}};
  for (const std::string& text : a.set) {
    const auto [key, value] = split_change(text, "--set");
    own.push_back({key, value, "--set"});
  }
  for (const Way& way : k_ways) {
    auto r = std::make_unique<session::Renderer>(session::RendererOptions{
        .device = a.device, .validation = false, .shaders = {}, .defines = {}, .scenes = a.scenes});
    r->set_size(a.width, a.height);
    std::vector<session::SettingChange> changes = own;
    changes.push_back({"components.secondary", "cache", way.name});
    changes.push_back({"components.tertiary", "cache", way.name});
    changes.push_back({"cache.thinning", way.thinning, way.name});
    r->load(a.scene, {}, changes);
    if (!a.reference.empty()) r->progress().set_reference(a.reference);
    while (!r->done() && r->step()) {
    }
    session::Renderer* const renderer = r.get();
    candidates.push_back({way, std::move(r), {{}, [renderer] { look_up_picture(*renderer); }}});
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

}  // namespace lucerna::tools
