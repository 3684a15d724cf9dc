#include "bench/photons.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/color.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/timer.h"
#include "bench/photon_errors.h"
#include "bench/reference.h"
#include "film/io/image_file.h"
#include "session/renderer.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using session::Renderer;
using Values = std::vector<std::pair<std::string, std::string>>;

constexpr uint32_t k_reference_seed = 900001;
constexpr double k_progress_every_s = 0.1;
/// Minimum cosine between the mean normals of two pixels on one plane is 1 minus this.
constexpr float k_plane = 1e-5f;
constexpr uint32_t k_light_paths = 8192;  ///< light paths of a round for measured errors
constexpr uint32_t k_lamp_paths = 65536, k_lamp_side = 128, k_rounds_side = 128, k_free_side = 128,
                   k_free_samples = 12;

struct Interrupted {};

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  const size_t n = v.size();
  return n % 2 ? v[n / 2] : 0.5 * (v[n / 2 - 1] + v[n / 2]);
}

Values alone(const char* component) {
  Values v{{"photons.efficiency", "false"}};  // photons are measured even if they are less efficient
  for (const char* c : {"primary", "secondary", "tertiary", "caustic"})
    if (c != std::string(component)) v.emplace_back(std::string("components.") + c, "off");
  return v;
}

Values operator+(Values a, const Values& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Renders for error curves, over rounds or over radii.
struct Series {
  const char* name;
  const char* scene;
  const char* component;
  const char* reference;  ///< solver that computes the true component; "": only noise is measured
  double radius, floor, alpha;
  bool over_radius;  ///< one picture per radius, a multiple of `radius`; else one after 1, 2, 4 .. rounds
  /// First round for the slope: before, in regions of fine light most noise is from the positions of eye
  /// paths within their pixels, which is stratified over the samples and vanishes soon.
  uint32_t first;
};
/// Radii in units of the series' radius.
constexpr std::array<double, 4> k_radii = {1, 1.26, 1.5874, 2};
constexpr Series k_series[] = {
    {"caustic, floor off", "glass", "caustic", "light", 3, 0, 2.0 / 3, false, 32},
    {"caustic, floor on", "glass", "caustic", "", 1.5, 1.25, 2.0 / 3, false, 16},
    {"secondary, floor off", "cornell", "secondary", "path", 8, 0, 2.0 / 3, false, 4},
    {"caustic, one radius each", "glass", "caustic", "light", 1.5, 0, 1, true, 0},
    {"secondary, one radius each", "cornell", "secondary", "path", 4, 0, 1, true, 0},
};

std::string file_name(std::string text) {
  for (char& c : text)
    if (c == ' ' || c == ',') c = '-';
  return text;
}

class Bench {
 public:
  Bench(const PhotonBenchOptions& options, const ReportFolder& folder, const Hooks& hooks)
      : o_(options), folder_(folder), hooks_(hooks) {}
  Json run();

 private:
  // Unit: a measurement stored as one file, with its approximate effort.
  struct Unit {
    std::string name;
    fs::path file;
    double effort = 1;
    std::function<void(const fs::path&)> measure;
  };
  bool wanted(const char* part) const {
    return std::find(o_.parts.begin(), o_.parts.end(), part) != o_.parts.end();
  }
  fs::path unit(const std::string& name) const { return folder_.path() / "units" / name; }
  Json kept(const std::string& name) const { return Json::parse(read_file(unit(name))); }
  fs::path scene_file(const std::string& name) const { return o_.scenes / name / (name + ".gltf"); }

  void plan_slopes();
  void plan_rounds();
  void plan_lamps();
  void plan_free();
  Json slopes() const;

  std::unique_ptr<Renderer> renderer(uint32_t side) const {
    auto r = std::make_unique<Renderer>(session::RendererOptions{
        .device = o_.device, .validation = false, .shaders = {}, .defines = {}, .scenes = {}});
    r->set_size(side, side);
    return r;
  }
  std::unique_ptr<Renderer> load(const std::string& scene, uint32_t side, const Values& values) const {
    auto r = renderer(side);
    r->load(scene_file(scene), {}, changes(values));
    return r;
  }
  static std::vector<session::SettingChange> changes(const Values& values) {
    std::vector<session::SettingChange> list{{"sampling.mode", "uniform", ""}};
    for (const auto& [key, value] : values) list.push_back({key, value, ""});
    return list;
  }
  /// Renders until every pixel has that many samples.
  void render_to(Renderer& r, uint32_t samples) {
    while (r.samples() < samples && !r.done()) {
      if (hooks_.interrupted()) throw Interrupted{};
      if (!r.step(hooks_.interrupted)) break;
      report_progress(double(r.samples()) / double(r.sampling().max_samples()));
    }
    if (hooks_.interrupted()) throw Interrupted{};
  }
  void report_progress(double fraction, bool at_once = false) {
    if (!at_once && since_progress_.seconds() < k_progress_every_s) return;
    since_progress_.restart();
    status_.fraction = std::min(1.0, fraction);
    // From the time of finished units, including the finished part of the current one.
    const double done = done_ + status_.fraction * current_, all = effort_;
    if (done > 0.02 * all) status_.left_s = clock_.seconds() * (all - done) / done;
    hooks_.progress(status_);
  }

  film::FilmImage after_rounds(const Series& series, uint32_t seed);
  film::FilmImage truth_of(const Series& series, uint32_t seed);
  Json timed_rounds(Renderer& r, uint32_t paths);

  const PhotonBenchOptions& o_;
  const ReportFolder& folder_;
  const Hooks& hooks_;
  std::vector<Unit> units_;
  std::map<std::string, std::unique_ptr<Renderer>>
      renderers_;  ///< renderers of the slopes, one per settings of a series
  Status status_;
  Timer clock_, since_progress_;
  double effort_ = 0, done_ = 0, current_ = 0;
};

std::vector<float> luminance_of(const film::Image& image) {
  std::vector<float> all(image.samples.size(), 0.0f);
  for (const auto& component : image.components)
    for (size_t i = 0; i < all.size(); ++i) all[i] += luminance(component[i]);
  return all;
}

/// 1 if a pixel and its four neighbours show one plane, which excludes mirror images in curved surfaces.
std::vector<float> planes_of(const film::Image& image) {
  std::vector<float> plane(image.samples.size(), 1.0f);
  const auto w = int(image.width), h = int(image.height);
  const auto normal = [&](int x, int y) { return image.normal[size_t(y) * size_t(w) + size_t(x)]; };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (const auto& [dx, dy] : {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)}) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= w || y + dy >= h) continue;
        if (!(dot(normal(x, y), normal(x + dx, y + dy)) > 1 - k_plane))
          plane[size_t(y) * size_t(w) + size_t(x)] = 0;
      }
  return plane;
}

/// After 1, 2, 4 .. rounds, or for every radius after all of them.
std::vector<double> places_of(const Series& s, uint32_t rounds) {
  std::vector<double> places;
  if (s.over_radius)
    for (const double r : k_radii) places.push_back(s.radius * r);
  else
    for (uint32_t n = 1; n <= rounds; n *= 2) places.push_back(n);
  return places;
}

film::FilmImage Bench::after_rounds(const Series& s, uint32_t seed) {
  film::FilmImage out{.width = o_.side, .height = o_.side};
  std::unique_ptr<Renderer>& r = renderers_[s.name];
  if (!r) {
    Values v = alone(s.component);
    v.emplace_back(std::string("components.") + s.component, "photons");
    v.emplace_back("photons.per_round", std::to_string(k_light_paths));
    v.emplace_back("photons.alpha", fmt::format("{}", s.alpha));
    v.emplace_back("photons.floor", fmt::format("{}", s.floor));
    r = load(s.scene, o_.side, v);
  }
  const std::vector<double> places = places_of(s, o_.rounds);
  // Only the bias is needed for radii: few rounds suffice.
  const uint32_t samples = s.over_radius ? std::max(8u, o_.rounds / 8) : o_.rounds;
  for (size_t k = 0; k < places.size(); ++k) {
    if (k == 0 || s.over_radius) {
      r->settings().set("seed", std::to_string(seed));
      r->settings().set("samples", std::to_string(samples));
      r->settings().set("photons.radius", fmt::format("{}", s.over_radius ? places[k] : s.radius));
      r->apply_settings();
      r->restart();
    }
    render_to(*r, s.over_radius ? samples : uint32_t(places[k]));
    const film::Image image = r->image();
    out.channels.emplace_back(fmt::format("after {}", k), luminance_of(image));
    if (k + 1 == places.size()) out.channels.emplace_back("plane", planes_of(image));
  }
  return out;
}

film::FilmImage Bench::truth_of(const Series& s, uint32_t seed) {
  film::FilmImage out{.width = o_.side, .height = o_.side};
  std::unique_ptr<Renderer>& r = renderers_[std::string(s.scene) + s.component + s.reference];
  if (!r) {
    Values v = alone(s.component);
    v.emplace_back(std::string("components.") + s.component, s.reference);
    r = load(s.scene, o_.side, v);
  }
  const bool light = s.reference == std::string("light");
  const uint32_t samples = light ? o_.reference_samples : 8 * o_.reference_samples;
  r->settings().set("seed", std::to_string(k_reference_seed + seed));
  r->settings().set("samples", std::to_string(samples));
  r->apply_settings();
  r->restart();
  render_to(*r, samples);
  out.channels.emplace_back("truth", luminance_of(r->image()));
  return out;
}

std::string truth_name(const Series& s, uint32_t seed) {
  return fmt::format("truth-{}-{}-{}.exr", s.scene, s.component, seed);
}
std::string picture_name(const Series& s, uint32_t seed) {
  return fmt::format("{}-{}.exr", file_name(s.name), seed);
}

void Bench::plan_slopes() {
  for (const Series& s : k_series)
    for (uint32_t seed = 1; seed <= o_.seeds; ++seed) {
      if (*s.reference) {
        const std::string name = truth_name(s, seed);
        const bool known = std::any_of(units_.begin(), units_.end(),
                                       [&](const Unit& u) { return u.file.filename() == name; });
        const double share = s.reference == std::string("light") ? 100e-3 : 8 * 6e-3;
        if (!known)
          units_.push_back({fmt::format("{}, {}, truth {} of {}", s.scene, s.component, seed, o_.seeds),
                            unit(name), share * o_.reference_samples,
                            [this, &s, seed](const fs::path& f) { film::write_exr(f, truth_of(s, seed)); }});
      }
      const double rounds = s.over_radius ? double(k_radii.size()) * std::max(8u, o_.rounds / 8) : o_.rounds;
      units_.push_back({fmt::format("{}, {}, render {} of {}", s.scene, s.name, seed, o_.seeds),
                        unit(picture_name(s, seed)), 45e-3 * rounds,
                        [this, &s, seed](const fs::path& f) { film::write_exr(f, after_rounds(s, seed)); }});
    }
}

Json to_json(const char* of, const char* over, const std::optional<Slope>& s, double expected,
             const std::string& why) {
  Json j{{"of", of}, {"over", over}, {"value", nullptr}, {"expected", expected}, {"why", why}};
  if (s) j["value"] = s->value, j["low"] = s->low, j["high"] = s->high;
  return j;
}

Json Bench::slopes() const {
  Json all = Json::array();
  for (const Series& s : k_series) {
    std::vector<SeedPictures> renders;
    std::vector<uint8_t> mask(size_t{o_.side} * o_.side, 1);
    const std::vector<double> places = places_of(s, o_.rounds);
    for (uint32_t seed = 1; seed <= o_.seeds; ++seed) {
      const film::FilmImage image = film::read_exr(unit(picture_name(s, seed)));
      SeedPictures render;
      for (size_t k = 0; k < places.size(); ++k)
        render.after.push_back(*image.find(fmt::format("after {}", k)));
      const std::vector<float>& plane = *image.find("plane");
      for (size_t p = 0; p < mask.size(); ++p)
        if (plane[p] == 0) mask[p] = 0;
      if (*s.reference) render.truth = *film::read_exr(unit(truth_name(s, seed))).find("truth");
      renders.push_back(std::move(render));
    }
    const ErrorCurves curves = error_curves(renders, mask);
    Json j{{"series", s.name},
           {"scene", s.scene},
           {"component", s.component},
           {"radius", s.radius},
           {"floor", s.floor},
           {"alpha", s.alpha},
           {"over", s.over_radius ? "radius" : "rounds"}};
    j["pixels"] = std::count(mask.begin(), mask.end(), uint8_t{1});
    j["seeds"] = o_.seeds;
    const RadiusLaw law{s.radius, s.floor, s.alpha};
    for (size_t k = 0; k < places.size(); ++k) {
      Json point{{s.over_radius ? "radius" : "rounds", places[k]}, {"noise", curves.noise[k]}};
      if (*s.reference) point["bias"] = curves.bias[k], point["error"] = curves.error[k];
      j["points"].push_back(point);
    }
    // Slopes start where the law is asymptotic.
    size_t from = 0;
    while (!s.over_radius && from + 3 < places.size() && places[from] < s.first) ++from;
    const std::vector<double> x(places.begin() + long(from), places.end());
    for (SeedPictures& r : renders) r.after.erase(r.after.begin(), r.after.begin() + long(from));
    const auto found = error_slopes(x, renders, mask);
    const char* over = s.over_radius ? "radius" : "rounds";
    if (s.over_radius) {
      j["slopes"].push_back(
          to_json("bias", over, found[1], 2, "where light bends by no more than a parabola within a disc"));
      j["slopes"].push_back(to_json("noise", over, found[0], -1, "of independent photons"));
    } else {
      std::vector<double> noise, bias, error;
      for (const double n : x) noise.push_back(law.noise(uint32_t(n))), bias.push_back(law.bias(uint32_t(n)));
      for (size_t k = 0; k < x.size(); ++k)
        error.push_back(std::hypot(noise[k] / noise[0] * curves.noise[from],
                                   bias[k] / bias[0] * (*s.reference ? curves.bias[from] : 0)));
      const double limit = s.floor > 0 ? -0.5 : -s.alpha / 2;
      j["slopes"].push_back(
          to_json("noise", over, found[0], limit,
                  fmt::format("the law over these rounds: {:.3f}", log_slope(x, noise).value_or(0))));
      if (*s.reference) {
        j["slopes"].push_back(
            to_json("bias", over, found[1], s.alpha - 1,
                    fmt::format("the law over these rounds: {:.3f}", log_slope(x, bias).value_or(0))));
        j["slopes"].push_back(
            to_json("error", over, found[2], -1.0 / 3,
                    fmt::format("the law over these rounds, from noise and bias after {:.0f}: {:.3f}", x[0],
                                log_slope(x, error).value_or(0))));
      }
    }
    all.push_back(j);
  }
  return all;
}

/// Medians over rounds without the first, which compiles.
Json Bench::timed_rounds(Renderer& r, uint32_t paths) {
  std::vector<double> wall, cpu, trace, build;
  double photons = 0;
  r.settings().set("samples", std::to_string(o_.repeats + 1));
  r.apply_settings();
  r.restart();
  render_to(r, 1);
  for (uint32_t i = 0; i < o_.repeats; ++i) {
    const double before = cpu_seconds(), traced = r.solvers().figure("seconds of light paths"),
                 sorted = r.solvers().figure("seconds of sorting photons"),
                 stored = r.solvers().figure("photons");
    const Timer timer;
    render_to(r, i + 2);
    wall.push_back(timer.seconds()), cpu.push_back(cpu_seconds() - before);
    trace.push_back(r.solvers().figure("seconds of light paths") - traced);
    build.push_back(r.solvers().figure("seconds of sorting photons") - sorted);
    photons = r.solvers().figure("photons") - stored;
  }
  const Json statistics = r.solvers().statistics().value("photons", Json::object());
  const Json rates = statistics.value("per_second", Json::object());
  const double t = median(trace), b = median(build), w = median(wall);
  return {{"paths", paths},
          {"photons", photons},
          {"wall_s", w},
          {"cpu_s", median(cpu)},
          {"trace_s", t},
          {"build_s", b},
          {"build_share", w > 0 ? b / w : 0},
          {"emitted_per_s", t > 0 ? paths / t : 0},
          {"stored_per_s", t > 0 ? photons / t : 0},
          {"sorted_per_s", b > 0 ? photons / b : 0},
          {"looked_up_per_s", rates.value("looked_up", 0.0)},
          {"gathered_per_s", rates.value("gathered", 0.0)},
          {"casters", statistics.value("casters", 0)},
          {"bytes", statistics.value("bytes", 0.0)},
          // Time of light paths and the sorting of their photons.
          {"cpu_us_a_path", w > 0 ? 1e6 * median(cpu) * (t + b) / w / paths : 0}};
}

void Bench::plan_rounds() {
  for (const uint32_t paths : o_.paths)
    units_.push_back(
        {fmt::format("glass, rounds of {} light paths", paths), unit(fmt::format("round-{}.json", paths)),
         3 + 2.5e-6 * paths * (o_.repeats + 2), [this, paths](const fs::path& f) {
           const auto r = load("glass", k_rounds_side,
                               alone("caustic") + Values{{"components.caustic", "photons"},
                                                         {"photons.per_round", std::to_string(paths)}});
           write_file(f, json_text(timed_rounds(*r, paths), 1) + "\n");
         }});
}

/// The scene `glass` without its lamp, under that many point lamps spread over its ceiling, with equal total
/// power.
std::shared_ptr<const scene::Scene> with_lamps(const fs::path& file, uint32_t count) {
  scene::Scene s = scene::load(file);
  for (scene::Material& m : s.materials) m.emission = vec3(0), m.emission_texture = {};
  s.lights.clear();
  const Box box = scene::bounds(s);
  const auto across = uint32_t(std::ceil(std::sqrt(double(count))));
  for (uint32_t i = 0; i < count; ++i) {
    const auto share = [&](uint32_t k) { return 0.15f + 0.7f * (float(k) + 0.5f) / float(across); };
    scene::Light lamp{.name = fmt::format("lamp {}", i + 1), .kind = scene::LightKind::point};
    lamp.intensity = vec3(10 / float(count));
    lamp.position = mix(box.lo, box.hi, vec3(share(i % across), 0.95f, share(i / across)));
    s.lights.push_back(lamp);
  }
  return std::make_shared<const scene::Scene>(std::move(s));
}

void Bench::plan_lamps() {
  for (const uint32_t lamps : o_.lamps)
    units_.push_back({fmt::format("glass under {} lamps", lamps), unit(fmt::format("lamps-{}.json", lamps)),
                      4 + 0.2 * (o_.repeats + 2), [this, lamps](const fs::path& f) {
                        const auto r = renderer(k_lamp_side);
                        r->set_scene(with_lamps(scene_file("glass"), lamps), {},
                                     changes(alone("caustic") +
                                             Values{{"components.caustic", "photons"},
                                                    {"photons.per_round", std::to_string(k_lamp_paths)}}));
                        Json j = timed_rounds(*r, k_lamp_paths);
                        j["lamps"] = lamps;
                        write_file(f, json_text(j, 1) + "\n");
                      }});
}

/// Renders of a scene without mirrors or glass, alternately, every second pair in reverse order.
void Bench::plan_free() {
  units_.push_back(
      {"cornell, nothing that bundles light", unit("free.json"), 2.0 * o_.pairs, [this](const fs::path& f) {
         const auto of = [&](const char* solver) {
           return load("cornell", k_free_side,
                       {{"components.caustic", solver}, {"samples", std::to_string(k_free_samples)}});
         };
         const auto path = of("path"), photons = of("photons");
         std::vector<double> extra, plain;
         const auto seconds = [&](Renderer& r) {
           r.restart();
           const double before = cpu_seconds();
           render_to(r, k_free_samples);
           return cpu_seconds() - before;
         };
         for (uint32_t i = 0; i <= o_.pairs; ++i) {
           double a = 0, b = 0;
           if (i % 2 == 0) a = seconds(*path);
           b = seconds(*photons);
           if (i % 2 == 1) a = seconds(*path);
           if (i > 0) extra.push_back(b / a - 1), plain.push_back(a);  // the first pair compiles
           report_progress(double(i) / o_.pairs);
         }
         const Slope m = median95(extra);
         write_file(f, json_text(Json{{"scene", "cornell"},
                                      {"samples", k_free_samples},
                                      {"pairs", o_.pairs},
                                      {"extra", m.value},
                                      {"low", m.low},
                                      {"high", m.high},
                                      {"path_cpu_s", median(plain)},
                                      {"rays", path->stats().rays},
                                      {"rays_with_photons", photons->stats().rays},
                                      {"light_paths", photons->solvers().figure("light paths")}},
                                 1) +
                           "\n");
       }});
}

Json Bench::run() {
  if (wanted("slopes")) plan_slopes();
  if (wanted("rounds")) plan_rounds();
  if (wanted("lamps")) plan_lamps();
  if (wanted("free")) plan_free();
  std::vector<const Unit*> todo;
  for (const Unit& u : units_)
    if (!file_exists(u.file)) todo.push_back(&u), effort_ += u.effort;
  status_.steps = todo.size();
  for (const Unit* u : todo) {
    ++status_.step;
    status_.what = u->name, current_ = u->effort;
    report_progress(0, true);
    u->measure(u->file);
    done_ += current_;
  }
  renderers_.clear();
  Json j;
  if (wanted("slopes")) j["slopes"] = slopes();
  for (const uint32_t paths : o_.paths)
    if (wanted("rounds")) j["rounds"].push_back(kept(fmt::format("round-{}.json", paths)));
  for (const uint32_t lamps : o_.lamps)
    if (wanted("lamps")) j["lamps"].push_back(kept(fmt::format("lamps-{}.json", lamps)));
  if (wanted("free")) j["free"] = kept("free.json");
  return j;
}

}  // namespace

nlohmann::ordered_json to_json(const PhotonBenchOptions& o) {
  // Values of single parts are stored with them, so that another list of paths does not repeat the slopes.
  return {{"name", "photons"},
          {"side", o.side},
          {"seeds", o.seeds},
          {"rounds", o.rounds},
          {"reference_samples", o.reference_samples},
          {"repeats", o.repeats},
          {"pairs", o.pairs}};
}

std::optional<nlohmann::ordered_json> measure_photons(const PhotonBenchOptions& options,
                                                      const ReportFolder& folder, const Hooks& hooks) {
  try {
    return Bench(options, folder, hooks).run();
  } catch (const Interrupted&) {
    return std::nullopt;
  } catch (const Error&) {
    // Loading and compiling end with an Error if cancelled.
    if (!hooks.interrupted()) throw;
    return std::nullopt;
  }
}

}  // namespace lucerna::bench
