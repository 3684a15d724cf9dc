#include "session/picture_layers.h"

#include <algorithm>
#include <set>

#include "base/log.h"
#include "film/error.h"
#include "film/io/planes.h"
#include "paths/automaton.h"

namespace lucerna::session {

namespace {

/// A layer of the light of one group with its mix: 16-bit floats unless values exceed them. Empty layers are
/// left out.
void add_light_layer(film::FilmImage& out, const std::string& name, const std::vector<vec3>& mean,
                     const vec3& weight) {
  constexpr float k_largest_half = 65504;
  if (std::all_of(mean.begin(), mean.end(), [](const vec3& v) { return v == vec3(0); })) return;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> channel(mean.size());
    for (size_t i = 0; i < channel.size(); ++i) channel[i] = weight[k] * mean[i][k];
    const std::string full = fmt::format("{}.{}", name, "RGB"[k]);
    const float largest = *std::max_element(channel.begin(), channel.end());
    if (largest <= k_largest_half) out.halves.insert(full);
    out.channels.emplace_back(full, std::move(channel));
  }
}

/// Layers of light groups: light.GROUP.COMPONENT, or light.GROUP if components are stored together. With one
/// group the picture is the layer.
void add_group_layers(film::FilmImage& out, const film::Film& film, const Relight& relight) {
  if (film.groups() == 1) return;
  std::set<std::string> used;
  for (uint32_t g = 0; g < film.groups(); ++g) {
    // A dot would split the layer's name.
    std::string name = "light." + relight.groups->groups[g].name;
    std::replace(name.begin() + 6, name.end(), '.', '_');
    // The replacement may equal another group's name.
    while (!used.insert(name).second) name += '_';
    if (film.is_compact()) {
      add_light_layer(out, name, film.read_group_sum(g), relight.weights[g]);
      continue;
    }
    const auto means = film.read_group(g);
    for (size_t c = 0; c < means.size(); ++c)
      add_light_layer(out, name + "." + paths::k_component_names[c], means[c], relight.weights[g]);
  }
}

}  // namespace

film::FilmImage picture_layers(const Setup& setup, const film::Image& image) {
  film::FilmImage out;
  out.width = image.width;
  out.height = image.height;
  const size_t n = image.samples.size();
  std::vector<vec3> sum(n, vec3(0));
  for (const auto& component : image.components)
    for (size_t i = 0; i < n; ++i) sum[i] += component[i];
  film::add_plane(out, "", "RGB", sum);
  for (const int c : k_components)
    film::add_plane(out, std::string(paths::k_component_names[c]) + ".", "RGB", image.components[c]);
  for (size_t l = 0; l < image.layers.size(); ++l)
    film::add_plane(out, setup.engine->layers().layers().at(l).name + ".", "RGB", image.layers[l]);
  if (setup.settings.boolean("relight.layers")) {
    if (setup.relight.separate)
      add_group_layers(out, *setup.film, setup.relight);
    else
      log::warning("relight.layers: the EXR has no layers of light groups: {}", setup.relight.why_not);
  }
  film::add_plane(out, "albedo.", "RGB", image.albedo);
  film::add_plane(out, "N.", "XYZ", image.normal);
  out.channels.emplace_back("Z", image.depth);
  out.channels.emplace_back("samples", std::vector<float>(image.samples.begin(), image.samples.end()));
  const scene::Scene& scene = *setup.world.scene;
  out.metadata["version"] = LUCERNA_VERSION;
  out.metadata["settings"] = setup.settings.changed_json();
  out.metadata["seed"] = setup.settings.text("seed");
  out.metadata["scene"] = scene.name;
  out.metadata["view"] = setup.view_text();
  if (const glm::dvec3& o = scene.origin; o != glm::dvec3(0))
    out.metadata["origin"] = fmt::format("{} {} {}", o.x, o.y, o.z);
  return out;
}

void add_noise_layers(film::FilmImage& out, const Setup& setup, const film::Image& image, bool looks_up) {
  constexpr uint32_t k_tile = 16;
  std::vector<vec3> sum(image.samples.size(), vec3(0));
  for (const auto& component : image.odd_half)
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += component[i];
  film::add_plane(out, "odd.", "RGB", sum);
  for (const int c : k_components)
    film::add_plane(out, std::string("odd.") + paths::k_component_names[c] + ".", "RGB", image.odd_half[c]);
  for (size_t l = 0; l < image.odd_layers.size(); ++l)
    film::add_plane(out, "odd." + setup.engine->layers().layers().at(l).name + ".", "RGB",
                    image.odd_layers[l]);
  if (!looks_up) return;
  const std::vector<film::TileError> tiles = film::tile_errors(*setup.film, k_tile);
  const uint32_t across = (image.width + k_tile - 1) / k_tile;
  std::vector<float> noise(sum.size()), bias(sum.size());
  for (size_t i = 0; i < sum.size(); ++i) {
    const film::TileError& t = tiles[i / image.width / k_tile * across + i % image.width / k_tile];
    noise[i] = float(t.lookups.noise), bias[i] = float(t.lookups.interpolation);
  }
  out.channels.emplace_back("lookup.noise", std::move(noise));
  out.channels.emplace_back("lookup.bias", std::move(bias));
}

}  // namespace lucerna::session
