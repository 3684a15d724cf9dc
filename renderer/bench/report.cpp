#include "bench/report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/analysis.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;
using Curve = std::vector<Point>;

constexpr size_t k_curve_steps = 48;
const char* const k_kinds[] = {"measured", "at_once", "extrapolated", "unknown"};

Json to_json(const Spread& s) { return {{"median", s.median}, {"low", s.low}, {"high", s.high}}; }

/// The repeats of one setting on one scene, by budget.
struct Group {
  std::vector<std::vector<const Result*>> budgets;
  /// Results of the largest budget with any: their curves are those of the setting.
  const std::vector<const Result*>& largest() const {
    static const std::vector<const Result*> k_none;
    for (size_t b = budgets.size(); b-- > 0;)
      if (!budgets[b].empty()) return budgets[b];
    return k_none;
  }
  /// For a setting with a separate program, by repeat: the points of all its budgets as one curve.
  std::vector<Result> joined;
  std::vector<const Result*> with_curves() const {
    if (joined.empty()) return largest();
    std::vector<const Result*> all;
    for (const Result& r : joined) all.push_back(&r);
    return all;
  }
};

/// Joins a repeat's budgets into its curve, because only the end of another program's render is available.
std::vector<Result> join_budgets(const Group& group) {
  std::map<int, Result> repeats;
  for (const auto& results : group.budgets)
    for (const Result* r : results) {
      Result& joined = repeats[r->repeat];
      std::vector<CurvePoint> curve = std::move(joined.curve);
      joined = *r;
      curve.insert(curve.end(), r->curve.begin(), r->curve.end());
      std::stable_sort(curve.begin(), curve.end(),
                       [](const CurvePoint& a, const CurvePoint& b) { return a.wall_s < b.wall_s; });
      joined.curve = std::move(curve);
    }
  std::vector<Result> all;
  for (auto& [repeat, joined] : repeats) all.push_back(std::move(joined));
  return all;
}

template <class F>
std::vector<double> collect(const std::vector<const Result*>& results, F value) {
  std::vector<double> values;
  for (const Result* r : results) values.push_back(double(value(*r)));
  return values;
}

/// Points whose error exceeds the reference's noise.
Curve true_curve(const Result& r, double reference_noise) {
  Curve curve;
  for (const CurvePoint& p : r.curve)
    if (p.truth[0] > 0.7 * reference_noise && p.truth[0] > 0) curve.push_back({p.wall_s, p.truth[0]});
  return curve;
}

Curve tiles_curve(const Result& r) {
  Curve curve;
  for (const CurvePoint& p : r.curve)
    if (p.tiles > 0) curve.push_back({p.wall_s, p.tiles});
  return curve;
}

/// Curve of the roots, whose square falls as 1 / time, like the other errors.
Curve relmse_curve(const Result& r) {
  Curve curve;
  for (const CurvePoint& p : r.curve)
    if (p.relmse > 0) curve.push_back({p.wall_s, std::sqrt(p.relmse)});
  return curve;
}

/// Like relmse_curve().
Curve seen_curve(const Result& r) {
  Curve curve;
  for (const CurvePoint& p : r.curve)
    if (p.seen > 0) curve.push_back({p.wall_s, std::sqrt(p.seen)});
  return curve;
}

Json curve_json(const std::vector<Curve>& curves) {
  Json list = Json::array();
  for (const Band& b : common_curve(curves, k_curve_steps))
    list.push_back({b.seconds, b.error.median, b.error.low, b.error.high});
  return list;
}

struct Reached {
  ReachKind kind = ReachKind::unknown;
  Spread seconds;
  std::vector<double> repeats;
};

Reached reached(const std::vector<Curve>& curves, double target) {
  std::vector<double> seconds;
  std::array<size_t, 4> kinds{};
  for (const Curve& c : curves) {
    const Reach r = time_to(c, target);
    if (r.kind == ReachKind::unknown) continue;
    seconds.push_back(r.seconds), ++kinds[size_t(r.kind)];
  }
  if (seconds.empty()) return {};
  // Half of the repeats suffice, because the median is reported.
  ReachKind kind = ReachKind::measured;
  for (const ReachKind k : {ReachKind::at_once, ReachKind::extrapolated})
    if (2 * kinds[size_t(k)] >= seconds.size()) kind = k;
  return {kind, spread(seconds), seconds};
}

/// Names of errors in the report.
struct Scale {
  std::vector<double> targets;  ///< targets of the curves
  bool squared = false;         ///< the report contains their squares
  double shown(double error) const { return squared ? error * error : error; }
  double from_shown(double error) const { return squared ? std::sqrt(error) : error; }
};

Scale rms_scale() { return {{std::begin(k_targets), std::end(k_targets)}, false}; }

Scale relmse_scale() {
  Scale scale{{}, true};
  for (const double target : k_relmse_targets) scale.targets.push_back(std::sqrt(target));
  return scale;
}

/// A repeat's time to all targets as one figure, for the noise of times.
std::vector<double> mean_times(const std::vector<Curve>& curves, const Scale& scale) {
  std::vector<double> times;
  for (const Curve& c : curves) {
    double sum = 0, count = 0;
    for (const double target : scale.targets)
      if (const Reach r = time_to(c, target); r.kind != ReachKind::unknown)
        sum += std::log(r.seconds), ++count;
    if (count > 0) times.push_back(std::exp(sum / count));
  }
  return times;
}

/// 1 / (squared error as seen * seconds) of each render, if known.
std::vector<double> seen_indices(const std::vector<const Result*>& results) {
  std::vector<double> values;
  for (const Result* r : results)
    if (const auto pi = performance_index(r->seen, r->wall_s)) values.push_back(*pi);
  return values;
}

std::vector<double> indices(const std::vector<const Result*>& results) {
  std::vector<double> values;
  for (const Result* r : results)
    if (const auto pi = performance_index(r->mse, r->wall_s); pi && !r->in_reference_noise)
      values.push_back(*pi);
  return values;
}

void add_ratio(Json& json, double ratio, const std::optional<double>& noise) {
  json["ratio"] = ratio;
  if (!noise) return;
  const double bound = *noise * (1 + 1e-9);  // bit-identical repeats have no noise
  json["noise"] = ratio <= bound && ratio >= 1 / bound;
  json["low"] = ratio / *noise, json["high"] = ratio * *noise;
}

/// Ratio of two times with its noise: that of the scene, or of these times if they scatter more.
void add_time_ratio(Json& json, const Reached& here, const Reached& there,
                    const std::optional<double>& of_scene) {
  const std::vector<double> both[] = {here.repeats, there.repeats};
  auto noise = noise_ratio(both, std::min(here.seconds.count, there.seconds.count));
  if (of_scene) noise = std::max(*of_scene, noise.value_or(1));
  add_ratio(json, there.seconds.median / here.seconds.median, noise);
}

Json times_json(const std::vector<Curve>& curves, const std::vector<Curve>& baseline, bool is_baseline,
                const std::optional<double>& noise, const Scale& scale) {
  Json list = Json::array();
  for (const double target : scale.targets) {
    const Reached here = reached(curves, target), there = reached(baseline, target);
    Json entry{{"error", scale.shown(target)}, {"kind", k_kinds[size_t(here.kind)]}};
    if (here.kind != ReachKind::unknown) entry["seconds"] = to_json(here.seconds);
    if (!is_baseline && here.kind != ReachKind::unknown && there.kind != ReachKind::unknown) {
      add_time_ratio(entry, here, there, noise);
      entry["ratio_kind"] = k_kinds[std::max(size_t(here.kind), size_t(there.kind))];
    }
    list.push_back(std::move(entry));
  }
  return list;
}

/// Two significant digits, rounded up.
double round_up(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return std::ceil(x / unit - 1e-9) * unit;
}

/// The smallest error that half the repeats of both settings reach permanently, and the ratio of times: the
/// only ratio without extrapolation.
std::optional<Json> common_json(const std::vector<Curve>& curves, const std::vector<Curve>& baseline,
                                const std::optional<double>& noise, const Scale& scale) {
  double error = 0;
  for (const auto* setting : {&curves, &baseline}) {
    std::vector<double> last;
    for (const Curve& c : *setting)
      if (!c.empty()) last.push_back(c.back().error);
    if (last.empty()) return std::nullopt;
    error = std::max(error, spread(std::move(last)).median);
  }
  for (; error < 2; error *= 1.05) {
    const double target = scale.from_shown(round_up(scale.shown(error)));
    const Reached here = reached(curves, target), there = reached(baseline, target);
    if (here.kind != ReachKind::measured || there.kind != ReachKind::measured) continue;
    Json entry{{"error", scale.shown(target)},
               {"seconds", here.seconds.median},
               {"first_seconds", there.seconds.median}};
    add_time_ratio(entry, here, there, noise);
    return entry;
  }
  return std::nullopt;
}

Json cells_json(const Matrix& m, size_t scene, size_t setting, const Group& group) {
  Json list = Json::array();
  for (size_t b = 0; b < group.budgets.size(); ++b) {
    const auto& results = group.budgets[b];
    if (results.empty()) continue;
    Json cell{{"budget", m.budget({scene, setting, b, 0}).text()}, {"repeats", results.size()}};
    const auto add = [&](const char* name, auto value) {
      cell[name] = to_json(spread(collect(results, value)));
    };
    add("wall_s", [](const Result& r) { return r.wall_s; });
    add("device_s", [](const Result& r) { return r.device_s; });
    add("samples", [](const Result& r) { return r.samples; });
    add("rays", [](const Result& r) { return r.rays; });
    add("estimated", [](const Result& r) { return r.estimated[0]; });
    add("true", [](const Result& r) { return r.truth[0]; });
    add("relmse", [](const Result& r) { return r.relmse; });
    add("relmse_all", [](const Result& r) { return r.relmse_all; });
    add("seen", [](const Result& r) { return r.seen; });
    add("seen_all", [](const Result& r) { return r.seen_all; });
    add("tiles_median", [](const Result& r) { return r.tiles.median; });
    add("tiles_decile", [](const Result& r) { return r.tiles.decile; });
    add("heavy_tiles", [](const Result& r) { return r.tiles.heavy; });
    add("tiles_over", [](const Result& r) { return r.tiles.over; });
    add("records", [](const Result& r) { return r.records; });
    add("record_rays", [](const Result& r) { return r.record_rays; });
    add("paths_error", [](const Result& r) { return r.parts.paths; });
    add("records_error", [](const Result& r) { return r.parts.records; });
    add("interpolation_error", [](const Result& r) { return r.parts.interpolation; });
    for (size_t k = 1; k < stats::k_layers; ++k) {
      Json& layer = cell["components"][stats::k_layer_names[k]];
      layer["true"] = to_json(spread(collect(results, [&](const Result& r) { return r.truth[k]; })));
      layer["estimated"] = to_json(spread(collect(results, [&](const Result& r) { return r.estimated[k]; })));
      layer["device_s"] =
          to_json(spread(collect(results, [&](const Result& r) { return r.component_s[k]; })));
    }
    const auto in_noise =
        std::count_if(results.begin(), results.end(), [](const Result* r) { return r->in_reference_noise; });
    cell["in_reference_noise"] = 2 * size_t(in_noise) >= results.size();
    list.push_back(std::move(cell));
  }
  return list;
}

std::optional<Json> forecast_json(const std::vector<const Result*>& results) {
  std::vector<double> seconds, rays;
  double at = 0;
  size_t in_band = 0;
  for (const Result* r : results) {
    if (!r->forecast || !(r->forecast->seconds.middle > 0) || r->rays == 0) continue;
    seconds.push_back(r->forecast->seconds.middle / r->wall_s);
    rays.push_back(r->forecast->rays.middle / double(r->rays));
    in_band += r->wall_s >= r->forecast->seconds.low && r->wall_s <= r->forecast->seconds.high;
    at += r->forecast->at_s / r->wall_s;
  }
  if (seconds.empty()) return std::nullopt;
  const size_t n = seconds.size();
  return Json{{"at", at / double(n)},
              {"seconds", to_json(spread(std::move(seconds)))},
              {"rays", to_json(spread(std::move(rays)))},
              {"in_band", in_band},
              {"of", n}};
}

/// Largest time of the series 1, 2, 5, 10 .. up to t.
double round_down(double t) {
  const double power = std::pow(10.0, std::floor(std::log10(t)));
  for (const double step : {5.0, 2.0})
    if (step * power <= t * (1 + 1e-9)) return step * power;
  return power;
}

/// Short times covered by all settings on this scene.
std::vector<double> fixed_times(const std::vector<std::vector<Curve>>& settings) {
  double from = 0, to = 0;
  for (const auto& curves : settings)
    for (const Curve& c : curves) {
      if (c.empty()) return {};
      from = std::max(from, c.front().seconds);
      to = to == 0 ? c.back().seconds : std::min(to, c.back().seconds);
    }
  if (!(to > from) || !(from > 0)) return {};
  const double late = round_down(to), early = round_down(late / 4);
  std::vector<double> times;
  for (const double t : {early, late})
    if (t >= from) times.push_back(t);
  return times;
}

/// Final relative error, and the first setting's after as many seconds.
void add_relmse_end(Json& e, const std::vector<const Result*>& results, const std::vector<Curve>& curves,
                    const std::vector<Curve>& baseline, bool is_baseline,
                    const std::optional<double>& noise) {
  std::vector<double> powers, theirs;
  for (const Curve& c : curves)
    if (const auto power = power_of_time(c)) powers.push_back(*power);
  if (!powers.empty()) e["relmse_power"] = to_json(spread(std::move(powers)));
  const double seconds = spread(collect(results, [](const Result& r) { return r.wall_s; })).median;
  const Spread own = spread(collect(results, [](const Result& r) { return r.relmse; }));
  e["relmse_end"] = {{"seconds", seconds}, {"relmse", to_json(own)}};
  if (is_baseline) return;
  ReachKind kind = ReachKind::measured;
  for (const Curve& c : baseline) {
    const ErrorAfter error = error_after(c, seconds);
    if (error.kind == ReachKind::unknown) continue;
    theirs.push_back(error.error * error.error);
    kind = std::max(kind, error.kind);
  }
  if (theirs.empty()) return;
  const Spread first = spread(std::move(theirs));
  e["relmse_end"]["first"] = to_json(first);
  e["relmse_end"]["kind"] = k_kinds[size_t(kind)];
  // Relative noise of a squared error at a time equals that of the time to an error, because error^2 * time
  // is constant.
  if (own.median > 0) add_ratio(e["relmse_end"], first.median / own.median, noise);
}

/// Adds to the cells of a setting, as `key`, their efficiency as seen, by variance x time, relative to
/// another setting's cells of the same budget.
void add_seen_ratios(Json& cells, const char* key, const std::vector<std::vector<const Result*>>& own,
                     const std::vector<std::vector<const Result*>>& others,
                     const std::optional<double>& noise) {
  size_t at = 0;
  for (size_t b = 0; b < own.size(); ++b) {
    if (own[b].empty()) continue;
    Json& cell = cells[at++];
    if (b >= others.size()) continue;
    const std::vector<double> here = seen_indices(own[b]), there = seen_indices(others[b]);
    if (here.empty() || there.empty()) continue;
    cell[key] = Json::object();
    add_ratio(cell[key], spread(here).median / spread(there).median, noise);
  }
}

Json scene_json(const Matrix& m, size_t s, const std::vector<Group>& groups, double reference_noise,
                std::vector<std::optional<double>>& relative_indices) {
  const size_t n = groups.size();
  const Scale rms = rms_scale(), squared = relmse_scale();
  std::vector<std::vector<Curve>> curves(n), tiles(n), relative(n), seen(n);
  std::vector<std::vector<double>> times, tile_times, relative_times, seen_times, seen_pis, rates, pis(n);
  for (size_t k = 0; k < n; ++k) {
    for (const Result* r : groups[k].with_curves()) {
      curves[k].push_back(true_curve(*r, reference_noise));
      tiles[k].push_back(tiles_curve(*r));
      relative[k].push_back(relmse_curve(*r));
      seen[k].push_back(seen_curve(*r));
    }
    times.push_back(mean_times(curves[k], rms));
    tile_times.push_back(mean_times(tiles[k], rms));
    relative_times.push_back(mean_times(relative[k], squared));
    seen_times.push_back(mean_times(seen[k], rms));
    for (const auto& results : groups[k].budgets) seen_pis.push_back(seen_indices(results));
    rates.push_back(collect(groups[k].largest(), [](const Result& r) { return double(r.rays) / r.wall_s; }));
    pis[k] = indices(groups[k].largest());
  }
  const auto repeats = size_t(m.repeats);
  const auto time_noise = noise_ratio(times, repeats), tile_noise = noise_ratio(tile_times, repeats),
             relative_noise = noise_ratio(relative_times, repeats), index_noise = noise_ratio(pis, repeats),
             rate_noise = noise_ratio(rates, repeats), seen_noise = noise_ratio(seen_times, repeats),
             seen_index_noise = noise_ratio(seen_pis, repeats);
  const SceneEntry& scene = m.scenes[s];
  Json j{{"name", scene.name},
         {"file", scene.file.string()},
         {"size", fmt::format("{}x{}", scene.width, scene.height)},
         {"reference_noise", reference_noise}};
  const auto add_noise = [&](const char* name, const std::optional<double>& x) {
    if (x) j["noise"][name] = *x;
  };
  add_noise("time", time_noise), add_noise("tiles_time", tile_noise);
  add_noise("relmse_time", relative_noise);
  add_noise("seen_time", seen_noise), add_noise("seen_index", seen_index_noise);
  add_noise("index", index_noise), add_noise("rate", rate_noise);
  const std::vector<double> fixed = fixed_times(curves);
  double best = 0;
  for (const auto& values : pis) best = std::max(best, spread(values).median);
  for (size_t k = 0; k < n; ++k) {
    if (groups[k].largest().empty()) continue;
    Json e{{"name", m.settings[k].name}, {"tracer", groups[k].largest()[0]->tracer}};
    e["cells"] = cells_json(m, s, k, groups[k]);
    e["time_to"] = times_json(curves[k], curves[0], k == 0, time_noise, rms);
    e["tiles_time_to"] = times_json(tiles[k], tiles[0], k == 0, tile_noise, rms);
    e["relmse_time_to"] = times_json(relative[k], relative[0], k == 0, relative_noise, squared);
    e["seen_time_to"] = times_json(seen[k], seen[0], k == 0, seen_noise, rms);
    if (k > 0)
      add_seen_ratios(e["cells"], "seen_ratio", groups[k].budgets, groups[0].budgets, seen_index_noise);
    if (const auto beside = find_setting(m, m.settings[k].beside)) {
      add_seen_ratios(e["cells"], "seen_beside", groups[k].budgets, groups[*beside].budgets,
                      seen_index_noise);
      e["seen_time_to_beside"] = times_json(seen[k], seen[*beside], false, seen_noise, rms);
    }
    const std::vector<double> seen_pi = seen_indices(groups[k].largest());
    if (!seen_pi.empty()) e["seen_index"] = {{"pi", to_json(spread(seen_pi))}};
    add_relmse_end(e, groups[k].largest(), relative[k], relative[0], k == 0, relative_noise);
    if (k > 0) {
      if (auto common = common_json(curves[k], curves[0], time_noise, rms)) e["time_common"] = *common;
      if (auto common = common_json(tiles[k], tiles[0], tile_noise, rms)) e["tiles_time_common"] = *common;
      if (auto common = common_json(seen[k], seen[0], seen_noise, rms)) e["seen_time_common"] = *common;
      if (auto common = common_json(relative[k], relative[0], relative_noise, squared))
        e["relmse_time_common"] = *common;
    }
    for (const double t : fixed) {
      std::vector<double> errors;
      for (const Curve& c : curves[k])
        if (const auto error = error_at(c, t)) errors.push_back(*error);
      if (!errors.empty()) e["error_at"].push_back({{"seconds", t}, {"error", to_json(spread(errors))}});
    }
    if (!pis[k].empty()) {
      const Spread pi = spread(pis[k]);
      e["index"] = {{"pi", to_json(pi)}, {"relative", 100 * pi.median / best}};
      relative_indices[k] = 100 * pi.median / best;
      if (k > 0 && !pis[0].empty()) add_ratio(e["index"], pi.median / spread(pis[0]).median, index_noise);
    }
    e["rays_per_s"] = to_json(spread(rates[k]));
    if (k > 0 && !rates[0].empty()) {
      e["rate"] = Json::object();
      add_ratio(e["rate"], spread(rates[k]).median / spread(rates[0]).median, rate_noise);
    }
    if (auto forecast = forecast_json(groups[k].largest())) e["forecast"] = std::move(*forecast);
    e["curve"] = curve_json(curves[k]);
    e["tiles_curve"] = curve_json(tiles[k]);
    e["seen_curve"] = curve_json(seen[k]);
    j["settings"].push_back(std::move(e));
  }
  return j;
}

/// Geometric means over the scenes of the cells' `key`, by setting and budget; with an interval if the ratios
/// of all scenes have one.
void summarize_seen(Json& report, const char* key) {
  struct Mean {
    std::string setting, budget;
    double sum = 0, squares = 0, scenes = 0;
    bool known = true;
  };
  std::vector<Mean> means;
  for (const Json& scene : report.at("scenes"))
    for (const Json& s : scene.at("settings"))
      for (const Json& cell : s.at("cells")) {
        if (!cell.contains(key)) continue;
        const std::string setting = s.at("name").get<std::string>(),
                          budget = cell.at("budget").get<std::string>();
        auto at = std::find_if(means.begin(), means.end(),
                               [&](const Mean& m) { return m.setting == setting && m.budget == budget; });
        if (at == means.end()) at = means.insert(means.end(), Mean{setting, budget});
        const Json& ratio = cell.at(key);
        at->sum += std::log(ratio.at("ratio").get<double>()), ++at->scenes;
        at->known = at->known && ratio.contains("high");
        if (!at->known) continue;
        const double width = std::log(ratio.at("high").get<double>() / ratio.at("ratio").get<double>());
        at->squares += width * width;
      }
  for (const Mean& m : means) {
    Json entry{{"setting", m.setting}, {"budget", m.budget}, {"scenes", m.scenes}};
    add_ratio(entry, std::exp(m.sum / m.scenes),
              m.known ? std::optional(std::exp(std::sqrt(m.squares) / m.scenes)) : std::nullopt);
    report[std::string(key) + "s"].push_back(std::move(entry));
  }
}

}  // namespace

Json make_report(const Matrix& m, const RunSummary& summary, const Json& about) {
  Json report{{"what", "lucerna bench"}, {"format", 1}};
  report.update(about);
  report["complete"] = summary.complete;
  const std::vector<Cell> cells = m.cells();
  report["cells"] = {{"done", summary.results.size()}, {"total", cells.size()}};
  report["matrix"] = bench::to_json(m);
  report["references"] = Json::array();
  for (size_t s = 0; s < m.scenes.size() && s < summary.references.size(); ++s) {
    const ReferenceInfo& r = summary.references[s];
    if (r.key.empty()) continue;
    Json noise;
    for (size_t k = 0; k < r.noise.size(); ++k) noise[stats::k_layer_names[k]] = r.noise[k];
    report["references"].push_back({{"scene", m.scenes[s].name},
                                    {"file", r.file.string()},
                                    {"samples", r.samples},
                                    {"seed", r.seed},
                                    {"seconds", r.seconds},
                                    {"noise", noise},
                                    {"relmse_noise", r.relmse_noise},
                                    {"seen_noise", r.seen_noise},
                                    {"key", r.key}});
  }
  report["scenes"] = Json::array();
  std::vector<std::vector<std::optional<double>>> relative;
  for (size_t s = 0; s < m.scenes.size(); ++s) {
    std::vector<Group> groups(m.settings.size());
    bool any = false;
    for (size_t k = 0; k < groups.size(); ++k) groups[k].budgets.resize(m.budgets(s, k).size());
    for (const Cell& c : cells) {
      const auto at = summary.results.find(m.id(c));
      if (c.scene != s || at == summary.results.end()) continue;
      groups[c.setting].budgets[c.budget].push_back(&at->second);
      any = true;
    }
    if (!any) continue;
    for (size_t k = 0; k < groups.size(); ++k)
      if (!m.settings[k].program.empty()) groups[k].joined = join_budgets(groups[k]);
    relative.emplace_back(groups.size());
    const double noise = s < summary.references.size() ? summary.references[s].noise[0] : 0;
    report["scenes"].push_back(scene_json(m, s, groups, noise, relative.back()));
  }
  report["index"] = Json::array();
  for (size_t k = 0; k < m.settings.size(); ++k) {
    double sum = 0, count = 0;
    for (const auto& scene : relative)
      if (scene[k]) sum += *scene[k], ++count;
    if (count > 0)
      report["index"].push_back({{"setting", m.settings[k].name}, {"value", sum / count}, {"scenes", count}});
  }
  for (const char* key : {"seen_ratio", "seen_beside"}) summarize_seen(report, key);
  report["results"] = Json::array();
  for (const Cell& c : cells)
    if (const auto at = summary.results.find(m.id(c)); at != summary.results.end())
      report["results"].push_back(bench::to_json(at->second));
  return report;
}

}  // namespace lucerna::bench
