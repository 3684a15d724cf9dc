#include "session/layer_status.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "session/engine.h"

namespace lucerna::session {
namespace {

/// Names of layers that every picture has, and first parts of names in EXR files.
std::vector<std::string> reserved_names() {
  std::vector<std::string> names = plan::find_option("film.layer")->choices;
  for (const char* name : {"R", "G", "B", "A", "N", "Z", "odd", "filtered", "light", "lookup"})
    names.emplace_back(name);
  return names;
}

}  // namespace

paths::LayerSet layer_set(const paths::Automaton& automaton, const plan::Settings& settings) {
  const std::string& text = settings.text("film.layers");
  if (text.empty()) return {};
  return {automaton, text, reserved_names()};
}

void check_layers(const std::string& text) {
  paths::LayerSet(paths::compile_components(), text, reserved_names());
}

std::vector<paths::Layer> layers_in(const std::string& text) {
  try {
    return paths::parse_layers(text, {});
  } catch (const Error&) {
    return {};
  }
}

void check_shown_layer(const paths::LayerSet& layers, const plan::Settings& settings) {
  const std::string& name = settings.text("film.layer");
  std::vector<std::string> names = plan::find_option("film.layer")->choices;
  for (const paths::Layer& layer : layers.layers()) names.push_back(layer.name);
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw_error("film.layer", "there is no layer '{}'; there are {}", name, fmt::join(names, ", "));
}

std::vector<LayerStatus> layer_status(const Engine& engine, const film::Image& image,
                                      const stats::Ledger& ledger) {
  const auto components = film::Film::means(image);
  const vec3 all = std::accumulate(components.begin(), components.end(), vec3(0));
  const std::vector<vec3> means = film::Film::layer_means(image);
  std::vector<LayerStatus> list;
  for (size_t l = 0; l < std::min(means.size(), engine.layers().layers().size()); ++l) {
    const paths::Layer& layer = engine.layers().layers()[l];
    list.push_back({.name = layer.name,
                    .expression = layer.expression,
                    .lacks = paths::unknown_text(engine.layers_unknown()[l]),
                    .mean = means[l],
                    .share = luminance(all) > 0 ? double(luminance(means[l]) / luminance(all)) : 0,
                    .error = {},
                    .error_of_mean = {}});
    if (ledger.entries().empty() || engine.layers_unknown()[l] != 0) continue;
    const stats::Entry& last = ledger.entries().back();
    if (l < last.layers.size()) list.back().error = last.layers[l];
    if (l < last.of_mean.layers.size()) list.back().error_of_mean = last.of_mean.layers[l];
  }
  return list;
}

}  // namespace lucerna::session
