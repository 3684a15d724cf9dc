#include "bench/latency.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <glm/gtc/matrix_transform.hpp>
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
#include "film/tonemap.h"
#include "plan/settings.h"
#include "session/renderer.h"
#include "session/session.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using scene::Scene;

constexpr double k_black_share = 1e-3;
/// Pictures of one edit that are kept to be looked at: no more than this a second.
constexpr double k_moments_s = 1.0 / 60;

/// What is changed, as Session and Renderer take it.
struct Change {
  std::optional<scene::Camera> camera;
  std::optional<std::pair<uint32_t, scene::Light>> light;
  std::optional<std::pair<float, float>> environment;
  std::optional<std::pair<uint32_t, scene::Material>> material;

  template <class Target>
  void apply(Target& to) const {
    if (camera) to.set_camera(*camera);
    if (light) to.set_light(light->first, light->second);
    if (environment) to.set_environment(environment->first, environment->second);
    if (material) to.set_material(material->first, material->second);
  }
};

std::optional<uint32_t> brightest_lamp(const Scene& s) {
  std::optional<uint32_t> best;
  for (uint32_t i = 0; i < s.lights.size(); ++i)
    if (s.lights[i].enabled &&
        (!best || luminance(s.lights[i].intensity) > luminance(s.lights[*best].intensity)))
      best = i;
  return best;
}

/// Of the materials that weigh more than 0, each times its surface, the one that weighs most.
template <class Weight>
std::optional<uint32_t> heaviest_material(const Scene& s, const Weight& weight) {
  std::vector<double> area(s.materials.size(), 0);
  for (const scene::Instance& i : s.instances)
    for (const scene::Primitive& p : s.meshes[i.mesh].primitives)
      for (const uvec3& t : p.triangles) {
        vec3 v[3];
        for (int k = 0; k < 3; ++k) v[k] = vec3(i.to_world * vec4(p.positions[t[k]], 1));
        area[p.material] += 0.5 * length(cross(v[1] - v[0], v[2] - v[0]));
      }
  std::optional<uint32_t> best;
  double most = 0;
  for (uint32_t m = 0; m < area.size(); ++m)
    if (const double w = area[m] * weight(s.materials[m]); w > most) best = m, most = w;
  return best;
}

/// Of opaque diffuse materials without textures, the one with the largest surface.
std::optional<uint32_t> largest_plain_material(const Scene& s) {
  return heaviest_material(s, [](const scene::Material& x) {
    const bool plain = !x.base_color_texture && x.metallic < 1 && x.transmission == 0 && !x.unlit &&
                       luminance(vec3(x.base_color)) > 0 && luminance(x.emission) == 0;
    return plain ? 1.0 : 0.0;
  });
}

/// The one that sends most light.
std::optional<uint32_t> brightest_emitter(const Scene& s) {
  return heaviest_material(
      s, [](const scene::Material& x) { return x.unlit ? 0.0 : double(luminance(x.emission)); });
}

/// The change that an edit makes of a scene; nothing where it has none to be made.
std::optional<Change> change_of(Edit edit, const Scene& s, const scene::Camera& camera) {
  const Box box = scene::bounds(s);
  const float radius = 0.5f * length(box.hi - box.lo);
  Change c;
  if (edit == Edit::camera) {
    c.camera = camera;
    c.camera->to_world = glm::translate(mat4(1), 0.02f * radius * vec3(camera.to_world[0])) *
                         camera.to_world * glm::rotate(mat4(1), glm::radians(12.0f), vec3(0, 1, 0));
  } else if (edit == Edit::strength || edit == Edit::move) {
    const std::optional<uint32_t> lamp = brightest_lamp(s);
    if (!lamp) {
      const std::optional<uint32_t> emitter = brightest_emitter(s);
      if (!emitter || edit == Edit::move) return std::nullopt;
      scene::Material dimmed = s.materials[*emitter];
      dimmed.emission *= 1 / 3.0f;
      c.material = {*emitter, dimmed};
      return c;
    }
    scene::Light light = s.lights[*lamp];
    if (edit == Edit::strength)
      light.intensity *= 1 / 3.0f;
    else if (light.kind == scene::LightKind::directional)
      light.direction =
          vec3(glm::rotate(mat4(1), glm::radians(25.0f), vec3(0, 1, 0)) * vec4(light.direction, 0));
    else
      light.position += 0.1f * radius * vec3(camera.to_world[0]);
    c.light = {*lamp, light};
  } else if (edit == Edit::sky) {
    if (s.environment.image == scene::k_none) return std::nullopt;
    c.environment = {s.environment.scale, s.environment.rotation + 90};
  } else if (edit == Edit::material) {
    const std::optional<uint32_t> index = largest_plain_material(s);
    if (!index) return std::nullopt;
    scene::Material red = s.materials[*index];
    red.base_color = vec4(0.7f, 0.15f, 0.1f, red.base_color.w);
    c.material = {*index, red};
  }
  return c;
}

struct Shown {
  double seconds;
  std::shared_ptr<const session::Snapshot> snapshot;
};

/// A reference picture in the luminance that is shown, and half of what the halves of its samples differ by.
struct Reference {
  std::vector<float> mean, half_difference;
};

Reference developed(const film::ReferencePair& halves, float exposure) {
  Reference r;
  for (size_t i = 0; i < halves.first.size(); ++i) {
    vec3 mean(0), half(0);
    for (int k = 0; k < 3; ++k) {
      const float a = exposure * halves.first[i][k], b = exposure * halves.second[i][k];
      // Where one half alone is brighter than white it is noise: cut off it would be missing in the mean.
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
    // A session would report a refused one and go on without it.
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

  /// Every picture that is published until `seconds` after the clock's start.
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

  /// Until the picture has LatencyOptions::settle.samples, with all that is prepared before.
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
    session::Session s({.device = o_.device, .validation = false, .shaders = {}, .scenes = o_.scenes});
    s.set_size(o_.width, o_.height);
    changes_.clear(), done_edits_.clear();
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
      const std::optional<Change> change = change_of(edit, *s.scene(), s.snapshot()->camera);
      if (!change) {
        message_(fmt::format("{}: it has nothing for the edit '{}'", file.stem().string(),
                             k_edit_names[size_t(edit)]));
        continue;
      }
      const Timer since;
      if (edit == Edit::solver) {
        choose(s, solver);
      } else {
        change->apply(s);
        changes_.push_back(*change);
        done_edits_ += std::string("-") + k_edit_names[size_t(edit)];
      }
      report(file, solver, edit, watch(s, since, o_.seconds), s, 0);
    }
  }

  void report(const fs::path& file, const std::string& solver, Edit edit, const std::vector<Shown>& shown,
              session::Session& s, double loading) {
    s.set_paused(true);
    const Reference& reference = reference_of(file, float(std::exp2(s.settings().real("film.ev"))));
    std::vector<Moment> moments;
    for (const Shown& at : shown) {
      // What is shown while a scene is loaded is what it begins with.
      Moment m{std::max(0.0, at.seconds - loading), {1, 1}, {}};
      if (at.snapshot && at.snapshot->rgba.size() == reference.mean.size() * 4)
        m.distance = picture_distance(shown_luminance(at.snapshot->rgba), reference.mean, o_.width,
                                      reference.half_difference),
        m.estimated = at.snapshot->shown_error;
      moments.push_back(m);
    }
    LatencyResult result = latency_of(moments, o_.seconds);
    result.scene = file.stem().string(), result.solver = solver, result.edit = k_edit_names[size_t(edit)];
    result.loading_s = loading;
    if (!o_.pictures.empty()) {
      const std::string name = fmt::format("{}-{}-{}", result.scene, solver, result.edit);
      for (const double t : k_reported_s) {
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

  /// As it is shown.
  const Reference& reference_of(const fs::path& file, float exposure) {
    const std::string key = fmt::format("{}{}", file.string(), done_edits_);
    const auto known = references_.find(key);
    if (known != references_.end()) return known->second;
    const film::FilmImage image = reference_image(file);
    return references_[key] = developed(read_halves(image, file.string()), exposure);
  }

  /// With both halves of its samples. Rendered where no earlier run has left it.
  film::FilmImage reference_image(const fs::path& file) {
    const uint32_t samples = std::max(2u, o_.reference_samples);
    const std::string key = fmt::format("{} {} {}x{} {} {} {}", LUCERNA_VERSION, scene_hash(file), o_.width,
                                        o_.height, done_edits_, samples, o_.reference_solver);
    const fs::path kept =
        o_.references / fmt::format("{}{}-{}x{}-{}-{}.exr", file.stem().string(), done_edits_, o_.width,
                                    o_.height, o_.reference_solver, samples);
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
    film::FilmImage image = r.film_image();
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
  std::string done_edits_;       // their names
  std::map<std::string, Reference> references_;
  std::vector<LatencyResult> results_;
};

std::vector<float> mean_3x3(std::span<const float> of, uint32_t width) {
  const auto height = uint32_t(of.size() / width);
  std::vector<float> all(of.size());
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      float sum = 0, n = 0;
      for (uint32_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, height - 1); ++v)
        for (uint32_t u = x > 0 ? x - 1 : 0; u <= std::min(x + 1, width - 1); ++u)
          sum += of[size_t{v} * width + u], n += 1;
      all[size_t{y} * width + x] = sum / n;
    }
  return all;
}

std::string text(const std::optional<double>& value, const char* unit, double factor = 1) {
  return value ? fmt::format("{:.{}f} {}", *value * factor, *unit == '%' ? 1 : 2, unit) : "-";
}

}  // namespace

Edit edit_of(const std::string& name) {
  const auto at = std::find(k_edit_names.begin(), k_edit_names.end(), name);
  if (at == k_edit_names.end())
    throw_error("bench latency", "there is no edit '{}'; there are {}", name, fmt::join(k_edit_names, ", "));
  return Edit(at - k_edit_names.begin());
}

PictureDistance picture_distance(std::span<const float> shown, std::span<const float> reference,
                                 uint32_t width, std::span<const float> half_difference) {
  constexpr size_t k_tile = 16;
  struct Tile {
    double error = 0, square = 0, noise = 0;
  };
  const std::vector<float> a = mean_3x3(shown, width), b = mean_3x3(reference, width),
                           half = mean_3x3(half_difference, width);
  PictureDistance d;
  size_t lit = 0, black = 0;
  const size_t across = (width + k_tile - 1) / k_tile;
  std::vector<Tile> tiles(across * ((a.size() / width + k_tile - 1) / k_tile));
  for (size_t i = 0; i < a.size(); ++i) {
    const double off = std::abs(a[i] - b[i]) / std::max(b[i], k_dark),
                 noise = half.empty() ? 0.0 : double(half[i] / std::max(b[i], k_dark));
    Tile& t = tiles[i / width / k_tile * across + i % width / k_tile];
    t.error += off, t.square += off * off, t.noise += noise * noise;
    if (b[i] < k_dark) continue;
    ++lit;
    black += a[i] < 0.05f * b[i];
  }
  // What is left of a right picture is as often below 0 as above, and sums to nothing.
  for (const Tile& t : tiles) {
    if (t.square <= 0) continue;
    const double left = 1 - t.noise / t.square;
    d.error += t.error * std::copysign(std::sqrt(std::abs(left)), left);
  }
  d.error = std::max(0.0, d.error) / double(std::max<size_t>(1, a.size()));
  d.black = double(black) / double(std::max<size_t>(1, lit));
  return d;
}

std::vector<float> shown_luminance(std::span<const uint8_t> rgba) {
  std::array<float, 256> linear;
  for (size_t i = 0; i < 256; ++i) {
    linear[i] = linear_from_srgb(float(i) / 255);
  }
  std::vector<float> all(rgba.size() / 4);
  for (size_t i = 0; i < all.size(); ++i)
    all[i] = luminance(vec3(linear[rgba[4 * i]], linear[rgba[4 * i + 1]], linear[rgba[4 * i + 2]]));
  return all;
}

LatencyResult latency_of(std::span<const Moment> moments, double seconds) {
  LatencyResult r;
  r.moments.assign(moments.begin(), moments.end());
  double least = k_infinity;
  for (const Moment& m : moments) {
    if (m.distance.black > k_black_share)
      r.lit_s.reset();
    else if (!r.lit_s)
      r.lit_s = m.seconds;
    if (m.distance.error >= k_usable)
      r.usable_s.reset();
    else if (!r.usable_s)
      r.usable_s = m.seconds;
    r.rise = std::max(r.rise, m.distance.error - std::min(least, m.distance.error));
    least = std::min(least, m.distance.error);
    for (size_t k = 0; k < k_reported_s.size(); ++k)
      if (m.seconds <= k_reported_s[k] && k_reported_s[k] <= seconds + 0.5)
        r.error[k] = m.distance.error, r.estimated[k] = m.estimated;
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
  for (size_t k = 0; k < r.error.size(); ++k)
    r.error[k] = middle([k](const LatencyResult& run) { return run.error[k]; }),
    r.estimated[k] = middle([k](const LatencyResult& run) { return run.estimated[k]; });
  return r;
}

std::vector<LatencyResult> measure_latency(const LatencyOptions& options, const Message& message,
                                           const std::function<void(const LatencyResult&)>& done,
                                           const std::function<bool()>& interrupted) {
  return Latency(options, message, done, interrupted).run();
}

std::string latency_heading() {
  std::string row =
      fmt::format("{:<14} {:<8} {:<10} {:>8} {:>8}", "scene", "solver", "edit", "lit", "usable");
  for (const double t : k_reported_s) row += fmt::format(" {:>15}", fmt::format("at {:g} s", t));
  return row + fmt::format(" {:>9}", "set back");
}

std::string latency_row(const LatencyResult& r) {
  std::string row = fmt::format("{:<14} {:<8} {:<10} {:>8} {:>8}", r.scene, r.solver, r.edit,
                                text(r.lit_s, "s"), text(r.usable_s, "s"));
  for (size_t k = 0; k < k_reported_s.size(); ++k)
    row +=
        fmt::format(" {:>15}", text(r.error[k], "%", 100) +
                                   (r.estimated[k] ? fmt::format(" ({:.3g})", 100 * *r.estimated[k]) : ""));
  row += fmt::format(" {:>9}", text(r.rise, "%", 100));
  if (r.loading_s > 0) row += fmt::format("  (loading {:.2f} s)", r.loading_s);
  return row;
}

nlohmann::ordered_json to_json(const LatencyResult& r) {
  nlohmann::ordered_json j{{"scene", r.scene}, {"solver", r.solver}, {"edit", r.edit}};
  const auto or_null = [](const std::optional<double>& x) {
    return x ? nlohmann::ordered_json(*x) : nlohmann::ordered_json();
  };
  j["lit_s"] = or_null(r.lit_s);
  j["usable_s"] = or_null(r.usable_s);
  for (size_t k = 0; k < k_reported_s.size(); ++k)
    j["error"][fmt::format("{:g}", k_reported_s[k])] = or_null(r.error[k]),
                                   j["estimated"][fmt::format("{:g}", k_reported_s[k])] =
                                       or_null(r.estimated[k]);
  j["set_back"] = r.rise;
  j["loading_s"] = r.loading_s;
  for (const Moment& m : r.moments)
    j["moments"].push_back(
        {{"s", m.seconds}, {"error", m.distance.error}, {"estimated", or_null(m.estimated)}});
  return j;
}

}  // namespace lucerna::bench
