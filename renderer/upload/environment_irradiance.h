#pragma once
// Light of the whole, unoccluded environment on a surface, by the surface's normal: for shadow catchers
// (shaders/lib/catcher.glsl).
#include <span>
#include <vector>

#include "base/math.h"

namespace lucerna::upload {

/// Irradiance [W/m^2 per unit of the texels' radiance] over k_irradiance_width x k_irradiance_height normals,
/// those of a latitude-longitude map's texel centres like the environment's own (scene::Environment), not
/// rotated. `texels`: radiance, width x height. Within half a percent, but for single texels, whose light is
/// exact.
std::vector<vec4> environment_irradiance(std::span<const vec3> texels, uint32_t width, uint32_t height);

}  // namespace lucerna::upload
