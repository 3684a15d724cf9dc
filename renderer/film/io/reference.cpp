#include "film/io/reference.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.h"

namespace lucerna::film {
namespace {

constexpr const char* k_names[k_reference_layers] = {"sum", "primary", "secondary", "tertiary", "caustic"};

std::optional<LayerFigures> parse_noise(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  LayerFigures rms{};
  for (int k = 0; k < k_reference_layers; ++k) {
    if (!json.is_object() || !json.contains(k_names[k]) || !json[k_names[k]].is_number()) return std::nullopt;
    rms[size_t(k)] = json[k_names[k]].get<double>();
    if (!(rms[size_t(k)] >= 0)) return std::nullopt;
  }
  return rms;
}

/// Its own layers: those of R, G and B that are neither features nor parts of other layers ("odd.primary").
std::map<std::string, ReferenceLayer> own_layers_of(const FilmImage& image) {
  const auto at = image.metadata.find("noise");
  const nlohmann::json noise =
      nlohmann::json::parse(at == image.metadata.end() ? std::string() : at->second, nullptr, false);
  std::map<std::string, ReferenceLayer> own;
  for (const std::string& name : image.layers()) {
    const auto* r = image.find(name + ".R");
    const auto* g = image.find(name + ".G");
    const auto* b = image.find(name + ".B");
    const bool known = std::find(std::begin(k_names), std::end(k_names), name) != std::end(k_names);
    if (!r || !g || !b || known || name.find('.') != std::string::npos || name == "albedo" || name == "odd" ||
        name == "filtered")
      continue;
    ReferenceLayer& layer = own[name];
    for (size_t i = 0; i < r->size(); ++i)
      layer.luminance.push_back(luminance(vec3((*r)[i], (*g)[i], (*b)[i])));
    if (noise.is_object() && noise.contains(name) && noise[name].is_number() && noise[name] >= 0)
      layer.noise = noise[name].get<double>();
  }
  return own;
}

}  // namespace

std::string noise_text(const LayerFigures& rms, std::span<const std::pair<std::string, double>> own) {
  nlohmann::ordered_json json;
  for (int k = 0; k < k_reference_layers; ++k) json[k_names[k]] = rms[size_t(k)];
  for (const auto& [name, error] : own) json[name] = error;
  return json_text(json);
}

Reference read_reference(const std::filesystem::path& file, uint32_t width, uint32_t height) {
  const std::string where = file.string();
  const FilmImage image = read_exr(file);
  if (image.width != width || image.height != height)
    throw_error(where, "the reference is {}x{} pixels, the picture {}x{}; they must be of one size",
                image.width, image.height, width, height);
  Reference reference;
  reference.file = file;
  reference.width = width;
  reference.height = height;
  const size_t pixels = size_t{width} * height;
  for (int k = 0; k < k_reference_layers; ++k) {
    const std::string prefix = k == 0 ? "" : std::string(k_names[k]) + ".";
    std::array<const std::vector<float>*, 3> planes{};
    for (int c = 0; c < 3; ++c) {
      planes[c] = image.find(prefix + "RGB"[c]);
      if (!planes[c])
        throw_error(where,
                    "no channel '{}'; a reference holds R, G, B and the same of primary, secondary, tertiary "
                    "and caustic, as 'lucerna render -o REF.exr' writes them",
                    prefix + "RGB"[c]);
    }
    auto& luminances = reference.luminance[size_t(k)];
    luminances.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) {
      luminances[i] = luminance(vec3((*planes[0])[i], (*planes[1])[i], (*planes[2])[i]));
      if (!std::isfinite(luminances[i]))
        throw_error(where, "the {} layer is not finite at x {} y {}; such a picture is no reference",
                    k_names[k], i % width, i / width);
    }
  }
  double sum = 0;
  for (const float y : reference.luminance[0]) sum += double{y};
  reference.mean_luminance = sum / double(pixels);
  if (!(reference.mean_luminance > 0))
    throw_error(where, "the reference is black: nothing can be compared with it");
  const auto attribute = [&](const char* key) {
    const auto at = image.metadata.find(key);
    return at == image.metadata.end() ? std::string() : at->second;
  };
  reference.noise = parse_noise(attribute("noise"));
  reference.own_layers = own_layers_of(image);
  reference.scene = attribute("scene");
  reference.view = attribute("view");
  reference.seed = attribute("seed");
  return reference;
}

LayerFigures true_errors(const Reference& reference, std::span<const std::vector<vec3>> components,
                         std::span<const uint32_t> samples) {
  LayerFigures squares{};
  double pixels = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (samples[i] == 0) continue;
    ++pixels;
    double sum = 0;
    for (size_t c = 0; c < components.size(); ++c) {
      const double y = luminance(components[c][i]), d = y - double{reference.luminance[c + 1][i]};
      sum += y;
      squares[c + 1] += d * d;
    }
    const double d = sum - double{reference.luminance[0][i]};
    squares[0] += d * d;
  }
  LayerFigures errors{};
  for (size_t k = 0; k < errors.size() && pixels > 0; ++k) {
    const double own = reference.noise ? (*reference.noise)[k] : 0;
    errors[k] = std::sqrt(std::max(0.0, squares[k] / pixels - own * own)) / reference.mean_luminance;
  }
  return errors;
}

std::optional<double> true_error(const Reference& reference, const std::string& layer,
                                 std::span<const vec3> radiance, std::span<const uint32_t> samples) {
  const auto found = reference.own_layers.find(layer);
  if (found == reference.own_layers.end()) return std::nullopt;
  double squares = 0, pixels = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (samples[i] == 0) continue;
    const double d = luminance(radiance[i]) - double{found->second.luminance[i]};
    ++pixels, squares += d * d;
  }
  const double own = found->second.noise.value_or(0);
  const double error =
      pixels > 0 ? std::sqrt(std::max(0.0, squares / pixels - own * own)) / reference.mean_luminance : 0;
  return std::isfinite(error) ? std::optional(error) : std::nullopt;
}

}  // namespace lucerna::film
