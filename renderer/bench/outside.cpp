#include "bench/outside.h"

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "film/io/reference.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

/// 0 if missing: older programs write fewer figures.
double number(const Json& stats, const char* key) {
  const auto at = stats.find(key);
  return at != stats.end() && at->is_number() ? at->get<double>() : 0;
}

/// Colours of a layer; all 0 if it is missing.
std::vector<vec3> layer(const film::FilmImage& picture, const std::string& name) {
  std::vector<vec3> all(size_t{picture.width} * picture.height, vec3(0));
  for (int k = 0; k < 3; ++k)
    if (const std::vector<float>* plane = picture.find(name + "RGB"[k]))
      for (size_t i = 0; i < all.size(); ++i) all[i][k] = (*plane)[i];
  return all;
}

}  // namespace

std::vector<std::string> outside_arguments(const Matrix& m, const Cell& cell, const SettingValues& values,
                                           const std::string& device, const scene::LoadOptions& scenes,
                                           const OutsideFiles& files, double times) {
  const SceneEntry& scene = m.scenes[cell.scene];
  const Budget budget = m.budget(cell);
  std::vector<std::string> all{"render",
                               scene.file.string(),
                               "--quiet",
                               "--size",
                               fmt::format("{}x{}", scene.width, scene.height),
                               "--seed",
                               std::to_string(m.seed + uint32_t(cell.repeat)),
                               "--stats",
                               files.stats.string(),
                               "-o",
                               files.picture.string()};
  const auto add = [&](const char* option, const std::string& value) {
    all.emplace_back(option), all.push_back(value);
  };
  if (!files.shown.empty()) add("-o", files.shown.string());
  if (!scene.camera.empty()) add("--camera", scene.camera);
  if (!device.empty()) add("--device", device);
  if (scenes.outside) all.emplace_back("--allow-outside");
  if (scenes.most_bytes != scene::k_scene_bytes)
    add("--scene-memory", fmt::format("{}", double(scenes.most_bytes) / double(1ull << 30)));
  SettingValues set = values;
  const std::string endless = std::to_string(1u << 20);
  if (budget.kind == BudgetKind::samples) {
    add("--samples", fmt::format("{:.0f}", budget.value));
  } else if (budget.kind == BudgetKind::errors) {
    add("--error", fmt::format("{}", budget.value));
  } else {
    add("--time", fmt::format("{}", times * budget.value));
    add("--samples", endless);
    set.emplace("sampling.max_samples", endless);
  }
  for (const auto& [key, value] : set) add("--set", key + "=" + value);
  return all;
}

bool out_of_time(const ProgramResult& result) {
  return result.status == 1 && result.last_line().find("--time: ") != std::string::npos;
}

std::vector<vec3> colours(const film::FilmImage& picture, const std::string& where) {
  for (const char* name : {"R", "G", "B"})
    if (!picture.find(name)) throw_error(where, "no channel '{}'", name);
  return layer(picture, "");
}

Result read_outside(const OutsideFiles& files, const SceneEntry& scene, const ReferenceInfo& info,
                    const film::FilmImage& truth) {
  const std::string where = files.picture.string();
  const film::FilmImage picture = film::read_exr(files.picture);
  if (picture.width != scene.width || picture.height != scene.height)
    throw_error(where, "is {}x{}, not {}x{}", picture.width, picture.height, scene.width, scene.height);
  const Json stats = Json::parse(read_file(files.stats), nullptr, false);
  if (!stats.is_object() || !(number(stats, "wall_s") > 0))
    throw_error(files.stats.string(), "not as render writes it: no seconds in it");

  Result r;
  r.tracer = stats.value("tracer", std::string("unknown"));
  r.wall_s = number(stats, "wall_s");
  r.setup_s = number(stats, "load_s") + number(stats, "compile_s");
  r.rays = uint64_t(number(stats, "rays")), r.paths = uint64_t(number(stats, "paths"));
  r.dropped = uint64_t(number(stats, "dropped"));
  r.samples = double(r.paths) / (double(scene.width) * scene.height);
  if (const auto error = stats.find("error"); error != stats.end() && error->is_object()) {
    // Name of the error in programs from before errors as seen.
    r.estimated[0] = number(*error, error->contains("of_mean") ? "of_mean" : "relative");
    r.tiles.median = number(*error, "tile_median"), r.tiles.decile = number(*error, "tile_worst_decile");
    r.tiles.worst = number(*error, "tile_worst");
    r.tiles.heavy = uint64_t(number(*error, "heavy_tailed_tiles"));
  }

  const film::ReferencePair halves = read_halves(truth, info.file.string());
  const std::vector<vec3> sum = colours(picture, where);
  const film::RelativeMse relative = film::relative_mse(sum, halves);
  const film::SeenMse seen = film::seen_mse(sum, halves);
  r.relmse = std::max(0.0, relative.trimmed), r.relmse_all = std::max(0.0, relative.all);
  r.seen = std::max(0.0, seen.trimmed), r.seen_all = std::max(0.0, seen.all);
  const film::Reference reference = film::read_reference(info.file, scene.width, scene.height);
  std::vector<std::vector<vec3>> components;
  for (int k = 1; k < film::k_reference_layers; ++k)
    components.push_back(layer(picture, std::string(stats::k_layer_names[size_t(k)]) + "."));
  const std::vector<float>* counts = picture.find("samples");
  if (!counts) throw_error(where, "no channel 'samples'");
  std::vector<uint32_t> samples(counts->size());
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = uint32_t((*counts)[i]);
  r.truth = film::true_errors(reference, components, samples);
  const double rms = r.truth[0] * reference.mean_luminance;
  r.mse = rms * rms;
  r.in_reference_noise = r.truth[0] < 0.7 * info.noise[0];
  r.curve.push_back({.wall_s = r.wall_s,
                     .rays = r.rays,
                     .samples = r.samples,
                     .estimated = r.estimated,
                     .truth = r.truth,
                     .tiles = r.tiles.decile,
                     .relmse = r.relmse,
                     .seen = r.seen});
  return r;
}

}  // namespace lucerna::bench
