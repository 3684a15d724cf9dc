#include "commands/pixel_report.h"

#include <algorithm>
#include <cmath>

#include "commands/text.h"
#include "session/pick.h"
#include "session/session.h"

namespace lucerna::commands {
namespace {

constexpr uint32_t k_tile = 16;

/// Weights of the luminance, or 1 for a single channel.
double weight(size_t channel, size_t channels) {
  constexpr double k_weights[] = {0.2126, 0.7152, 0.0722};
  return channels == 3 ? k_weights[channel] : 1;
}

/// Half of the difference of a pixel's halves, in luminance, as the standard error of their mean.
double half_difference(const film::FilmImage& image, const std::vector<size_t>& all,
                       const std::vector<size_t>& odd, double samples, size_t i) {
  const double n_odd = std::floor(samples / 2), n_even = samples - n_odd;
  double d = 0;
  for (size_t c = 0; c < all.size(); ++c) {
    const double m = double(image.channels[all[c]].second[i]), o = double(image.channels[odd[c]].second[i]);
    const double e = (m * samples - o * n_odd) / n_even;
    d += weight(c, all.size()) * (e - o) * std::sqrt(n_even * n_odd) / samples;
  }
  return d;
}

PixelLayer layer_at(const film::FilmImage& image, const std::string& name, uint32_t x, uint32_t y,
                    const std::vector<float>* samples) {
  PixelLayer layer{.name = name, .value = {}, .noise = {}, .tile_noise = {}};
  const std::vector<size_t> all = image.layer(name);
  const size_t i = size_t{y} * image.width + x;
  for (const size_t c : all) layer.value.push_back(image.channels[c].second[i]);
  const std::vector<size_t> odd = image.layer(name == "rgb" ? "odd" : "odd." + name);
  if (!samples || odd.size() != all.size() || (*samples)[i] < 2) return layer;
  layer.noise = std::abs(half_difference(image, all, odd, double((*samples)[i]), i));
  double sum = 0, pixels = 0;
  const uint32_t x0 = x / k_tile * k_tile, y0 = y / k_tile * k_tile;
  for (uint32_t ty = y0; ty < std::min(y0 + k_tile, image.height); ++ty)
    for (uint32_t tx = x0; tx < std::min(x0 + k_tile, image.width); ++tx) {
      const size_t k = size_t{ty} * image.width + tx;
      if ((*samples)[k] < 2) return layer;
      const double d = half_difference(image, all, odd, double((*samples)[k]), k);
      sum += d * d, pixels += 1;
    }
  layer.tile_noise = std::sqrt(sum) / pixels;
  return layer;
}

/// "Brass lamp", or "object 3" for one without a name.
std::string named_or(const std::string& name, const char* kind, uint32_t index) {
  return name.empty() ? fmt::format("{} {}", kind, index + 1) : name;
}

}  // namespace

PixelReport report_pixel(const film::FilmImage& image, const vec2& at) {
  const auto pixel = [](float place, uint32_t size) {
    return static_cast<uint32_t>(std::clamp(place * float(size), 0.0f, float(size) - 1));
  };
  PixelReport report{.x = pixel(at.x, image.width), .y = pixel(at.y, image.height)};
  const size_t i = size_t{report.y} * image.width + report.x;
  const std::vector<float>* samples = image.find("samples");
  if (samples) report.samples = static_cast<uint32_t>((*samples)[i]);
  std::vector<std::string> names{"rgb"};
  for (const char* name : session::k_component_names) names.emplace_back(name);
  for (const std::string& name : image.layers())
    if (!name.starts_with("odd") && !name.starts_with("lookup") && name != "samples" &&
        std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  for (const std::string& name : names)
    if (!image.layer(name).empty())
      report.layers.push_back(layer_at(image, name, report.x, report.y, samples));
  if (const std::vector<float>* noise = image.find("lookup.noise")) report.lookup_noise = double((*noise)[i]);
  if (const std::vector<float>* bias = image.find("lookup.bias")) report.lookup_bias = double((*bias)[i]);
  return report;
}

std::vector<std::string> surface_lines(const scene::Scene& scene, const scene::Camera& camera, const vec2& at,
                                       float aspect) {
  const std::optional<session::Picked> hit = session::pick(scene, camera, at.x, at.y, aspect);
  if (!hit) return {"surface: nothing but the environment"};
  const scene::Instance& instance = scene.instances[hit->instance];
  const scene::Material& material = scene.materials[hit->material];
  std::vector<std::string> lines;
  lines.push_back("object: " + named_or(instance.name, "object", hit->instance));
  lines.push_back("material: " + named_or(material.name, "material", hit->material));
  lines.push_back(fmt::format("triangle: {} of part {} of the mesh '{}'", hit->triangle, hit->primitive,
                              scene.meshes[instance.mesh].name));
  if (const std::optional<vec2> uv = session::picked_uv(scene, *hit))
    lines.push_back(fmt::format("texture coordinates: {:.4f} {:.4f}", uv->x, uv->y));
  lines.push_back(fmt::format("place: {:.4f} {:.4f} {:.4f} m, {:.4f} m away", hit->position.x,
                              hit->position.y, hit->position.z, hit->distance));
  lines.push_back(fmt::format("normal: {:.3f} {:.3f} {:.3f}", hit->normal.x, hit->normal.y, hit->normal.z));
  return lines;
}

std::vector<std::string> to_lines(const PixelReport& report) {
  std::vector<std::string> lines{fmt::format("pixel {} {}: {} samples", report.x, report.y, report.samples)};
  for (const PixelLayer& layer : report.layers) {
    std::string text = layer.name == "rgb" ? "sum" : layer.name;
    text += ":";
    for (const float v : layer.value) text += fmt::format(" {:.4g}", v);
    if (layer.noise) text += fmt::format(" +- {:.2g}", *layer.noise);
    if (layer.tile_noise) text += fmt::format(" (mean of its tile +- {:.2g})", *layer.tile_noise);
    lines.push_back(text);
  }
  if (report.lookup_noise)
    lines.push_back(fmt::format("noise of records in its tile: {:.2g}", *report.lookup_noise));
  if (report.lookup_bias)
    lines.push_back(fmt::format("bias of lookups in its tile: {:.2g}", *report.lookup_bias));
  return lines;
}

}  // namespace lucerna::commands
