#include "bench/latency.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/color.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/timer.h"
#include "bench/reference.h"
#include "film/io/image_file.h"
#include "plan/settings.h"
#include "session/renderer.h"
#include "session/session.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using scene::Scene;

constexpr double k_black_share = 1e-3;
/// Maximum number of stored pictures of an edit per second.
constexpr double k_moments_s = 1.0 / 60;

struct Shown {
  double seconds;
  std::shared_ptr<const session::Snapshot> snapshot;
};

/// A reference picture in shown luminance, and half of the difference of its halves.
struct Reference {
  std::vector<float> mean, half_difference;
};

Reference developed(const film::ReferencePair& halves, float exposure) {
  Reference r;
  for (size_t i = 0; i < halves.first.size(); ++i) {
    vec3 mean(0), half(0);
    for (int k = 0; k < 3; ++k) {
      const float a = exposure * halves.first[i][k], b = exposure * halves.second[i][k];
      // A pixel above white in only one half is noise: clipping it would bias the mean.
      const bool white = a > 1 && b > 1;
      mean[k] = white ? 1 : 0.5f * (a + b);
      half[k] = white ? 0 : 0.5f * (a - b);
    }
    r.mean.push_back(luminance(mean));
    r.half_difference.push_back(luminance(half));
  }
  return r;
}

class Latency {
 public:
  Latency(const LatencyOptions& options, const Message& message,
          const std::function<void(const LatencyResult&)>& done, const std::function<bool()>& interrupted)
      : o_(options), message_(message), done_(done), interrupted_(interrupted) {}

  std::vector<LatencyResult> run() {
    // A session would only report a refused setting.
    plan::Settings checked;
    for (const auto& [key, value] : o_.set) checked.set(key, value, "--set");
    for (const fs::path& folder : {o_.references, o_.pictures}) {
      std::error_code error;
      if (!folder.empty()) fs::create_directories(folder, error);
      if (error) throw_error(folder.string(), "the folder cannot be made: {}", error.message());
    }
    for (const fs::path& file : o_.files)
      for (const std::string& solver : o_.solvers)
        for (uint32_t i = 0; i < o_.repeats; ++i) run_scene(file, solver);
    return std::move(results_);
  }

 private:
  void check() const {
    if (interrupted_ && interrupted_()) throw Error("bench", "interrupted");
  }

  /// Every picture published until `seconds` after the clock's start.
  std::vector<Shown> watch(session::Session& s, const Timer& clock, double seconds) const {
    std::vector<Shown> all{{0, s.snapshot()}};
    while (clock.seconds() < seconds) {
      check();
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
      const auto now = s.snapshot();
      if (!now || (all.back().snapshot && now->id == all.back().snapshot->id)) continue;
      if (clock.seconds() - all.back().seconds < k_moments_s) continue;
      all.push_back({clock.seconds(), now});
    }
    return all;
  }

  /// Until the picture has LatencyOptions::settle.samples, after all preparation.
  void settle(session::Session& s) const {
    const uint64_t posted = s.commands();
    const Timer timer;
    while (timer.seconds() < o_.settle.seconds) {
      check();
      const auto now = s.snapshot();
      if (now && now->commands >= posted && now->activity.empty() && now->preparing.empty() &&
          (now->samples >= o_.settle.samples || now->finished))
        return;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  void choose(session::Session& s, const std::string& solver) const {
    for (const char* component : {"components.secondary", "components.tertiary"}) s.set(component, solver);
  }

  void run_scene(const fs::path& file, const std::string& solver) {
    const auto made = session::start_session({.device = o_.device,
                                              .validation = false,
                                              .shaders = {},
                                              .scenes = o_.scenes,
                                              .patience = session::k_patience});
    session::Session& s = *made;
    s.set_size(o_.width, o_.height);
    changes_.clear(), back_.reset(), done_edits_.clear();
    const Timer clock;
    s.load(file);
    choose(s, solver);
    for (const auto& [key, value] : o_.set) s.set(key, value);
    s.set("film.tone_curve", "linear");
    const bool wanted = std::find(o_.edits.begin(), o_.edits.end(), Edit::load) != o_.edits.end();
    for (;;) {
      check();
      const auto now = s.snapshot();
      if (now && now->commands >= s.commands()) {
        if (!s.scene()) throw Error(file.string(), "it was not loaded");
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const double loading = clock.seconds();
    if (wanted) report(file, solver, Edit::load, watch(s, clock, loading + o_.seconds), s, loading);
    for (const Edit edit : o_.edits) {
      if (edit == Edit::load) continue;
      if (edit == Edit::solver) choose(s, solver == "path" ? "cache" : "path");
      settle(s);
      if (edit == Edit::orbit) {
        orbit(file, solver, s);
        continue;
      }
      const scene::Camera camera = s.snapshot()->camera;
      std::optional<Change> change;
      std::string done = done_edits_ + std::string("-") + k_edit_names[size_t(edit)];
      const bool back = edit == Edit::undo && back_.has_value();
      if (edit == Edit::undo) {
        // Changes of camera or solver in between remain.
        if (back) change = back_->change, done = back_->edits;
        back_.reset();
      } else {
        change = change_of(edit, *s.scene(), camera, o_.seed);
      }
      if (!change) {
        message_(fmt::format("{}: it has nothing for the edit '{}'", file.stem().string(),
                             k_edit_names[size_t(edit)]));
        continue;
      }
      const Timer since;
      if (edit == Edit::solver) {
        choose(s, solver);
      } else {
        if (edit == Edit::camera)
          back_.reset();
        else if (!back)
          back_ = {reverse_of(*change, *s.scene(), camera), done_edits_};
        change->apply(s);
        changes_.push_back(*change);
        done_edits_ = done;
      }
      report(file, solver, edit, watch(s, since, o_.seconds), s, 0);
    }
  }

  void orbit(const fs::path& file, const std::string& solver, session::Session& s) {
    LatencyResult result;
    result.scene = file.stem().string(), result.solver = solver;
    result.edit = k_edit_names[size_t(Edit::orbit)];
    result.orbit = measure_orbit(s, o_.seconds, [this] { check(); });
    results_.push_back(result);
    done_(result);
  }

  void report(const fs::path& file, const std::string& solver, Edit edit, const std::vector<Shown>& shown,
              session::Session& s, double loading) {
    s.set_paused(true);
    const Reference& reference = reference_of(file, float(std::exp2(s.settings().real("film.ev"))));
    std::vector<Moment> moments;
    for (const Shown& at : shown) {
      // Pictures shown during loading count from the start.
      Moment m{std::max(0.0, at.seconds - loading), {1, 1, 1, 1}, {}};
      if (at.snapshot && at.snapshot->rgba.size() == reference.mean.size() * 4)
        m.distance = picture_distance(shown_luminance(at.snapshot->rgba), reference.mean, o_.width,
                                      reference.half_difference),
        m.reported = at.snapshot->shown_error;
      moments.push_back(m);
    }
    LatencyResult result = latency_of(moments, o_.seconds);
    result.scene = file.stem().string(), result.solver = solver, result.edit = k_edit_names[size_t(edit)];
    result.loading_s = loading;
    if (!o_.pictures.empty()) {
      const std::string name = fmt::format("{}-{}-{}", result.scene, solver, result.edit);
      for (const double t : k_listed_s) {
        const auto next =
            std::find_if(shown.begin(), shown.end(), [&](const Shown& x) { return x.seconds > loading + t; });
        if (const auto& picture = std::prev(next)->snapshot;
            picture && !picture->rgba.empty() && o_.seconds >= t)
          film::write_png(o_.pictures / fmt::format("{}-{:04.1f}s.png", name, t), picture->width,
                          picture->height, picture->rgba);
      }
    }
    results_.push_back(result);
    done_(result);
    s.set_paused(false);
  }

  /// As shown.
  const Reference& reference_of(const fs::path& file, float exposure) {
    const std::string key = fmt::format("{}{}", file.string(), done_edits_);
    const auto known = references_.find(key);
    if (known != references_.end()) return known->second;
    const film::FilmImage image = reference_image(file);
    return references_[key] = developed(read_halves(image, file.string()), exposure);
  }

  /// With both halves of its samples. Rendered unless stored by an earlier run.
  film::FilmImage reference_image(const fs::path& file) {
    const uint32_t samples = std::max(2u, o_.reference_samples);
    const std::string key =
        fmt::format("{} {} {}x{} {} {} {} {}", LUCERNA_VERSION, scene_hash(file), o_.width, o_.height,
                    done_edits_, o_.seed, samples, o_.reference_solver);
    const fs::path kept =
        o_.references / fmt::format("{}{}-{}-{}x{}-{}-{}.exr", file.stem().string(), done_edits_, o_.seed,
                                    o_.width, o_.height, o_.reference_solver, samples);
    if (file_exists(kept)) try {
        film::FilmImage image = film::read_exr(kept);
        if (const auto of = image.metadata.find("bench.key"); of != image.metadata.end() && of->second == key)
          return image;
      } catch (const Error& e) {
        message_(e.what());
      }
    message_(fmt::format("rendering the reference {}", kept.filename().string()));
    session::Renderer r(
        {.device = o_.device, .validation = false, .shaders = {}, .defines = {}, .scenes = o_.scenes});
    r.set_size(o_.width, o_.height);
    r.load(file, {},
           {{"components.secondary", o_.reference_solver, "bench"},
            {"components.tertiary", o_.reference_solver, "bench"},
            {"sampling.mode", "uniform", "bench"},
            {"samples", std::to_string(samples), "bench"},
            {"seed", "900001", "bench"}});
    for (const Change& change : changes_) change.apply(r);
    while (!r.done()) {
      check();
      r.step();
    }
    film::FilmImage image = r.output().film_image();
    add_odd_half(image, r.image());
    image.metadata["bench.key"] = key;
    film::write_exr(kept, image);
    return image;
  }

  const LatencyOptions& o_;
  const Message& message_;
  const std::function<void(const LatencyResult&)>& done_;
  const std::function<bool()>& interrupted_;
  std::vector<Change> changes_;  // made so far
  std::string done_edits_;       // names of the effective ones
  /// Undoes the last edit; afterwards these edits are effective.
  struct Back {
    Change change;
    std::string edits;
  };
  std::optional<Back> back_;
  std::map<std::string, Reference> references_;
  std::vector<LatencyResult> results_;
};

std::string text(const std::optional<double>& value, const char* unit, double factor = 1) {
  return value ? fmt::format("{:.{}f} {}", *value * factor, *unit == '%' ? 1 : 2, unit) : "-";
}

}  // namespace

bool usable(const PictureDistance& d) { return session::usable({d.tile_median, d.worst_tenth}); }

LatencyResult latency_of(std::span<const Moment> moments, double seconds) {
  LatencyResult r;
  r.moments.assign(moments.begin(), moments.end());
  double least = k_infinity;
  for (const Moment& m : moments) {
    if (m.distance.black > k_black_share)
      r.lit_s.reset();
    else if (!r.lit_s)
      r.lit_s = m.seconds;
    if (!usable(m.distance))
      r.usable_s.reset();
    else if (!r.usable_s)
      r.usable_s = m.seconds;
    r.rise = std::max(r.rise, m.distance.tile_median - std::min(least, m.distance.tile_median));
    least = std::min(least, m.distance.tile_median);
    for (size_t k = 0; k < k_listed_s.size(); ++k) {
      if (m.seconds > k_listed_s[k] || k_listed_s[k] > seconds + 0.5) continue;
      r.error[k] = m.distance.tile_median, r.worst[k] = m.distance.worst_tenth;
      r.reported[k].reset(), r.reported_worst[k].reset();
      if (m.reported) r.reported[k] = m.reported->median, r.reported_worst[k] = m.reported->worst_tenth;
    }
  }
  return r;
}

LatencyResult median_of(std::span<const LatencyResult> runs) {
  LatencyResult r = runs.front();
  if (runs.size() > 1) r.moments.clear();
  const auto middle = [&](const auto& of) {
    std::vector<double> all;
    for (const LatencyResult& run : runs) all.push_back(of(run).value_or(k_infinity));
    std::sort(all.begin(), all.end());
    const double value = all[all.size() / 2];
    return value < k_infinity ? std::optional(value) : std::nullopt;
  };
  const auto of = [](auto LatencyResult::*member) {
    return [member](const LatencyResult& run) { return std::optional<double>(run.*member); };
  };
  r.lit_s = middle(of(&LatencyResult::lit_s)), r.usable_s = middle(of(&LatencyResult::usable_s));
  r.rise = *middle(of(&LatencyResult::rise)), r.loading_s = *middle(of(&LatencyResult::loading_s));
  if (r.orbit)
    for (double Orbit::*figure : {&Orbit::frames_s, &Orbit::gap_s, &Orbit::behind_s})
      (*r.orbit).*figure =
          *middle([&](const LatencyResult& run) { return std::optional((*run.orbit).*figure); });
  for (const auto figures : {&LatencyResult::error, &LatencyResult::worst, &LatencyResult::reported,
                             &LatencyResult::reported_worst})
    for (size_t k = 0; k < r.error.size(); ++k)
      (r.*figures)[k] = middle([&](const LatencyResult& run) { return (run.*figures)[k]; });
  return r;
}

std::vector<LatencyResult> measure_latency(const LatencyOptions& options, const Message& message,
                                           const std::function<void(const LatencyResult&)>& done,
                                           const std::function<bool()>& interrupted) {
  return Latency(options, message, done, interrupted).run();
}

ReportedErrors reported_errors(std::span<const LatencyResult> results) {
  ReportedErrors all;
  std::vector<double> ratios;
  const auto right = [](double ratio) { return ratio >= k_right_low && ratio <= k_right_high; };
  for (const LatencyResult& r : results)
    for (size_t k = 0; k < k_listed_s.size(); ++k) {
      if (!r.error[k] || !r.worst[k] || !r.reported[k] || !r.reported_worst[k]) continue;
      if (session::usable({*r.reported[k], *r.reported_worst[k]})) {
        ++all.said_usable;
        all.not_usable += !session::usable({*r.error[k] / 1.1, *r.worst[k] / 1.1});
      }
      if (*r.error[k] < k_least_true) continue;
      ++all.known;
      ratios.push_back(*r.error[k] / std::max(*r.reported[k], 1e-6));
      all.median_right += right(ratios.back());
      all.worst_right += right(*r.worst[k] / std::max(*r.reported_worst[k], 1e-6));
    }
  std::sort(ratios.begin(), ratios.end());
  if (!ratios.empty())
    for (size_t i = 0; i < 3; ++i)
      all.ratio[i] = ratios[std::min(ratios.size() - 1, ratios.size() * (1 + 4 * i) / 10)];
  return all;
}

std::string text_of(const ReportedErrors& e) {
  return fmt::format(
      "reported errors: of {} pictures the median tile's true error is within {:g} to {:g} of the reported "
      "one "
      "in {}, the worst tenth's in {}; true over reported {:.2f} (deciles {:.2f}, {:.2f}); of {} pictures "
      "reported as usable {} are not",
      e.known, k_right_low, k_right_high, e.median_right, e.worst_right, e.ratio[1], e.ratio[0], e.ratio[2],
      e.said_usable, e.not_usable);
}

std::string latency_heading() {
  std::string row =
      fmt::format("{:<14} {:<8} {:<10} {:>8} {:>8}", "scene", "solver", "edit", "lit", "usable");
  for (const double t : k_listed_s) row += fmt::format(" {:>23}", fmt::format("at {:g} s", t));
  return row + fmt::format(" {:>9}", "set back");
}

std::string latency_row(const LatencyResult& r) {
  if (r.orbit)
    return fmt::format(
        "{:<14} {:<8} {:<10} {:.1f} pictures per second, 95 % within {:.2f} s, {:.2f} s behind", r.scene,
        r.solver, r.edit, r.orbit->frames_s, r.orbit->gap_s, r.orbit->behind_s);
  std::string row = fmt::format("{:<14} {:<8} {:<10} {:>8} {:>8}", r.scene, r.solver, r.edit,
                                text(r.lit_s, "s"), text(r.usable_s, "s"));
  const auto pair = [](const std::optional<double>& median, const std::optional<double>& worst) {
    return median && worst ? fmt::format("{:.3g}|{:.3g}", 100 * *median, 100 * *worst) : std::string("-");
  };
  for (size_t k = 0; k < k_listed_s.size(); ++k) {
    std::string cell = pair(r.error[k], r.worst[k]);
    if (r.reported[k]) cell += " (" + pair(r.reported[k], r.reported_worst[k]) + ")";
    row += fmt::format(" {:>23}", cell);
  }
  row += fmt::format(" {:>9}", text(r.rise, "%", 100));
  if (r.loading_s > 0) row += fmt::format("  (loading {:.2f} s)", r.loading_s);
  return row;
}

nlohmann::ordered_json to_json(const LatencyResult& r) {
  nlohmann::ordered_json j{{"scene", r.scene}, {"solver", r.solver}, {"edit", r.edit}};
  if (r.orbit) {
    j["frames_s"] = r.orbit->frames_s, j["gap_s"] = r.orbit->gap_s, j["behind_s"] = r.orbit->behind_s;
    return j;
  }
  const auto or_null = [](const std::optional<double>& x) {
    return x ? nlohmann::ordered_json(*x) : nlohmann::ordered_json();
  };
  j["lit_s"] = or_null(r.lit_s);
  j["usable_s"] = or_null(r.usable_s);
  for (size_t k = 0; k < k_listed_s.size(); ++k) {
    const std::string at = fmt::format("{:g}", k_listed_s[k]);
    j["error"][at] = or_null(r.error[k]), j["worst"][at] = or_null(r.worst[k]);
    j["reported"][at] = or_null(r.reported[k]), j["reported_worst"][at] = or_null(r.reported_worst[k]);
  }
  j["set_back"] = r.rise;
  j["loading_s"] = r.loading_s;
  for (const Moment& m : r.moments) {
    nlohmann::ordered_json moment{{"s", m.seconds},
                                  {"error", m.distance.tile_median},
                                  {"worst", m.distance.worst_tenth},
                                  {"mean", m.distance.error}};
    if (m.reported)
      moment["reported"] = m.reported->median, moment["reported_worst"] = m.reported->worst_tenth;
    j["moments"].push_back(std::move(moment));
  }
  return j;
}

}  // namespace lucerna::bench
