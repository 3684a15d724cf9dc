#include "bench/runner.h"

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "base/timer.h"
#include "bench/outside.h"
#include "bench/program.h"
#include "bench/time_left.h"
#include "session/renderer.h"
#include "stats/forecast.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using session::Renderer;

constexpr double k_progress_every_s = 0.2;
constexpr double k_most_waiting = 64;  ///< maximum run time of another program over its budget

/// Values of a setting override those of the scene, which override those for all.
SettingValues merged(const Matrix& matrix, const SceneEntry& scene, const SettingValues& own) {
  SettingValues values = own;
  values.insert(scene.set.begin(), scene.set.end());
  values.insert(matrix.set.begin(), matrix.set.end());
  return values;
}

/// A new renderer with the scene loaded and the settings applied. Warnings of a scene appear once per bench.
std::unique_ptr<Renderer> make_renderer(const SceneEntry& scene, const SettingValues& values,
                                        const RunOptions& options) {
  auto r = std::make_unique<Renderer>(session::RendererOptions{
      .device = options.device, .validation = false, .shaders = {}, .defines = {}, .scenes = options.scenes});
  r->set_size(scene.width, scene.height);
  for (const char* key : {"tracer", "path.batch"})
    if (const auto at = values.find(key); at != values.end()) r->settings().set(key, at->second);
  r->load(scene.file);
  for (const auto& [key, value] : values) r->settings().set(key, value, scene.name);
  r->apply_settings();
  if (!scene.camera.empty()) r->choose_camera(scene.camera);
  return r;
}

/// Done part of a render, 0..1, by the nearer of its ends.
double fraction_done(const Renderer& r, const Budget& budget, double seconds) {
  if (budget.kind == BudgetKind::seconds) return std::min(1.0, seconds / budget.value);
  if (const schedule::AdaptiveSchedule* s = r.sampling().adaptive())
    return double(s->count(schedule::TileState::done) + s->count(schedule::TileState::capped)) /
           double(s->sampled_tiles());
  const double pixels = double(r.film().width()) * r.film().height();
  return std::min(1.0, double(r.stats().paths) / pixels / r.sampling().max_samples());
}

std::vector<vec3> sum_of(const film::Image& image) {
  std::vector<vec3> sum(image.samples.size(), vec3(0));
  for (const auto& component : image.components)
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += component[i];
  return sum;
}

/// Difference of the present picture from the truth, by the measures that need both of its halves.
struct Distances {
  film::RelativeMse relative;
  film::SeenMse seen;
};

Distances distances(const Renderer& r, const film::ReferencePair& halves) {
  const std::vector<vec3> sum = sum_of(r.image());
  return {film::relative_mse(sum, halves), film::seen_mse(sum, halves)};
}

/// Estimated error of the sum, and of the components the noise of paths.
Layers estimated_errors(const stats::Entry& e) {
  Layers all = e.of_mean.error;
  all[0] = e.of_mean.sum();
  return all;
}

CurvePoint make_point(const stats::Entry& e, const Distances& distances) {
  return {.wall_s = e.render_s,
          .device_s = e.device_s,
          .rays = e.rays,
          .samples = e.samples,
          .estimated = estimated_errors(e),
          .truth = e.truth.value_or(Layers{}),
          .tiles = e.tile_worst_tenth,
          .relmse = std::max(0.0, distances.relative.trimmed),
          .seen = std::max(0.0, distances.seen.trimmed)};
}

/// Forecast at a tenth of the time; none if the ledger had no line by then.
std::optional<ForecastResult> make_forecast(const stats::Ledger& ledger, bool adaptive) {
  const auto& entries = ledger.entries();
  stats::Ledger early;
  for (stats::Entry e : entries) {
    // The clock counts only tracing, not comparisons with a reference.
    e.wall_s = e.render_s, e.prepared_s = std::min(e.prepared_s, e.render_s);
    if (e.render_s <= 0.1 * entries.back().render_s) early.add(e);
  }
  if (early.entries().empty()) return std::nullopt;
  const stats::Entry& at = early.entries().back();
  const double rays_per_s = double(at.rays) / at.wall_s;
  const auto scaled = [](const stats::Band& b, double k) {
    return stats::Band{b.low * k, b.middle * k, b.high * k};
  };
  ForecastResult f{.at_s = at.wall_s};
  if (adaptive) {
    if (!at.total_rays) return std::nullopt;
    f.rays = *at.total_rays;
    f.seconds = scaled(f.rays, 1 / rays_per_s);
  } else {
    // The records' part is the final one: only the noise of paths is predicted.
    const auto seconds = stats::seconds_to(early, entries.back().sum());
    if (!seconds) return std::nullopt;
    f.seconds = *seconds;
    f.rays = scaled(f.seconds, rays_per_s);
  }
  return f;
}

struct Interrupted {};

class Run {
 public:
  Run(const Matrix& matrix, const Folder& folder, const RunOptions& options, const Hooks& hooks)
      : matrix_(matrix), folder_(folder), options_(options), hooks_(hooks), left_(matrix) {}

  RunSummary run();

 private:
  ReferenceInfo make_reference(const SceneEntry& scene, const std::string& key);
  Result render(const Cell& cell, const ReferenceInfo& reference, const std::string& scene_hash);
  /// Likewise, by the setting's own program.
  Result render_outside(const Cell& cell, const ReferenceInfo& reference, const std::string& scene_hash);
  bool leaves_pictures(const Cell& cell) const {
    return cell.repeat == 0 && cell.budget + 1 == matrix_.budgets(cell.scene, cell.setting).size();
  }
  void save_error_pictures(const std::vector<vec3>& sum, const Cell& cell, const film::FilmImage& truth,
                           const std::string& where);
  /// Prepares solvers with long preparation, after all kernels have run, before the clock starts.
  bool warm(const Renderer& r, double seconds) const {
    return (r.preparing() && r.prepares_warm() && seconds > 20) || r.samples() >= matrix_.warmup;
  }
  /// Advances; throws Interrupted if the user wants to stop.
  bool step(Renderer& r) {
    if (hooks_.interrupted() || !r.step(hooks_.interrupted)) {
      if (hooks_.interrupted()) throw Interrupted{};
      return false;
    }
    return true;
  }
  void report_progress(double fraction, bool at_once = false) {
    if (!at_once && since_progress_.seconds() < k_progress_every_s) return;
    since_progress_.restart();
    status_.fraction = fraction;
    status_.left_s = left_.seconds(unit_, fraction, since_unit_.seconds());
    hooks_.progress(status_);
  }
  void begin(const TimeLeft::Unit& unit, const std::string& what) {
    unit_ = unit;
    since_unit_.restart();
    ++status_.step;
    status_.what = what;
    report_progress(0, true);
  }
  void end() { left_.finished(unit_, since_unit_.seconds()); }

  const Matrix& matrix_;
  const Folder& folder_;
  const RunOptions& options_;
  const Hooks& hooks_;
  TimeLeft left_;
  TimeLeft::Unit unit_;
  Status status_;
  Timer since_unit_, since_progress_;
};

ReferenceInfo Run::make_reference(const SceneEntry& scene, const std::string& key) {
  const Timer timer;
  SettingValues values = merged(matrix_, scene, {});
  // Plain path tracing, overriding the scene's settings; components that are off stay off.
  for (const OptionInfo& option : plan::options())
    if (option.key.starts_with("components.") && !values.contains(option.key))
      values[option.key] = option.fallback;
  values["sampling.mode"] = "uniform";
  values["seed"] = std::to_string(matrix_.reference_seed);
  values["samples"] = std::to_string(scene.reference_samples);
  const auto r = make_renderer(scene, values, options_);
  while (!r->done() && step(*r)) report_progress(fraction_done(*r, {}, 0));
  ReferenceInfo info{.file = reference_file(options_.references, scene),
                     .key = key,
                     .samples = scene.reference_samples,
                     .seed = matrix_.reference_seed,
                     .seconds = timer.seconds()};
  film::FilmImage image = r->output().film_image();
  describe_reference(image.metadata, info);
  add_odd_half(image, r->image());
  film::write_exr(info.file, image);
  find_noise(info, image, scene);
  return info;
}

Result Run::render(const Cell& cell, const ReferenceInfo& reference, const std::string& scene_hash) {
  const SceneEntry& scene = matrix_.scenes[cell.scene];
  const Setting& setting = matrix_.settings[cell.setting];
  const Budget budget = matrix_.budget(cell);
  SettingValues values = merged(matrix_, scene, setting.set);
  const uint32_t seed = matrix_.seed + uint32_t(cell.repeat);
  values["seed"] = std::to_string(seed);
  values["samples"] = std::to_string(budget.kind == BudgetKind::samples ? uint64_t(budget.value) : 1u << 20);
  // With a time budget, samples are unlimited.
  if (budget.kind == BudgetKind::seconds) values.emplace("sampling.max_samples", std::to_string(1u << 20));
  if (budget.kind == BudgetKind::errors) values["sampling.target_error"] = fmt::format("{}", budget.value);

  const Timer setup;
  const film::FilmImage truth = film::read_exr(reference.file);
  const film::ReferencePair halves = read_halves(truth, reference.file.string());
  const auto r = make_renderer(scene, values, options_);
  r->progress().set_reference(reference.file);
  // Warms up: the device compiles kernels on their first run, and clocks and caches settle.
  while (!warm(*r, setup.seconds()) && !r->done() && step(*r)) report_progress(0);
  r->image_error();
  Result result{.scene = scene.name,
                .setting = setting.name,
                .budget = budget.text(),
                .repeat = cell.repeat,
                .seed = seed,
                .scene_hash = scene_hash,
                .reference_hash = reference.key,
                .tracer = r->tracer_name(),
                .setup_s = setup.seconds()};
  r->restart();

  const auto out_of_time = [&] {
    return budget.kind == BudgetKind::seconds && r->progress().render_seconds() >= budget.value;
  };
  const auto& entries = r->progress().ledger().entries();
  // Waits for a picture delayed by preparation; its time is recorded.
  while (!r->done() && (!out_of_time() || entries.empty())) {
    const size_t lines = entries.size();
    if (!step(*r)) break;
    // Without a sample in every pixel it is not comparable.
    if (entries.size() > lines && entries.back().has_error)
      result.curve.push_back(make_point(entries.back(), distances(*r, halves)));
    report_progress(fraction_done(*r, budget, r->progress().render_seconds()));
  }
  r->finish_ledger();
  const stats::Entry& last = entries.back();
  if (!result.curve.empty() && result.curve.back().wall_s >= last.render_s) result.curve.pop_back();
  const auto [relative, seen] = distances(*r, halves);
  result.curve.push_back(make_point(last, {relative, seen}));

  result.wall_s = last.render_s, result.device_s = last.device_s;
  result.rays = last.rays, result.paths = last.paths, result.samples = last.samples;
  result.parts.paths = last.of_mean.error[0];
  result.parts.records = last.of_mean.records, result.parts.interpolation = last.of_mean.interpolation;
  result.estimated = estimated_errors(last), result.truth = last.truth.value_or(Layers{});
  result.component_s = last.component_s;
  const double rms = result.truth[0] * r->progress().reference()->mean_luminance;
  result.mse = rms * rms;
  // The reference's noise is uncertain by a tenth or two; remainders below that are not significant.
  result.in_reference_noise = result.truth[0] < 0.7 * reference.noise[0];
  result.relmse = std::max(0.0, relative.trimmed), result.relmse_all = std::max(0.0, relative.all);
  result.seen = std::max(0.0, seen.trimmed), result.seen_all = std::max(0.0, seen.all);
  const film::TileSpread tiles = film::tile_spread(r->progress().tile_errors());
  result.tiles.median = tiles.median, result.tiles.decile = tiles.worst_tenth;
  result.tiles.worst = tiles.worst, result.tiles.heavy = tiles.heavy_tailed;
  if (r->sampling().adaptive())
    result.tiles.over = r->sampling().adaptive()->count(schedule::TileState::capped);
  result.dropped = r->stats().dropped;
  result.records = uint32_t(r->solvers().figure("records")),
  result.record_rays = uint64_t(r->solvers().figure("rays"));
  result.forecast = make_forecast(r->progress().ledger(), r->sampling().adaptive() != nullptr);
  if (leaves_pictures(cell)) {
    film::write_png(picture_file(folder_, scene.name, setting.name), truth.width, truth.height,
                    r->output().picture(false));
    save_error_pictures(sum_of(r->image()), cell, truth, reference.file.string());
  }
  return result;
}

Result Run::render_outside(const Cell& cell, const ReferenceInfo& reference, const std::string& scene_hash) {
  const SceneEntry& scene = matrix_.scenes[cell.scene];
  const Setting& setting = matrix_.settings[cell.setting];
  const Budget budget = matrix_.budget(cell);
  OutsideFiles files{.picture = folder_.path() / "outside.exr", .stats = folder_.path() / "outside.json"};
  if (leaves_pictures(cell)) files.shown = picture_file(folder_, scene.name, setting.name);
  const auto forget = [&] {
    std::error_code ignored;
    fs::remove(files.picture, ignored), fs::remove(files.stats, ignored);
  };
  forget();
  // Waits for a late picture, as above.
  ProgramResult run;
  for (double times = 1; times <= k_most_waiting; times *= 2) {
    run = run_program(setting.program,
                      outside_arguments(matrix_, cell, merged(matrix_, scene, setting.set), options_.device,
                                        options_.scenes, files, times),
                      {.interrupted = hooks_.interrupted, .waiting = [&](double seconds) {
                         // its progress in samples is unknown
                         const bool timed = budget.kind == BudgetKind::seconds;
                         report_progress(timed ? std::min(1.0, seconds / (times * budget.value)) : 0);
                       }});
    if (run.interrupted) {
      forget();
      throw Interrupted{};
    }
    if (!out_of_time(run)) break;
  }
  if (run.status != 0) throw_error(setting.program, "ended with status {}: {}", run.status, run.last_line());
  const film::FilmImage truth = film::read_exr(reference.file);
  Result result = read_outside(files, scene, reference, truth);
  result.scene = scene.name, result.setting = setting.name, result.budget = budget.text();
  result.repeat = cell.repeat, result.seed = matrix_.seed + uint32_t(cell.repeat);
  result.scene_hash = scene_hash, result.reference_hash = reference.key;
  if (leaves_pictures(cell))
    save_error_pictures(colours(film::read_exr(files.picture), files.picture.string()), cell, truth,
                        reference.file.string());
  forget();
  return result;
}

void Run::save_error_pictures(const std::vector<vec3>& sum, const Cell& cell, const film::FilmImage& truth,
                              const std::string& where) {
  const std::string &scene = matrix_.scenes[cell.scene].name, &setting = matrix_.settings[cell.setting].name;
  const std::vector<vec3> right = colours(truth, where);
  double mean = 0;
  for (const vec3& colour : right) mean += double(luminance(colour)) / double(right.size());
  std::vector<float> error(right.size());
  for (size_t i = 0; i < error.size(); ++i)
    error[i] = float(std::abs(double(luminance(sum[i])) - double(luminance(right[i]))) / mean);
  const auto save = [&](const fs::path& file, std::vector<float> values) {
    film::FilmImage out{.width = truth.width, .height = truth.height};
    out.channels.emplace_back("error", std::move(values));
    film::write_exr(file, out);
  };
  save(error_file(folder_, scene, setting), std::move(error));
  save(seen_file(folder_, scene, setting), film::seen_difference(sum, read_halves(truth, where)));
}

RunSummary Run::run() {
  RunSummary summary;
  std::map<std::string, std::string> hashes;
  for (const SceneEntry& scene : matrix_.scenes) hashes[scene.name] = scene_hash(scene.file);
  summary.results = folder_.load(matrix_, hashes, hooks_.message);
  std::error_code code;
  fs::create_directories(options_.references, code);
  if (code) throw_error(options_.references.string(), "the folder cannot be made: {}", code.message());

  const std::vector<Cell> cells = matrix_.cells();
  std::vector<std::optional<ReferenceInfo>> references;
  for (const SceneEntry& scene : matrix_.scenes) {
    const std::string key = reference_key(matrix_, scene, hashes[scene.name]);
    references.push_back(find_reference(options_.references, scene, key, hooks_.message));
    if (!references.back()) left_.add({references.size() - 1, TimeLeft::k_reference, 0});
  }
  for (const Cell& c : cells) {
    const auto at = summary.results.find(matrix_.id(c));
    const SceneEntry& scene = matrix_.scenes[c.scene];
    const std::string key = reference_key(matrix_, scene, hashes[scene.name]);
    if (at != summary.results.end() && at->second.reference_hash != key) summary.results.erase(at);
    if (!summary.results.contains(matrix_.id(c))) left_.add({c.scene, c.setting, c.budget});
  }
  summary.kept = summary.results.size();
  status_.steps = left_.units();

  try {
    for (size_t s = 0; s < matrix_.scenes.size(); ++s) {
      const SceneEntry& scene = matrix_.scenes[s];
      if (!references[s]) {
        begin({s, TimeLeft::k_reference, 0},
              fmt::format("{}, reference of {} samples", scene.name, scene.reference_samples));
        references[s] = make_reference(scene, reference_key(matrix_, scene, hashes[scene.name]));
        end();
      }
      for (const Cell& c : cells) {
        const std::string id = matrix_.id(c);
        if (c.scene != s || summary.results.contains(id)) continue;
        begin({s, c.setting, c.budget},
              fmt::format("{}, {}, {}, repeat {} of {}", scene.name, matrix_.settings[c.setting].name,
                          matrix_.budget(c).text(), c.repeat + 1, matrix_.repeats));
        Result result = matrix_.settings[c.setting].program.empty()
                            ? render(c, *references[s], hashes[scene.name])
                            : render_outside(c, *references[s], hashes[scene.name]);
        folder_.save(id, result);
        summary.results.emplace(id, std::move(result));
        ++summary.measured;
        end();
      }
    }
    summary.complete = true;
  } catch (const Interrupted&) {
  } catch (const Error&) {
    // Loading and compiling end with an Error if cancelled.
    if (!hooks_.interrupted()) throw;
  }
  for (size_t s = 0; s < references.size(); ++s)
    summary.references.push_back(references[s].value_or(ReferenceInfo{}));
  return summary;
}

}  // namespace

RunSummary run_matrix(const Matrix& matrix, const Folder& folder, const RunOptions& options,
                      const Hooks& hooks) {
  return Run(matrix, folder, options, hooks).run();
}

fs::path picture_file(const Folder& folder, const std::string& scene, const std::string& setting) {
  return folder.pictures() / (scene + "." + setting + ".png");
}

fs::path seen_file(const Folder& folder, const std::string& scene, const std::string& setting) {
  return folder.pictures() / (scene + "." + setting + ".seen.exr");
}

fs::path error_file(const Folder& folder, const std::string& scene, const std::string& setting) {
  return folder.pictures() / (scene + "." + setting + ".exr");
}

}  // namespace lucerna::bench
