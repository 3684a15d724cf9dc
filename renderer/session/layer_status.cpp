#include "session/layer_status.h"

#include <algorithm>
#include <numeric>

#include "session/engine.h"

namespace lucerna::session {

std::vector<LayerStatus> layer_status(const Engine& engine, const film::Image& image) {
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
                    .share = luminance(all) > 0 ? double(luminance(means[l]) / luminance(all)) : 0});
  }
  return list;
}

}  // namespace lucerna::session
