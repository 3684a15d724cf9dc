#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/bench_timing.h"
#include "app/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "session/renderer.h"

namespace lucerna::app {
namespace {

using Json = nlohmann::ordered_json;

/// CPU seconds that this process has used, user and system.
double cpu_seconds() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

std::unique_ptr<session::Renderer> load(const BenchMixArguments& a, const char* enabled) {
  auto r = std::make_unique<session::Renderer>(session::RendererOptions{.device = a.device,
                                                                        .validation = false,
                                                                        .shaders = {},
                                                                        .defines = {},
                                                                        .interactive = true,
                                                                        .scenes = a.scenes});
  r->set_size(a.width, a.height);
  std::vector<session::SettingChange> changes{{"samples", std::to_string(a.samples), "--samples"},
                                              {"relight.enabled", enabled, ""}};
  for (const std::string& text : a.set) {
    const auto [key, value] = split_change(text, "--set");
    changes.push_back({key, value, "--set"});
  }
  r->load(a.scene, {}, changes);
  return r;
}

void finish(session::Renderer& r) {
  while (r.step()) {
  }
}

}  // namespace

int bench_mix(const BenchMixArguments& a) {
  const auto apart = load(a, "on"), together = load(a, "off");
  if (!apart->relight().apart)
    throw_error(a.scene, "its light cannot be kept apart: {}", apart->relight().why_not);
  const uint32_t groups = apart->film().groups();
  // Whole pictures in turns; the first of each compiles what is left to compile.
  std::vector<double> cpu[2];
  for (int round = 0; round <= a.repeats; ++round)
    for (int k = 0; k < 2; ++k) {
      session::Renderer& r = k == 0 ? *together : *apart;
      r.restart();
      const double before = cpu_seconds();
      finish(r);
      if (round > 0) cpu[k].push_back(cpu_seconds() - before);
    }
  // A drag at the sliders, one group after the other; then the film's sums follow.
  session::Renderer& r = *apart;
  const uint64_t rays = r.stats().rays;
  int step = 0;
  const auto drag = [&] {
    const std::string& group = r.relight().groups->groups[size_t(step) % groups].name;
    r.settings().set("relight.mix", fmt::format("{}: ev={}", group, 0.1 * double(++step)));
    r.apply_settings();
    r.shown_picture(false);
  };
  const Timing shown = take_turns({{{}, drag}}, 4 * a.repeats)[0];
  const Timing settled = take_turns({{drag, [&] { r.settle_mix(); }}}, a.repeats)[0];
  if (r.stats().rays != rays) throw_error(a.scene, "a mix has traced rays");

  const double one = timing_of(cpu[0]).median, many = timing_of(cpu[1]).median;
  std::printf(
      "%s", fmt::format("{}, {}x{}, {} samples, {} groups of lights, on {}\n"
                        "  a picture     {:.2f} s of CPU with one group, {:.2f} s with {}: {:+.1f} %\n"
                        "  another mix   {:.1f} ms until it is seen ({:.1f} to {:.1f}), no ray\n"
                        "  the film's sums follow in {:.0f} ms ({:.0f} to {:.0f})\n"
                        "  {} bytes a pixel\n",
                        a.scene, a.width, a.height, a.samples, groups, r.device().info().name, one, many,
                        groups, 100 * (many / one - 1), 1e3 * shown.median, 1e3 * shown.low, 1e3 * shown.high,
                        1e3 * settled.median, 1e3 * settled.low, 1e3 * settled.high, film::sum_bytes(groups))
                .c_str());
  if (!a.json.empty()) {
    const auto times = [](const Timing& t) {
      return Json{{"median", t.median}, {"low", t.low}, {"high", t.high}};
    };
    write_file(a.json, Json{{"scene", a.scene},
                            {"width", a.width},
                            {"height", a.height},
                            {"samples", a.samples},
                            {"groups", groups},
                            {"bytes_a_pixel", film::sum_bytes(groups)},
                            {"cpu_s_one_group", cpu[0]},
                            {"cpu_s", cpu[1]},
                            {"shown_s", times(shown)},
                            {"settled_s", times(settled)}}
                               .dump(2) +
                           "\n");
  }
  return 0;
}

}  // namespace lucerna::app
