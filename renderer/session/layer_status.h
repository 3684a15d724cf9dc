#pragma once
// Layers by path expressions: the settings film.layers and film.layer, and a picture's layers for display and
// statistics.
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "paths/layers.h"
#include "plan/settings.h"
#include "stats/ledger.h"

namespace lucerna::film {
struct Image;
}

namespace lucerna::session {

class Engine;

/// The layers of film.layers. Throws Error located there.
paths::LayerSet layer_set(const paths::Automaton& automaton, const plan::Settings& settings);
/// Throws Error like layer_set().
void check_layers(const std::string& text);
/// Layers of that text; none if it cannot be read.
std::vector<paths::Layer> layers_in(const std::string& text);
/// Checks that film.layer names a layer. Throws Error located there.
void check_shown_layer(const paths::LayerSet& layers, const plan::Settings& settings);

struct LayerStatus {
  std::string name, expression;
  std::string lacks;  ///< components of whose light it has an unknown part, for display; "": it is complete
  vec3 mean{0};       ///< mean radiance
  double share = 0;   ///< of the mean luminance of the picture; layers may overlap
  /// Its noise, relative to the light of the whole picture, as seen and of the mean (stats::Entry::layers).
  /// Known after two samples a pixel, unless it lacks light.
  std::optional<double> error, error_of_mean;
  bool operator==(const LayerStatus&) const = default;
};

/// In the setting's order. `image`: of the engine's picture; `ledger`: of the same.
std::vector<LayerStatus> layer_status(const Engine& engine, const film::Image& image,
                                      const stats::Ledger& ledger);

}  // namespace lucerna::session
