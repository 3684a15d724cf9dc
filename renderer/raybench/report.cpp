#include "raybench/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json_text.h"

namespace lucerna::raybench {

std::string to_text(const Report& r, const std::string& yardstick) {
  std::string text = fmt::format("{}: {} triangles, tree of {} nodes, {} deep; on {}\n", r.scene, r.triangles,
                                 r.tree_nodes, r.tree_depth, r.device);
  text += fmt::format("Mray/s, median of {} (range)\n{:<16}", r.repeats, "");
  for (size_t s = 0; s < r.sets.size(); ++s)
    text += fmt::format("{:>24}", fmt::format("{} ({:.2f} M)", r.sets[s], 1e-6 * double(r.set_sizes[s])));
  text += "\n";
  const auto base = std::find(r.tracers.begin(), r.tracers.end(), yardstick) - r.tracers.begin();
  for (size_t t = 0; t < r.tracers.size(); ++t) {
    text += fmt::format("{:<16}", r.tracers[t]);
    for (const Rate& rate : r.rates[t])
      text +=
          fmt::format("{:>24}", fmt::format("{:.2f} ({:.2f} to {:.2f})", rate.median, rate.low, rate.high));
    text += "\n";
  }
  for (size_t t = 0; t < r.tracers.size() && base < std::ptrdiff_t(r.tracers.size()); ++t) {
    if (std::ptrdiff_t(t) == base) continue;
    text += fmt::format("{:<16}", r.tracers[t]);
    for (size_t s = 0; s < r.sets.size(); ++s)
      text += fmt::format("{:>24}", fmt::format("{:.3f}", r.rates[t][s].median / r.rates[base][s].median));
    text += fmt::format("   of {}\n", yardstick);
  }
  if (!r.frames.empty())
    text += fmt::format("path-traced frame, {}x{}, {} samples, median of {}\n", r.frame_options.width,
                        r.frame_options.height, r.frame_options.samples, r.repeats);
  for (const Report::Frame& f : r.frames) {
    text += fmt::format("{:<16}{:>9.3f} s {:>8.2f} Mray/s  ", f.tracer, f.time.seconds,
                        1e-6 * double(f.time.rays) / f.time.seconds);
    double total = 0;
    for (const auto& s : f.time.stages) total += s.ms;
    for (const auto& s : f.time.stages)
      text += fmt::format(" {} {:.0f} %", s.name, 100 * s.ms / std::max(total, 1e-9));
    text += "\n";
  }
  if (r.frames.size() == 2)
    text += fmt::format("{} is {:.2f} times as fast as {}\n", r.frames[1].tracer,
                        r.frames[0].time.seconds / r.frames[1].time.seconds, r.frames[0].tracer);
  return text;
}

std::string to_json(const Report& r) {
  nlohmann::ordered_json j{{"scene", r.scene},      {"device", r.device},         {"triangles", r.triangles},
                           {"nodes", r.tree_nodes}, {"tree_depth", r.tree_depth}, {"repeats", r.repeats}};
  for (size_t t = 0; t < r.tracers.size(); ++t)
    for (size_t s = 0; s < r.sets.size(); ++s)
      j["mrays_per_s"][r.tracers[t]][r.sets[s]] = {{"median", r.rates[t][s].median},
                                                   {"low", r.rates[t][s].low},
                                                   {"high", r.rates[t][s].high},
                                                   {"rays", r.set_sizes[s]}};
  for (const Report::Frame& f : r.frames) {
    nlohmann::ordered_json frame{{"width", r.frame_options.width},
                                 {"height", r.frame_options.height},
                                 {"samples", r.frame_options.samples},
                                 {"seconds", f.time.seconds},
                                 {"rays", f.time.rays}};
    for (const auto& s : f.time.stages) frame["stages_ms"][s.name] = s.ms;
    j["frame"][f.tracer] = frame;
  }
  return json_text(j, 2);
}

}  // namespace lucerna::raybench
