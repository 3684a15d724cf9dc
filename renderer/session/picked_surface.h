#pragma once
// How a picked surface reflects: its normal and the texels of its material there.
#include "session/pick.h"

namespace lucerna::session {

/// The nearest texel, as stored but for wrapping: sRGB colours are linearized. 1 without a texture, image or
/// finite coordinates.
vec4 texel_at(const scene::Scene& scene, const scene::TextureUse& use, const vec2& uv);

struct PickedSurface {
  vec3 normal{0};       ///< interpolated, unit, on the side of Picked::normal; without normal maps
  vec3 base_color{1};   ///< with its texture and vertex colours
  float metallic = 0;   ///< with their texture
  float roughness = 1;  ///< likewise, perceptual
  float clearcoat = 0;  ///< with its texture
  float coat_roughness = 0;
};
PickedSurface surface_at(const scene::Scene& scene, const Picked& picked);

}  // namespace lucerna::session
