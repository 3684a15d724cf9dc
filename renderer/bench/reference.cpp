#include "bench/reference.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/file.h"
#include "base/hash.h"
#include "base/json_text.h"
#include "film/io/image_file.h"
#include "solvers/registry.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// FNV-1a of strings, each with its length, so that concatenations differ.
class Pieces {
 public:
  void add(std::string_view bytes) {
    hash_.add_bytes(bytes.data(), bytes.size());
    hash_.add_value(uint64_t{bytes.size()});
  }
  std::string text() const { return fmt::format("{:016x}", hash_.low()); }

 private:
  Hash hash_;
};

std::string decode_uri(const std::string& uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    if (uri[i] == '%' && i + 2 < uri.size() && std::sscanf(uri.substr(i + 1, 2).c_str(), "%2x", &code) == 1)
      text += char(code), i += 2;
    else
      text += uri[i];
  }
  return text;
}

/// Every text under a key "uri" (buffers, images) or "file" (environments), at any depth.
void collect_files(const Json& json, std::set<std::string>& files) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      if ((key == "uri" || key == "file") && value.is_string()) {
        const std::string uri = value.get<std::string>();
        if (!uri.starts_with("data:")) files.insert(decode_uri(uri));
      }
      collect_files(value, files);
    }
  } else if (json.is_array()) {
    for (const Json& value : json) collect_files(value, files);
  }
}

/// The JSON of a .gltf, or of a .glb's first chunk.
std::string json_part(const std::string& bytes) {
  if (!bytes.starts_with("glTF") || bytes.size() < 20) return bytes;
  uint32_t length = 0;
  for (int k = 3; k >= 0; --k) length = length << 8 | uint8_t(bytes[12 + size_t(k)]);
  return bytes.substr(20, length);
}

void set_aside(const fs::path& file, const std::string& why, const Message& message) {
  fs::path old;
  int n = 1;
  do {
    old = file.string() + (n == 1 ? ".old" : fmt::format(".old{}", n));
    ++n;
  } while (file_exists(old));
  std::error_code code;
  fs::rename(file, old, code);
  if (code) throw_error(file.string(), "{}, and it cannot be renamed: {}", why, code.message());
  message(fmt::format("{}: {}; it is rendered again (the old one is now {})", file.string(), why,
                      old.filename().string()));
}

}  // namespace

Json scene_json(const fs::path& file) { return Json::parse(json_part(read_file(file)), nullptr, false); }

std::string scene_hash(const fs::path& file) {
  Pieces hash;
  const std::string bytes = read_file(file);
  hash.add(bytes);
  std::set<std::string> files;
  collect_files(Json::parse(json_part(bytes), nullptr, false), files);
  const fs::path settings = file.parent_path() / "settings.json";
  if (file_exists(settings)) {
    const std::string text = read_file(settings);
    hash.add(text);
    collect_files(Json::parse(text, nullptr, false), files);
  }
  for (const std::string& name : files) {
    const fs::path part = file.parent_path() / name;
    hash.add(name);
    std::error_code code;
    hash.add(fs::is_regular_file(part, code) ? read_file(part) : "missing");
  }
  return hash.text();
}

std::string reference_key(const Matrix& matrix, const SceneEntry& scene, const std::string& scene_hash) {
  Json j{{"scene", scene_hash},    {"width", scene.width},          {"height", scene.height},
         {"camera", scene.camera}, {"seed", matrix.reference_seed}, {"version", LUCERNA_VERSION},
         {"halves", true}};
  SettingValues values = scene.set;
  values.insert(matrix.set.begin(), matrix.set.end());  // the scene's values take precedence
  for (const auto& [key, value] : values)
    if (!solvers::owner_of(key)) j["set"][key] = value;
  Pieces hash;
  hash.add(json_text(j));
  return hash.text();
}

fs::path reference_file(const fs::path& folder, const SceneEntry& scene) {
  return folder / fmt::format("{}-{}x{}.exr", scene.name, scene.width, scene.height);
}

void describe_reference(std::map<std::string, std::string>& metadata, const ReferenceInfo& info) {
  metadata["bench.key"] = info.key;
  metadata["bench.samples"] = std::to_string(info.samples);
  metadata["bench.seconds"] = fmt::format("{}", info.seconds);
}

void add_odd_half(film::FilmImage& reference, const film::Image& image) {
  for (int k = 0; k < 3; ++k) {
    std::vector<float> channel(image.samples.size(), 0);
    for (const auto& component : image.odd_half)
      for (size_t i = 0; i < channel.size(); ++i) channel[i] += component[i][k];
    reference.channels.emplace_back(std::string("odd.") + "RGB"[k], std::move(channel));
  }
}

film::ReferencePair read_halves(const film::FilmImage& reference, const std::string& where) {
  const std::vector<float>* samples = reference.find("samples");
  if (!samples) throw_error(where, "no channel 'samples'; the halves of the samples cannot be separated");
  film::ReferencePair pair{.width = reference.width,
                           .first = std::vector<vec3>(samples->size()),
                           .second = std::vector<vec3>(samples->size())};
  for (int k = 0; k < 3; ++k) {
    const std::string name(1, "RGB"[k]);
    const std::vector<float>*all = reference.find(name), *odd = reference.find("odd." + name);
    if (!all || !odd)
      throw_error(where, "no channel '{}'; a reference holds the mean of all samples and of the odd ones",
                  all ? "odd." + name : name);
    for (size_t i = 0; i < samples->size(); ++i) {
      const double n = (*samples)[i], n_odd = std::floor(n / 2);
      if (!(n_odd >= 1)) throw_error(where, "pixel {} has {} samples; halves need two", i, n);
      pair.first[i][k] = (*odd)[i];
      pair.second[i][k] = float((n * double{(*all)[i]} - n_odd * double{(*odd)[i]}) / (n - n_odd));
    }
  }
  return pair;
}

void find_noise(ReferenceInfo& info, const film::FilmImage& image, const SceneEntry& scene) {
  const film::ReferencePair halves = read_halves(image, info.file.string());
  info.relmse_noise = film::relative_mse_noise(halves), info.seen_noise = film::seen_mse_noise(halves);
  const film::Reference reference = film::read_reference(info.file, scene.width, scene.height);
  for (size_t k = 0; k < info.noise.size() && reference.noise; ++k)
    info.noise[k] = (*reference.noise)[k] / reference.mean_luminance;
}

std::optional<ReferenceInfo> find_reference(const fs::path& folder, const SceneEntry& scene,
                                            const std::string& key, const Message& message) {
  ReferenceInfo info;
  info.file = reference_file(folder, scene);
  if (!file_exists(info.file)) return std::nullopt;
  std::string why;
  try {
    const film::FilmImage image = film::read_exr(info.file);
    const auto attribute = [&](const char* name) {
      const auto at = image.metadata.find(name);
      return at == image.metadata.end() ? std::string() : at->second;
    };
    info.key = attribute("bench.key");
    info.samples = uint32_t(std::strtoul(attribute("bench.samples").c_str(), nullptr, 10));
    info.seconds = std::strtod(attribute("bench.seconds").c_str(), nullptr);
    info.seed = uint32_t(std::strtoul(attribute("seed").c_str(), nullptr, 10));
    const film::Reference reference = film::read_reference(info.file, scene.width, scene.height);
    if (info.key == key) find_noise(info, image, scene);
    if (info.key.empty())
      why = "no reference of a bench";
    else if (info.key != key)
      why = "made of another scene, with other settings or by another version";
    else if (info.samples < scene.reference_samples)
      why = fmt::format("has {} samples instead of {}", info.samples, scene.reference_samples);
    else if (!reference.noise)
      why = "has no estimate of its own noise";
  } catch (const Error& e) {
    why = e.what();
    // The message names the file itself.
    if (const std::string head = e.where() + ": "; why.starts_with(head)) why = why.substr(head.size());
  }
  if (why.empty()) return info;
  set_aside(info.file, why, message);
  return std::nullopt;
}

}  // namespace lucerna::bench
