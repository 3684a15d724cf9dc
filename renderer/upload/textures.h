#pragma once
// Textures -> buckets of equal size and format, each a texture array on the device.
#include <map>
#include <vector>

#include "scene/scene.h"
#include "upload/flatten.h"

namespace lucerna::upload {

/// Where each texture went.
struct TextureMap {
  std::vector<uint32_t>
      place;  ///< by texture id: layer | bucket << 11 | wraps | nearest, as shaders/shared/scene.h
  /// Bits of a use, with its UV set; 0 for no texture.
  uint32_t bits(const scene::TextureUse& use) const;
};

/// Textures of exactly one size and format share a bucket, unresampled. When there would be more than
/// k_max_buckets, the smallest are scaled up (bilinearly, never down) to the next larger kind until they fit.
/// Throws Error when a bucket would exceed 2048 layers.
TextureMap pack_textures(const scene::Scene& scene, std::vector<Bucket>& buckets);

/// A texel as the shader would read it at uv (before the use's transform), nearest, linear colour. Host side,
/// for estimates.
vec3 read_texture(const scene::Scene& scene, const scene::TextureUse& use, vec2 uv);

}  // namespace lucerna::upload
