#pragma once
// Layers by path expressions (film.layers) of a picture, for display and statistics.
#include <string>
#include <vector>

#include "base/math.h"

namespace lucerna::film {
struct Image;
}

namespace lucerna::session {

class Engine;

struct LayerStatus {
  std::string name, expression;
  std::string lacks;  ///< components of whose light it has an unknown part, for display; "": it is complete
  vec3 mean{0};       ///< mean radiance
  double share = 0;   ///< of the mean luminance of the picture; layers may overlap
  bool operator==(const LayerStatus&) const = default;
};

/// In the setting's order. `image`: of the engine's picture.
std::vector<LayerStatus> layer_status(const Engine& engine, const film::Image& image);

}  // namespace lucerna::session
