#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/timer.h"
#include "session/renderer.h"
#include "session/session.h"
#include "tools/timing.h"
#include "tools/tools.h"

namespace lucerna::tools {
namespace {

using Json = nlohmann::ordered_json;

std::unique_ptr<session::Renderer> load(const MixArguments& a, const std::string& enabled) {
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

/// Milliseconds of each stage in two pictures, the largest differences first: "film 10 -> 12".
std::string stages_text(const transport::TransportStats& before, const transport::TransportStats& after) {
  std::vector<std::pair<double, std::string>> lines;
  for (const transport::StageSum& s : after.stages) {
    double ms = 0;
    for (const transport::StageSum& old : before.stages)
      if (old.name == s.name) ms = old.ms;
    lines.emplace_back(ms - s.ms, fmt::format("{} {:.0f} -> {:.0f}", s.name, ms, s.ms));
  }
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const auto& [more, line] : lines) text += (text.empty() ? "" : ", ") + line;
  return text;
}

std::string mix_of(const std::vector<std::string>& groups, int step) {
  return fmt::format("{}: ev={}", groups[size_t(step) % groups.size()], 0.1 * double(step + 1));
}

/// Seconds from a command to the picture that shows it, in a session as in the window, one group after the
/// other. `pause` before each: 0, as during a drag of a slider; or long enough that the session is rendering
/// samples again, as at the start of a drag.
Timing drag_session(session::Session& s, const std::vector<std::string>& groups, int count, double pause) {
  std::vector<double> seconds;
  for (int step = 0; step < count; ++step) {
    std::this_thread::sleep_for(std::chrono::duration<double>(pause));
    const Timer timer;
    s.set("relight.mix", mix_of(groups, step));
    while (s.snapshot()->commands < s.commands()) std::this_thread::sleep_for(std::chrono::microseconds(100));
    seconds.push_back(timer.seconds());
  }
  return timing_of(seconds);
}

/// A session that renders the scene, with samples in all pixels.
std::unique_ptr<session::Session> render_in_session(const MixArguments& a) {
  auto s =
      session::start_session({.device = a.device, .validation = false, .shaders = {}, .scenes = a.scenes});
  s->set_size(a.width, a.height);
  s->load(a.scene);
  for (const std::string& text : a.set) {
    const auto [key, value] = split_change(text, "--set");
    s->set(key, value);
  }
  s->set("samples", "1000000");
  s->set("relight.enabled", a.keep);
  const auto begun = [&] {
    const auto now = s->snapshot();
    return now && now->commands >= s->commands() && (!s->scene() || now->samples > 0);
  };
  while (!begun()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (!s->scene()) throw_error(a.scene, "could not be loaded");
  return s;
}

void finish(session::Renderer& r) {
  while (r.step()) {
  }
}

}  // namespace

int measure_mix(const MixArguments& a) {
  const auto separate = load(a, a.keep), together = load(a, "off");
  if (!separate->relight().separate)
    throw_error(a.scene, "its light groups cannot be tracked: {}", separate->relight().why_not);
  const uint32_t groups = separate->film().groups();
  // Whole pictures alternate; the first of each compiles the remaining kernels.
  std::vector<double> cpu[2];
  for (int round = 0; round <= a.repeats; ++round)
    for (int k = 0; k < 2; ++k) {
      session::Renderer& r = k == 0 ? *together : *separate;
      r.restart();
      const double before = cpu_seconds();
      finish(r);
      if (round > 0) cpu[k].push_back(cpu_seconds() - before);
    }
  const std::string stages = stages_text(together->stats(), separate->stats());
  // A drag of the sliders, one group after the other; then the remaining parts of a mix: sums by component,
  // and the noise estimate.
  session::Renderer& r = *separate;
  const uint64_t rays = r.stats().rays;
  std::vector<std::string> names;
  for (const scene::LightGroup& group : r.relight().groups->groups) names.push_back(group.name);
  int step = 0;
  const auto drag = [&] {
    r.settings().set("relight.mix", mix_of(names, step++));
    r.apply_settings();
    r.output().shown_picture(false);
  };
  const double cpu_before = cpu_seconds();
  const Timing shown = take_turns({{{}, drag}}, 4 * a.repeats)[0];
  const double shown_cpu = (cpu_seconds() - cpu_before) / (4 * a.repeats + 1);
  const Timing settled = take_turns({{drag, [&] { r.mix().settle(); }}}, a.repeats)[0];
  if (r.stats().rays != rays) throw_error(a.scene, "a mix traced rays");
  const std::unique_ptr<session::Session> s = render_in_session(a);
  const Timing begun = drag_session(*s, names, 2 * a.repeats, 0.5),
               dragged = drag_session(*s, names, 8 * a.repeats, 0);

  const double one = timing_of(cpu[0]).median, many = timing_of(cpu[1]).median;
  std::printf(
      "%s",
      fmt::format("{}, {}x{}, {} samples, {} light groups, on {}\n"
                  "  a picture     {:.2f} s of CPU with one group, {:.2f} s with {}: {:+.1f} %\n"
                  "  its stages    {} ms\n"
                  "  another mix   {:.1f} ms until it is shown ({:.1f} to {:.1f}), {:.1f} ms of CPU, no ray\n"
                  "  in the window {:.1f} ms when a drag begins ({:.1f} to {:.1f}), {:.1f} ms while it goes "
                  "on ({:.1f} to {:.1f})\n"
                  "  its noise follows {:.0f} ms later ({:.0f} to {:.0f})\n"
                  "  {} bytes per pixel\n",
                  a.scene, a.width, a.height, a.samples, groups, r.device().info().name, one, many, groups,
                  100 * (many / one - 1), stages, 1e3 * shown.median, 1e3 * shown.low, 1e3 * shown.high,
                  1e3 * shown_cpu, 1e3 * begun.median, 1e3 * begun.low, 1e3 * begun.high,
                  1e3 * dragged.median, 1e3 * dragged.low, 1e3 * dragged.high, 1e3 * settled.median,
                  1e3 * settled.low, 1e3 * settled.high, film::sum_bytes(groups, r.film().group_storage()))
          .c_str());
  if (!a.json.empty()) {
    const auto times = [](const Timing& t) {
      return Json{{"median", t.median}, {"low", t.low}, {"high", t.high}};
    };
    write_file(a.json, json_text(Json{{"scene", a.scene},
                                      {"width", a.width},
                                      {"height", a.height},
                                      {"samples", a.samples},
                                      {"groups", groups},
                                      {"keep", a.keep},
                                      {"bytes_a_pixel", film::sum_bytes(groups, r.film().group_storage())},
                                      {"cpu_s_one_group", cpu[0]},
                                      {"cpu_s", cpu[1]},
                                      {"shown_s", times(shown)},
                                      {"shown_cpu_s", shown_cpu},
                                      {"drag_begins_s", times(begun)},
                                      {"drag_s", times(dragged)},
                                      {"settled_s", times(settled)}},
                                 2) +
                           "\n");
  }
  return 0;
}

}  // namespace lucerna::tools
