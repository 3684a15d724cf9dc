#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/interrupt.h"
#include "app/verbs.h"
#include "base/file.h"
#include "base/log.h"
#include "base/timer.h"
#include "session/renderer.h"
#include "stats/forecast.h"

namespace lucerna::app {
namespace {

std::pair<uint32_t, uint32_t> parse_size(const std::string& text) {
  unsigned long w = 0, h = 0;
  char rest = 0;
  if (text.find('-') != std::string::npos || std::sscanf(text.c_str(), "%lux%lu%c", &w, &h, &rest) != 2 ||
      !w || !h || w > film::k_max_side || h > film::k_max_side)
    throw_error("--size", "'{}': expected WIDTHxHEIGHT, each from 1 to {}, such as 1280x720", text,
                film::k_max_side);
  return {uint32_t(w), uint32_t(h)};
}

void print_progress(const session::Renderer& r, double seconds, double limit, bool last) {
  const double share = limit > 0 ? std::min(1.0, seconds / limit) : double(r.samples()) / r.max_samples();
  const double paths = double(r.stats().paths) / (double(r.film().width()) * r.film().height());
  double done = limit > 0 ? share : std::max(share, paths / r.max_samples());
  if (const schedule::AdaptiveSchedule* s = r.adaptive(); s && limit <= 0)
    done = double(s->count(schedule::TileState::done) + s->count(schedule::TileState::capped)) /
           double(s->tiles().size());
  const double left = done > 0 ? seconds * (1 - done) / done : 0;
  std::fprintf(stderr, "\r%5.1f %%  %u/%u samples  %.2f Mray/s  %.2f samples/s  %s %.0f s left   %s",
               100 * done, r.samples(), r.max_samples(),
               1e-6 * double(r.stats().rays) / std::max(seconds, 1e-9), paths / std::max(seconds, 1e-9),
               "about", left, last ? "\n" : "");
  std::fflush(stderr);
}

/// Noise of the picture, estimated from its halves (film/error.h); beside it the bias, where the solver can
/// tell.
nlohmann::ordered_json make_error(session::Renderer& r) {
  const film::ImageError error = r.image_error();
  nlohmann::ordered_json j;
  j["of"] = "sum";
  j["rms"] = film::error_sum(error.rms[0], error.records_rms, error.interpolation_rms);
  j["relative"] = error.relative_sum();
  const std::vector<film::TileError> tiles = r.tile_errors();
  const auto tell_tiles = [](nlohmann::ordered_json& to, const film::TileSpread& spread) {
    to["tile_median"] = spread.median;
    to["tile_worst_decile"] = spread.worst_tenth;
    to["tile_worst"] = spread.worst;
  };
  const film::TileSpread sum = film::tile_spread(tiles);
  tell_tiles(j, sum);
  j["heavy_tailed_tiles"] = sum.heavy_tailed;
  // The parts of that sum, by where they come from.
  const auto part = [&](const char* name, double rms, double relative, double film::TileError::*of) {
    j[name] = {{"rms", rms}, {"relative", relative}};
    tell_tiles(j[name], film::tile_spread(tiles, of));
  };
  part("paths", error.rms[0], error.relative(0), &film::TileError::relative);
  if (r.looks_up() && !r.film().records_told()) j["records"] = j["interpolation"] = nullptr;
  if (r.film().records_told()) {
    part("records", error.records_rms, error.relative_records(), &film::TileError::relative_records);
    part("interpolation", error.interpolation_rms, error.relative_interpolation(),
         &film::TileError::relative_interpolation);
  }
  for (int c = 0; c < paths::k_component_count; ++c) {
    auto& component = j["components"][paths::k_component_names[c]];
    component = {{"rms", error.rms[c + 1]}, {"relative", error.relative(c + 1)}, {"bias", nullptr}};
    if (const auto bias = r.bias(size_t(c))) component["bias"] = *bias;
  }
  return j;
}

/// Difference from the reference, whose own noise is taken off where its file tells it.
nlohmann::ordered_json make_truth(const film::Reference& reference, const stats::Ledger& ledger) {
  nlohmann::ordered_json j;
  j["reference"] = reference.file.string();
  for (int k = 0; k < stats::k_layers; ++k) {
    auto& layer = j[stats::k_layer_names[k]];
    if (!ledger.entries().empty() && ledger.entries().back().truth)
      layer["relative"] = (*ledger.entries().back().truth)[k];
    if (reference.noise) layer["reference_noise"] = (*reference.noise)[k] / reference.mean_luminance;
  }
  return j;
}

/// Tiles that are over the target though they have all the samples they may have, the worst first.
std::vector<uint32_t> unreached(const schedule::AdaptiveSchedule& s) {
  std::vector<uint32_t> list;
  for (uint32_t t = 0; t < s.tiles().size(); ++t)
    if (s.tiles()[t].state != schedule::TileState::done) list.push_back(t);
  std::sort(list.begin(), list.end(), [&](uint32_t a, uint32_t b) {
    const float ea = s.tiles()[a].sum(), eb = s.tiles()[b].sum();
    return ea != eb ? ea > eb : a < b;
  });
  return list;
}

/// Of these, those that records keep over it: more samples would not help.
size_t limited(const schedule::AdaptiveSchedule& s) {
  return size_t(std::count_if(s.tiles().begin(), s.tiles().end(),
                              [&](const schedule::Tile& t) { return t.limited(s.options().target_error); }));
}

nlohmann::ordered_json make_tiles(const schedule::AdaptiveSchedule& s) {
  using schedule::TileState;
  nlohmann::ordered_json j;
  j["side"] = s.options().tile;
  j["target_error"] = s.options().target_error;
  j["count"] = s.tiles().size();
  j["done"] = s.count(TileState::done);
  j["capped"] = s.count(TileState::capped);
  j["limited_by_records"] = limited(s);
  j["unfinished"] = s.count(TileState::active) + s.count(TileState::waiting);
  j["least_samples"] = s.least_samples();
  j["most_samples"] = s.most_samples();
  j["unreached"] = nlohmann::ordered_json::array();
  for (const uint32_t t : unreached(s)) {
    const schedule::Tile& tile = s.tiles()[t];
    j["unreached"].push_back({{"x", t % s.tiles_across() * s.options().tile},
                              {"y", t / s.tiles_across() * s.options().tile},
                              {"error", tile.sum()},
                              {"paths", tile.error},
                              {"records", tile.records},
                              {"interpolation", tile.interpolation},
                              {"samples", tile.samples}});
  }
  return j;
}

void report_unreached(const schedule::AdaptiveSchedule& s, const std::string& advice) {
  const std::vector<uint32_t> list = unreached(s);
  if (list.empty()) return;
  const schedule::Tile& worst = s.tiles()[list.front()];
  const size_t by_records = limited(s);
  if (by_records > 0)
    log::warning(
        "{} of {} tiles stay over the error of {} because of the records that they read; the worst is off by "
        "{:.3f}, the paths by {:.3f} of that, at x {} y {}. More samples do not help; {}",
        by_records, s.tiles().size(), s.options().target_error, worst.sum(), worst.error,
        list.front() % s.tiles_across() * s.options().tile,
        list.front() / s.tiles_across() * s.options().tile, advice);
  if (by_records == list.size()) return;
  log::warning(
      "{} of {} tiles are over the error of {}: {} with all of {} samples, {} not finished; the worst, "
      "{:.3f}, "
      "at x {} y {}. More samples: --set sampling.max_samples=N",
      list.size() - by_records, s.tiles().size(), s.options().target_error,
      s.count(schedule::TileState::capped) - by_records, s.options().max_samples,
      list.size() - s.count(schedule::TileState::capped), worst.sum(),
      list.front() % s.tiles_across() * s.options().tile, list.front() / s.tiles_across() * s.options().tile);
}

nlohmann::ordered_json make_ledger(const stats::Ledger& ledger) {
  auto list = nlohmann::ordered_json::array();
  for (const stats::Entry& e : ledger.entries()) {
    nlohmann::ordered_json j{{"wall_s", e.wall_s},         {"render_s", e.render_s}, {"device_s", e.device_s},
                             {"prepared_s", e.prepared_s}, {"paths", e.paths},       {"rays", e.rays},
                             {"samples", e.samples}};
    for (int k = 0; k < stats::k_layers; ++k) {
      if (e.told) j["error"][stats::k_layer_names[k]] = e.error[k];
      j["component_s"][stats::k_layer_names[k]] = e.component_s[k];
    }
    if (e.told)
      j["error_records"] = e.records, j["error_interpolation"] = e.interpolation, j["error_told"] = e.sum(),
      j["tile_median"] = e.tile_median, j["tile_worst_decile"] = e.tile_worst_tenth,
      j["error_degrees"] = e.degrees;
    if (e.truth)
      for (int k = 0; k < stats::k_layers; ++k) j["truth"][stats::k_layer_names[k]] = (*e.truth)[k];
    if (e.total_rays) j["forecast_rays"] = {e.total_rays->low, e.total_rays->middle, e.total_rays->high};
    list.push_back(std::move(j));
  }
  return list;
}

/// Seconds that smaller errors take or took, as [low, middle, high]; in uniform sampling. Empty before there
/// is enough to tell by. Errors that records keep the picture over, whatever the samples, are listed.
nlohmann::ordered_json make_forecast(const stats::Ledger& ledger) {
  auto j = nlohmann::ordered_json::object();
  for (const double target : {0.05, 0.02, 0.01, 0.005}) {
    if (const auto band = stats::seconds_to(ledger, target))
      j["seconds_to"][fmt::format("{}", target)] = {band->low, band->middle, band->high};
    if (stats::paths_target(ledger, target) <= 0) j["limited_by_records"].push_back(target);
  }
  if (const stats::Outlook outlook(ledger); outlook.known()) j["exponent"] = outlook.exponent();
  return j;
}

nlohmann::ordered_json make_stats(session::Renderer& r, double wall) {
  const auto means = film::Film::means(r.image());
  nlohmann::ordered_json j;
  j["version"] = LUCERNA_VERSION;
  j["scene"] = r.scene()->file;
  j["device"] = r.device().info().name;
  j["tracer"] = r.tracer_name();
  j["width"] = r.film().width();
  j["height"] = r.film().height();
  j["settings"] = nlohmann::ordered_json::parse(r.settings().changed_json());
  j["wall_s"] = wall;
  j["load_s"] = r.load_seconds();
  j["compile_s"] = r.compile_seconds();
  j["samples"] = r.samples();
  j["paths"] = r.stats().paths;
  j["rays"] = r.stats().rays;
  j["shadow_rays"] = r.stats().shadow_rays;
  j["mrays_per_s"] = 1e-6 * double(r.stats().rays) / std::max(wall, 1e-9);
  j["dropped"] = r.stats().dropped;
  j["ended_by_roulette"] = r.stats().roulette;
  j["ended_by_depth"] = r.stats().depth;
  j["peak_host_mb"] = session::peak_host_mb();
  j["peak_device_mb"] = double(r.device().peak_bytes()) / (1 << 20);
  j["error"] = make_error(r);
  if (const film::Reference* reference = r.reference()) j["truth"] = make_truth(*reference, r.ledger());
  if (r.adaptive()) j["tiles"] = make_tiles(*r.adaptive());
  j["ledger"] = make_ledger(r.ledger());
  if (!r.adaptive()) j["forecast"] = make_forecast(r.ledger());
  j.update(r.solver_statistics());
  for (const auto& s : r.stats().stages)
    j["stages"].push_back({{"name", s.name}, {"ms", s.ms}, {"on", s.host ? "host" : "device"}});
  for (int c = 0; c < paths::k_component_count; ++c) {
    const std::string name = paths::k_component_names[c];
    j["components"][name] = {{"solver", r.settings().text("components." + name)},
                             {"mean_radiance", {means[c].x, means[c].y, means[c].z}},
                             {"ms", r.stats().component_ms[c]}};
  }
  return j;
}

}  // namespace

int render(const RenderArguments& a) {
  const auto [width, height] = parse_size(a.size);
  const bool picture = !a.outputs.empty() || !a.stats.empty() || !a.ledger.empty();
  std::map<std::string, std::string> to_save;  // solvers' work that is not yet written
  for (const auto& [name, file] : a.solver_save)
    if (!file.empty()) to_save[name] = file;
  if (!picture && to_save.empty())
    throw Error(
        "-o",
        "name at least one output: OUT.exr or OUT.png, or figures alone: --stats OUT.json, or records "
        "alone: --cache-save OUT.cache");
  for (const std::string& file : a.outputs) {
    const auto dot = file.rfind('.');
    const std::string extension = dot == std::string::npos ? "" : file.substr(dot);
    if (extension != ".exr" && extension != ".png")
      throw_error(file, "cannot write '{}' files; use .exr or .png", extension);
    film::check_writable(file);
  }
  if (!a.stats.empty()) check_writable(a.stats);
  if (!a.ledger.empty()) check_writable(a.ledger);
  for (const auto& [name, file] : to_save) check_writable(file);
  if (a.seconds && !(std::isfinite(*a.seconds) && *a.seconds > 0))
    throw_error("--time", "'{}': expected a positive number of seconds", *a.seconds);
  const double limit = a.seconds.value_or(0);  // 0: none
  session::Renderer r(
      {.device = a.device, .validation = false, .shaders = {}, .defines = {}, .scenes = a.scenes});
  r.set_size(width, height);
  // What the command line says stands above the scene's own settings; checked before the scene is loaded.
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
    if (a.error) change("sampling.max_samples", std::to_string(a.samples));
  }
  if (a.error) {
    if (!(*a.error > 0))
      throw_error("--error", "'{}': expected a positive relative error, such as 0.02", *a.error);
    change("sampling.mode", "adaptive");
    change("sampling.target_error", fmt::format("{}", *a.error));
  }
  if (a.seed != -1) change("seed", std::to_string(a.seed));
  if (a.seconds && a.samples == -1) change("samples", "1048576");
  plan::Settings probe;
  for (const session::SettingChange& c : changes) probe.set(c.key, c.value, c.where);

  const Interrupt interrupt;
  const bool terminal = !a.quiet && isatty(2);
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
    return interrupt.status();
  }
  if (terminal) std::fprintf(stderr, "\r%-60s\r", "");
  if (!a.camera.empty()) r.choose_camera(a.camera);
  if (!a.reference.empty()) r.set_reference(a.reference);
  for (const auto& [name, file] : a.solver_load)
    if (!file.empty()) r.solver_load(name, file);
  for (const auto& [name, file] : to_save)
    if (!r.solver(name))
      throw_error(fmt::format("--{}-save", name),
                  "no component is computed by '{}'; add --set components.secondary={}", name, name);

  const Timer timer;
  Timer since_line;
  const auto save_ready = [&] {
    std::erase_if(to_save, [&](const auto& entry) {
      const auto& [name, file] = entry;
      const bool ready = r.solver(name)->ready();
      if (ready) r.solver_save(name, file);
      return ready;
    });
  };
  save_ready();
  bool covered = false;  // every pixel has a sample
  while ((picture || !to_save.empty()) && !r.done() && !interrupt.signal() &&
         (!a.seconds || timer.seconds() < limit)) {
    if (!r.step()) break;
    save_ready();
    if (!covered && r.samples() > 0) log::info("a sample of every pixel after {:.2f} s", timer.seconds());
    covered = r.samples() > 0;
    if (terminal && since_line.seconds() > 0.2)
      print_progress(r, timer.seconds(), limit, false), since_line.restart();
  }
  const double wall = timer.seconds();
  r.finish_ledger();
  if (terminal) print_progress(r, wall, limit, true);
  const bool interrupted = interrupt.signal() != 0;
  if (interrupted)
    std::fprintf(stderr, "lucerna: interrupted after %u samples; writing what there is\n", r.samples());
  if (picture && r.adaptive() && !interrupted) {
    std::string advice;
    for (const solvers::SolverInfo* solver : solvers::registered())
      if (r.solver(solver->name))
        advice += fmt::format("{}other settings of {} do: {} against its noise, {} against its bias",
                              advice.empty() ? "" : "; ", solver->title,
                              fmt::join(solver->against_noise, ", "), fmt::join(solver->against_bias, ", "));
    report_unreached(*r.adaptive(), advice);
  }
  if (picture && r.settings().text("film.exposure_at_load") == "always") {
    const auto names_ev = [](const auto& list, const auto& key_of) {
      return std::any_of(list.begin(), list.end(), [&](const auto& s) { return key_of(s) == "film.ev"; });
    };
    const bool given = names_ev(changes, [](const session::SettingChange& c) { return c.key; }) ||
                       names_ev(r.scene()->settings, [](const auto& s) { return s.first; });
    if (const auto ev = given ? std::nullopt : r.measure(std::nullopt).ev) {
      r.settings().set("film.ev", fmt::format("{:.1f}", *ev));
      r.apply_settings();
      log::info("exposure found: film.ev={:.1f}", *ev);
    }
  }
  for (const std::string& file : a.outputs) r.save(file);
  if (!a.ledger.empty()) write_file(a.ledger, r.ledger().csv());
  if (!a.stats.empty()) write_file(a.stats, make_stats(r, wall).dump(2) + "\n");
  for (const auto& [name, file] : to_save) {
    if (!interrupted)
      throw_error(file, "not written: {} was still being built when rendering ended",
                  solvers::find(name)->title);
    std::fprintf(stderr, "lucerna: %s: not written; it was still being built\n", file.c_str());
  }
  if (r.stats().dropped) log::warning("{} contributions were not finite and were dropped", r.stats().dropped);
  return interrupted ? interrupt.status() : 0;
}

}  // namespace lucerna::app
