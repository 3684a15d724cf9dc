#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <set>

#include "app/interrupt.h"
#include "app/render_stats.h"
#include "app/size.h"
#include "app/verbs.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/log.h"
#include "base/timer.h"
#include "commands/camera_control.h"
#include "commands/lens.h"
#include "plan/choose.h"
#include "recording/file.h"
#include "scene/core.h"
#include "session/pick.h"
#include "session/renderer.h"
#include "session/tev_link.h"

namespace lucerna::app {
namespace {

void print_progress(const session::Renderer& r, double seconds, double limit, bool last) {
  const double paths = double(r.stats().paths) / (double(r.film().width()) * r.film().height());
  double done = std::max(double(r.samples()), paths) / r.sampling().max_samples();
  if (const schedule::AdaptiveSchedule* s = r.sampling().adaptive())
    done = double(s->count(schedule::TileState::done) + s->count(schedule::TileState::capped)) /
           double(s->sampled_tiles());
  // The nearer limit.
  if (limit > 0) done = std::max(done, std::min(1.0, seconds / limit));
  const double left = done > 0 ? seconds * (1 - done) / done : 0;
  std::fprintf(stderr, "\r%5.1f %%  %u/%u samples  %.2f Mray/s  %.2f samples/s  %s %.0f s left   %s",
               100 * done, uint32_t(r.sampling().mean_samples()), r.sampling().max_samples(),
               1e-6 * double(r.stats().rays) / std::max(seconds, 1e-9), paths / std::max(seconds, 1e-9),
               "about", left, last ? "\n" : "");
  std::fflush(stderr);
}

/// True if any output besides solvers' work is requested.
bool makes_picture(const RenderArguments& a) {
  return !a.outputs.empty() || !a.stats.empty() || !a.ledger.empty() || !a.record_paths.empty() || a.tev;
}

/// Throws Error if two outputs are the same file, of which the first would be lost.
void check_distinct(const std::vector<std::string>& files) {
  std::set<std::string> targets;
  for (const std::string& file : files)
    // Pipes and devices accept all, one after the other.
    if (const std::filesystem::path target = file_behind(file);
        !target.empty() && !targets.insert(target.string()).second)
      throw_error(file, "two outputs have this name; choose different names");
}

/// "out.png" -> "out.0007.png"
std::string numbered(const std::string& file, uint32_t number) {
  const size_t dot = file.rfind('.');
  return fmt::format("{}.{:04}{}", file.substr(0, dot), number, file.substr(dot));
}

/// Throws Error if no output is requested, or one cannot be written: before a long render.
void check_outputs(const RenderArguments& a, const std::map<std::string, std::string>& to_save) {
  if (!makes_picture(a) && to_save.empty()) {
    std::string work;
    for (const solvers::SolverInfo* solver : solvers::registered())
      if (solver->file)
        work += fmt::format(", or {} only: --{}-save OUT{}", solver->file->content, solver->name,
                            solver->file->extension);
    throw_error("-o", "name at least one output: OUT.exr or OUT.png, or figures only: --stats OUT.json{}",
                work);
  }
  for (const std::string& file : a.outputs) {
    const auto dot = file.rfind('.');
    const std::string extension = dot == std::string::npos ? "" : file.substr(dot);
    if (extension != ".exr" && extension != ".png")
      throw_error(file, "cannot write '{}' files; use .exr or .png", extension);
    for (uint32_t view = 1; view <= a.turntable; ++view) film::check_writable(numbered(file, view));
    if (a.turntable == 0) film::check_writable(file);
  }
  if (a.turntable > 0 &&
      (!a.stats.empty() || !a.ledger.empty() || !a.record_paths.empty() || !to_save.empty()))
    throw Error("--turntable", "writes pictures only; figures, paths and caches are of one view");
  if (!a.stats.empty()) check_writable(a.stats);
  if (!a.ledger.empty()) check_writable(a.ledger);
  if (!a.record_paths.empty()) {
    if (!a.record_paths.ends_with(recording::k_file_ending) && !file_behind(a.record_paths).empty())
      throw_error(a.record_paths, "recorded paths need the ending {}", recording::k_file_ending);
    check_writable(a.record_paths);
  } else if (!a.record_region.empty() || a.record_over > 0) {
    throw_error("--record-paths", "name the file for the recorded paths: --record-paths OUT{}",
                recording::k_file_ending);
  }
  for (const auto& [name, file] : to_save) check_writable(file);
  std::vector<std::string> files = a.outputs;
  for (const std::string& file : {a.stats, a.ledger, a.record_paths})
    if (!file.empty()) files.push_back(file);
  for (const auto& [name, file] : to_save) files.push_back(file);
  check_distinct(files);
  if (a.seconds && !(std::isfinite(*a.seconds) && *a.seconds > 0))
    throw_error("--time", "'{}': expected a positive number of seconds", *a.seconds);
}

/// The part of a rectangle "X Y WIDTH HEIGHT" that is in the picture. Throws Error located at `option` if
/// none is.
schedule::Rectangle pixels_of(const std::vector<uint32_t>& rectangle, const char* option, uint32_t width,
                              uint32_t height) {
  const auto end = [](uint32_t from, uint32_t size, uint32_t most) {
    return uint32_t(std::min<uint64_t>(uint64_t{from} + size, most));
  };
  const uint32_t left = rectangle[0], top = rectangle[1];
  const schedule::Rectangle r{left, top, end(left, rectangle[2], width), end(top, rectangle[3], height)};
  if (r.left >= r.right || r.top >= r.bottom)
    throw_error(option, "no pixel of the picture of {}x{} is in this region", width, height);
  return r;
}

/// The command line's settings, which override the scene's. Throws Error for an invalid setting, before the
/// scene is loaded.
std::vector<session::SettingChange> setting_changes(const RenderArguments& a, uint32_t width,
                                                    uint32_t height) {
  std::vector<session::SettingChange> changes;
  const auto change = [&](std::string key, std::string value, const char* where = "--set") {
    changes.push_back({std::move(key), std::move(value), where});
  };
  for (const std::string& text : a.set) {
    const auto [key, value] = split_change(text, "--set");
    change(key, value);
  }
  if (a.samples != -1) {
    change("samples", std::to_string(a.samples), "--samples");
    if (a.error) change("sampling.max_samples", std::to_string(a.samples), "--samples");
  }
  if (a.error) {
    if (!(*a.error > 0)) throw_error("--error", "'{}': expected a positive error, such as 0.02", *a.error);
    // The filter joins pixels across tiles, so the error of a filtered picture needs equal samples
    // everywhere.
    change("sampling.mode", a.filter ? "uniform" : "adaptive");
    change("sampling.target_error", fmt::format("{}", *a.error));
  }
  if (a.seed != -1) change("seed", std::to_string(a.seed));
  if (!a.region.empty()) {
    const schedule::Rectangle p = pixels_of(a.region, "--region", width, height);
    const double w = width, h = height;
    const schedule::Region region{p.left / w, p.top / h, (p.right - p.left) / w, (p.bottom - p.top) / h};
    change("sampling.region", schedule::region_text(region), "--region");
  }
  plan::Settings probe;
  for (const session::SettingChange& c : changes) {
    probe.set(c.key, c.value, c.where);
    if (c.key == "sampling.region") schedule::parse_region(c.value, c.where + ": " + c.key);
  }
  return changes;
}

/// True if the command line or the scene sets a setting whose key is wanted.
bool is_given(const session::Renderer& r, const std::vector<session::SettingChange>& changes,
              const std::function<bool(const std::string&)>& wanted) {
  const auto in_scene = [&](const auto& setting) { return wanted(setting.first); };
  return std::ranges::any_of(changes, [&](const auto& c) { return wanted(c.key); }) ||
         std::ranges::any_of(r.scene()->settings, in_scene) ||
         std::ranges::any_of(r.scene()->own_settings, in_scene);
}

/// ... a setting that begins so.
bool is_given(const session::Renderer& r, const std::vector<session::SettingChange>& changes,
              const char* begin) {
  return is_given(r, changes, [&](const std::string& key) { return key.starts_with(begin); });
}

/// True if nothing but --time ends the render, and nothing else says where its samples go.
bool is_free_in_time(const session::Renderer& r, const RenderArguments& a,
                     const std::vector<session::SettingChange>& changes) {
  return a.seconds && !a.error && a.samples == -1 && !is_given(r, changes, "samples") &&
         !is_given(r, changes, "sampling.");
}

/// With --time alone the program chooses the solvers, if nothing else says who computes which light: in ten
/// scenes this is up to 20 times better than path tracing, and nowhere worse by more than 4 % (lucerna bench
/// auto, 10 s at 320x180).
void choose_solvers(session::Renderer& r, const RenderArguments& a,
                    const std::vector<session::SettingChange>& changes) {
  if (!is_free_in_time(r, a, changes)) return;
  if (is_given(r, changes, plan::decides_solvers)) return;
  if (std::any_of(a.solver_load.begin(), a.solver_load.end(),
                  [](const auto& l) { return !l.second.empty(); }))
    return;
  plan::leave_choice(r.settings(), "--time");
  r.apply_settings();
}

/// With --time alone samples go where they lower the error most, if nothing else says where.
void choose_sampling(session::Renderer& r, const RenderArguments& a,
                     const std::vector<session::SettingChange>& changes) {
  if (!is_free_in_time(r, a, changes)) return;
  r.settings().set("sampling.mode", "balanced", "--time");
  r.apply_settings();
}

/// A render ends at the first of the given limits: --error, --samples or the settings of the same meaning,
/// --time. With --time a default number of samples is no limit.
void set_limits(session::Renderer& r, const RenderArguments& a,
                const std::vector<session::SettingChange>& changes) {
  const bool adaptive = r.settings().text("sampling.mode") == "adaptive";
  const std::string key = adaptive ? "sampling.max_samples" : "samples";
  if (is_given(r, changes, key.c_str())) return;
  if (a.samples != -1)
    r.settings().set(key, std::to_string(a.samples), "--samples");
  else if (a.seconds)
    r.settings().set(key, fmt::format("{:.0f}", plan::find_option(key)->hi));
  else if (a.filter && a.error)
    r.settings().set(key, r.settings().text("sampling.max_samples"));
  r.apply_settings();
}

/// The command line's lens and shift for the camera.
void set_lens(session::Renderer& r, const RenderArguments& a) {
  scene::Camera camera = r.camera();
  if (!a.projection.empty()) {
    if (camera.orthographic)
      throw Error("--projection", "the camera is orthographic; --camera chooses another one");
    commands::set_projection(camera, a.projection);
  }
  if (!a.shift.empty()) camera.shift = vec2(a.shift[0], a.shift[1]);
  if (a.upright) {
    commands::Viewpoint view{.camera = camera};
    if (!commands::upright(view, float(r.film().width()) / float(r.film().height())))
      throw Error("--upright", "the camera is not a perspective one, or looks too steeply up or down");
    camera = view.camera;
  }
  if (!a.projection.empty() || !a.shift.empty() || a.upright) r.set_camera(camera);
  if (!a.f_number && !a.focus && !a.blades) return;
  if (!camera.perspective()) throw Error("--f-number", "only a perspective camera has depth of field");
  if (a.f_number) camera.lens.f_number = float(*a.f_number);
  if (camera.lens.f_number == 0)
    throw Error(a.focus ? "--focus" : "--blades", "the camera has no lens; --f-number gives it one");
  if (a.focus) camera.lens.focus_distance = float(*a.focus);
  if (a.blades) camera.lens.blades = uint32_t(*a.blades);
  if (camera.lens.focus_distance == 0) {
    const float aspect = float(r.film().width()) / float(r.film().height());
    const auto hit = session::pick(*r.scene(), camera, 0.5f, 0.5f, aspect);
    if (!hit)
      throw Error("--f-number", "there is no surface in the middle of the picture to focus on; give --focus");
    camera.lens.focus_distance =
        glm::dot(hit->position - commands::eye_of(camera), commands::forward_of(camera));
  }
  r.set_camera(camera);
}

/// Loads scene, camera, reference and solvers' work. False: interrupted.
bool load(session::Renderer& r, const RenderArguments& a, const std::vector<session::SettingChange>& changes,
          const Interrupt& interrupt, bool terminal) {
  try {
    r.load(
        a.scene,
        [&](float fraction, const std::string& what) {
          if (terminal) std::fprintf(stderr, "\rloading %3.0f %%  %-40.40s", 100 * fraction, what.c_str());
          return !interrupt.signal();
        },
        changes);
  } catch (const Error&) {
    if (!interrupt.signal()) throw;
    std::fprintf(stderr, "%slucerna: interrupted while loading; there is nothing to write\n",
                 terminal ? "\n" : "");
    return false;
  }
  if (terminal) std::fprintf(stderr, "\r%-60s\r", "");
  set_limits(r, a, changes);
  r.expect_seconds(a.seconds);
  choose_sampling(r, a, changes);
  choose_solvers(r, a, changes);
  if (!a.camera.empty()) r.choose_camera(a.camera);
  set_lens(r, a);
  if (!a.reference.empty()) r.progress().set_reference(a.reference);
  for (const auto& [name, file] : a.solver_load)
    if (!file.empty()) r.solver_load(name, file);
  return true;
}

/// Writes the outputs. An output that fails does not prevent the others.
class Outputs {
 public:
  explicit Outputs(std::map<std::string, std::string> work) : work_(std::move(work)) {}

  /// Solvers' work that is not yet written: files by solvers' names.
  const std::map<std::string, std::string>& work() const { return work_; }
  /// Writes solvers' work that is ready.
  void save_ready(session::Renderer& r) {
    std::erase_if(work_, [&](const auto& entry) {
      const auto& [name, file] = entry;
      const bool ready = solvers::ready(*r.solver(name));
      if (ready) attempt([&] { r.solvers().save(name, file); });
      return ready;
    });
  }
  /// Runs `write`; prints the error if it fails.
  void attempt(const std::function<void()>& write) {
    try {
      write();
    } catch (const std::exception& e) {
      fail(e.what());
    }
  }
  void fail(const std::string& why) {
    std::fprintf(stderr, "lucerna: %s\n", why.c_str());
    failed_ = true;
  }
  bool failed() const { return failed_; }

 private:
  std::map<std::string, std::string> work_;
  bool failed_ = false;
};

/// Sets the exposure automatically if the settings request it and neither the scene nor `changes` set one.
void find_exposure(session::Renderer& r, const std::vector<session::SettingChange>& changes) {
  if (r.settings().text("film.exposure_at_load") != "always") return;
  for (const session::SettingChange& change : changes)
    if (change.key == "film.ev") return;
  for (const auto& [key, value] : r.scene()->settings)
    if (key == "film.ev") return;
  const std::optional<float> ev = r.output().measure(std::nullopt).ev;
  if (!ev) return;
  r.settings().set("film.ev", fmt::format("{:.1f}", *ev));
  r.apply_settings();
  log::info("exposure found: film.ev={:.1f}", *ev);
}

/// The target of --error for the filtered picture. Filters at growing numbers of samples, which depend on
/// errors only, not on times: equal renders end equally. A filtering costs as much as one to eight samples
/// a pixel, together a tenth to a fifth of the time.
class FilteredGoal {
 public:
  explicit FilteredGoal(const RenderArguments& a)
      : target_(a.filter && makes_picture(a) ? a.error.value_or(0) : 0) {}

  /// True once the error of the filtered picture is at or under the target.
  bool reached(session::Renderer& r) {
    if (target_ == 0 || r.samples() < next_ || r.preparing()) return false;
    const double error = filtered_error(r, r.output().filter());
    if (error <= target_) return true;
    // Noise falls with the root of the number of samples at best.
    const double factor = std::clamp(std::pow(error / target_, 2), k_least_growth, k_most_growth);
    next_ = 2 * uint32_t(std::ceil(factor * r.samples() / 2));
    return false;
  }

 private:
  static constexpr double k_least_growth = 1.5, k_most_growth = 4;
  double target_;  ///< 0: none
  uint32_t next_ = 16;
};

/// Runs until picture and work are finished, the time is over, or an interrupt. Returns its seconds. `tev`: a
/// viewer that gets the picture meanwhile, or null.
double run(session::Renderer& r, const RenderArguments& a, const std::vector<session::SettingChange>& changes,
           Outputs& outputs, const Interrupt& interrupt, bool terminal, session::TevLink* tev) {
  const double limit = a.seconds.value_or(0);  // 0: none
  const Timer timer;
  Timer since_line;
  outputs.save_ready(r);
  FilteredGoal goal(a);
  bool covered = false;  // every pixel has a sample
  // Not if the user wants the solvers' work.
  bool may_prepare = !a.seconds || !makes_picture(a) || !outputs.work().empty();
  while ((makes_picture(a) || !outputs.work().empty()) && !r.done() && !interrupt.signal() &&
         (!a.seconds || timer.seconds() < limit)) {
    // Of the time since the picture was begun: with components.X=auto its solvers were chosen then.
    const double since = r.progress().seconds(), left = limit - (timer.seconds() - since);
    const double most = r.solvers().usable() ? plan::k_most_preparation : plan::k_latest_preparation;
    if (!may_prepare && since > most * left) {
      may_prepare = true;
      if (r.preparing()) {
        log::info("{:.0f} % of the time is over: the picture is rendered with the data prepared so far",
                  100 * timer.seconds() / limit);
        r.solvers().finish_early();
      }
    }
    if (!r.step()) break;
    outputs.save_ready(r);
    if (tev && !tev->follow(r)) tev = nullptr;
    if (!covered && r.samples() > 0) log::info("every pixel has a sample after {:.2f} s", timer.seconds());
    // Tiles get samples by the error as seen, which depends on the exposure.
    if (!covered && r.samples() > 0 && (r.sampling().adaptive() || r.sampling().balanced()))
      find_exposure(r, changes);
    covered = r.samples() > 0;
    if (terminal && since_line.seconds() > 0.2)
      print_progress(r, timer.seconds(), limit, false), since_line.restart();
    if (goal.reached(r) && outputs.work().empty()) break;
  }
  const double wall = timer.seconds();
  r.finish_ledger();
  if (terminal) print_progress(r, wall, limit, true);
  return wall;
}

/// A picture whose time was over before every pixel had a sample is partly or entirely black. Throws Error if
/// it is entirely black.
void check_time(const session::Renderer& r, const RenderArguments& a) {
  if (!a.seconds || !makes_picture(a) || r.samples() > 0) return;
  const double share = double(r.stats().paths) / (double(r.film().width()) * double(r.film().height()));
  if (share > 0)
    return log::warning("--time: after {:g} s {:.0f} % of the picture has a sample; the rest is black",
                        *a.seconds, 100 * share);
  std::vector<std::string> at_work;
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (const solvers::Solver* found = r.solver(solver->name); found && !solvers::ready(*found))
      at_work.push_back(solver->title);
  throw_error("--time",
              "'{:g}': no pixel has a sample after this many seconds{}; no file was written. Allow more "
              "time, or prepare less",
              *a.seconds,
              at_work.empty() ? "" : fmt::format(": {} was still at work", fmt::join(at_work, ", ")));
}

/// Advice for errors that solvers' work causes.
std::string advice(const session::Renderer& r) {
  std::string text;
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    if (!r.solver(solver->name)) continue;
    std::vector<std::string> what;
    if (!solver->against_noise.empty())
      what.push_back(fmt::format("{} for less noise", fmt::join(solver->against_noise, ", ")));
    if (!solver->against_bias.empty())
      what.push_back(fmt::format("{} for less bias", fmt::join(solver->against_bias, ", ")));
    if (!what.empty())
      text += fmt::format("{}settings of {} reduce it: {}", text.empty() ? "" : "; ", solver->title,
                          fmt::join(what, ", "));
  }
  return text;
}

/// Filters the picture (--filter), and compares its error with --error.
void filter(session::Renderer& r, const std::optional<double>& target) {
  if (r.samples() < 2)
    log::warning("--filter: pixels with fewer than two samples stay unfiltered: their noise is unknown");
  const session::Filtered& f = r.output().filtered() ? *r.output().filtered() : r.output().filter();
  log::info("filtered in {:.2f} s; estimated error {:.2g} %", 1e-3 * f.ms(), 100 * f.error.relative());
  for (const auto& [kernel, ms] : f.kernel_ms) log::debug("filter: {}: {:.1f} ms", kernel, ms);
  if (!target) return;
  const double error = filtered_error(r, f);
  if (error <= *target)
    log::info("the filtered picture has reached the error of {:g}: {:.3g}, with {} samples", *target, error,
              r.samples());
  else
    log::warning("the filtered picture has an error of {:.3g} after {} samples, over the error of {:g}{}",
                 error, r.samples(), *target,
                 error > 2 * f.error.relative()
                     ? "; most of it comes from lookups, which more samples do not change"
                     : ". More samples: --samples N");
}

/// Records paths of the finished picture (--record-paths).
void record_paths(session::Renderer& r, const RenderArguments& a, const Interrupt& interrupt) {
  constexpr size_t k_part = 1 << 16;
  const Timer timer;
  const uint32_t width = r.film().width(), height = r.film().height();
  const schedule::Rectangle sampled =
      r.sampling().chosen_region().value_or(schedule::Rectangle{0, 0, width, height});
  session::PathSelection selection{.left = sampled.left,
                                   .top = sampled.top,
                                   .right = sampled.right,
                                   .bottom = sampled.bottom,
                                   .samples = r.samples()};
  if (a.record_region.size() == 4) {
    const schedule::Rectangle wanted = pixels_of(a.record_region, "--record-region", width, height);
    selection.left = std::max(wanted.left, sampled.left), selection.top = std::max(wanted.top, sampled.top);
    selection.right = std::min(wanted.right, sampled.right),
    selection.bottom = std::min(wanted.bottom, sampled.bottom);
    if (selection.left >= selection.right || selection.top >= selection.bottom)
      throw Error("--record-region", "none of these pixels has samples: the region of --region is elsewhere");
  }
  selection.every = uint32_t(a.record_every);
  session::PathChoices choices(selection, width, height);
  const recording::Recording names = r.paths().begin();
  nlohmann::ordered_json about;
  about["settings"] = r.settings().changed_json();
  about["samples"] = selection.samples, about["every"] = selection.every, about["over"] = a.record_over;
  about["region"] = {selection.left, selection.top, selection.right, selection.bottom};
  recording::Writer writer(a.record_paths, names, about);
  uint64_t traced = 0, lost = 0;
  while (!choices.done() && !interrupt.signal()) {
    recording::Recording part = names;
    r.paths().record(choices.take(k_part), part, [&] { return interrupt.signal() != 0; });
    traced += part.paths.size();
    if (a.record_over > 0) recording::keep_over(part, a.record_over);
    lost += part.lost();
    writer.add(part);
  }
  writer.finish();
  log::info("{}: {} paths of {} traced again, {} events, in {:.2f} s", a.record_paths, writer.paths(), traced,
            writer.events(), timer.seconds());
  if (lost > 0) log::warning("{}: {} events had no room: their light is missing", a.record_paths, lost);
}

}  // namespace

int render(const RenderArguments& a) {
  const auto [width, height] = parse_size(a.size);
  std::map<std::string, std::string> to_save;  // solvers' work that is not yet written
  for (const auto& [name, file] : a.solver_save)
    if (!file.empty()) to_save[name] = file;
  check_outputs(a, to_save);
  const std::vector<session::SettingChange> changes = setting_changes(a, width, height);
  std::optional<film::TevAddress> viewer;
  if (a.tev) viewer = film::parse_tev_address(*a.tev, "--tev");
  std::optional<session::TevLink> tev;
  session::Renderer r(
      {.device = a.device, .validation = false, .shaders = {}, .defines = {}, .scenes = a.scenes});
  r.set_size(width, height);

  const Interrupt interrupt;
  const bool terminal = !a.quiet && isatty(2);
  if (!load(r, a, changes, interrupt, terminal)) return interrupt.status();
  if (a.filter && r.sampling().chosen_region())
    throw Error("--filter", "a region is not filtered: its edges need the pixels around it");
  if (a.filter && !r.film().fits_storage_buffers())
    throw_error("--filter", "{}x{} exceeds the size that this device can filter", width, height);
  for (const auto& [name, file] : to_save)
    if (!r.solver(name))
      throw_error(fmt::format("--{}-save", name),
                  "no component is computed by '{}'; add --set components.secondary={}", name, name);
  Outputs outputs(to_save);
  if (viewer) tev.emplace(*viewer, r.scene()->name);
  const commands::Viewpoint first = commands::make_viewpoint(r.camera(), scene::core_bounds(*r.scene()));
  double wall = 0;
  for (uint32_t view = 0; view < std::max(1u, a.turntable) && !interrupt.signal(); ++view) {
    if (view > 0) {
      commands::Viewpoint turned = first;
      commands::orbit(turned, {2 * k_pi * float(view) / float(a.turntable), 0});
      r.set_camera(turned.camera);
    }
    wall = run(r, a, changes, outputs, interrupt, terminal, tev ? &*tev : nullptr);
    if (interrupt.signal())
      std::fprintf(stderr, "lucerna: interrupted after %u samples; writing the present picture\n",
                   uint32_t(r.sampling().mean_samples()));
    else
      check_time(r, a);
    if (makes_picture(a) && r.sampling().adaptive() && !interrupt.signal())
      report_unreached(*r.sampling().adaptive(), advice(r)), report_unseen(r);
    // All pictures of a turntable have the exposure of the first.
    if (makes_picture(a) && view == 0) outputs.attempt([&] { find_exposure(r, changes); });
    if (a.filter && makes_picture(a)) outputs.attempt([&] { filter(r, a.error); });
    for (const std::string& file : a.outputs)
      outputs.attempt([&] { r.output().save(a.turntable > 0 ? numbered(file, view + 1) : file); });
    if (tev) outputs.attempt([&] { tev->finish(r); });
  }
  const bool interrupted = interrupt.signal() != 0;
  if (!a.ledger.empty()) outputs.attempt([&] { write_file(a.ledger, r.progress().ledger().csv()); });
  if (!a.stats.empty())
    outputs.attempt([&] {
      nlohmann::ordered_json stats = make_stats(r, wall);
      if (r.output().filtered() && a.error) {
        nlohmann::ordered_json& filtered = stats["filtered"];
        filtered["target_error"] = *a.error;
        filtered["reached"] = filtered["of_mean"].get<double>() <= *a.error;
      }
      write_file(a.stats, json_text(stats, 2) + "\n");
    });
  if (!a.record_paths.empty()) outputs.attempt([&] { record_paths(r, a, interrupt); });
  for (const auto& [name, file] : outputs.work())
    if (interrupted)
      std::fprintf(stderr, "lucerna: %s: not written; its data was incomplete\n", file.c_str());
    else
      outputs.fail(fmt::format("{}: not written: {} was incomplete when rendering ended", file,
                               solvers::find(name)->title));
  if (r.stats().dropped) log::warning("{} contributions were not finite and were dropped", r.stats().dropped);
  return interrupted ? interrupt.status() : outputs.failed() ? 1 : 0;
}

}  // namespace lucerna::app
