#pragma once
// Mean of an emission texture over a triangle, for the selection probability of its light.
#include <array>
#include <map>
#include <vector>

#include "scene/scene.h"

namespace lucerna::upload {

/// Exact mean luminances of textures over triangles. Keeps the sums of each requested texture, a
/// double per texel; valid as long as the scene.
class TextureMeans {
 public:
  explicit TextureMeans(const scene::Scene& scene) : scene_(scene) {}
  /// Mean luminance of all texels that a read of the use, bilinear or nearest, within the triangle may touch:
  /// above 0 wherever one of them is. `uv`: the triangle's corners, before the use's transform. Not finite
  /// ones, and triangles across very many repeats, have the whole texture's mean. 1 where there is no
  /// texture.
  double over(const scene::TextureUse& use, const std::array<vec2, 3>& uv);

 private:
  struct Sums {
    std::vector<double> rows;  ///< width + 1 a row: of the texels before
    double mean = 0;
  };
  const Sums& sums_of(scene::Id texture);

  const scene::Scene& scene_;
  std::map<scene::Id, Sums> sums_;
};

}  // namespace lucerna::upload
