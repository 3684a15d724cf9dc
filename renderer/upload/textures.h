#pragma once
// Texture pages. All 8-bit colour textures share the pages (layers) of one texture array, all 8-bit data
// textures another, float ones a third: a device without dynamic indexing of sampler arrays pays for each
// array that a read may access, whatever the textures' sizes. Texels are copied, never resampled.
#include <vector>

#include "scene/scene.h"
#include "upload/flatten.h"

namespace lucerna::upload {

/// Maximum bytes of a bucket; further pages of the same format are in another bucket.
inline constexpr uint64_t k_bucket_bytes = uint64_t(1) << 30;

/// Position of a texture on the pages.
struct TexturePlace {
  uint32_t bits = 0;  ///< layer | bucket << 11 | wraps | nearest | present (shaders/shared/scene.h)
  uint32_t bucket = 0;
  /// Lower left texel and size on the page, over the page's size: a texture coordinate t in [0, 1] is at
  /// rect.xy + t * rect.zw. A border of one texel, filled by the wrap mode, makes the hardware's bilinear
  /// filter exact up to the edge.
  vec4 rect{0};
  vec2 size{0};  ///< texels
};

struct TextureMap {
  std::vector<TexturePlace> place;  ///< by texture id
  /// Bits of a use, with its UV set; 0 for no texture.
  uint32_t bits(const scene::TextureUse& use) const;
};

/// Throws Error if there are more than k_max_buckets buckets or more than 2048 pages in one.
TextureMap pack_textures(const scene::Scene& scene, std::vector<Bucket>& buckets,
                         uint64_t bucket_bytes = k_bucket_bytes);

/// A texel's linear colour. Host side, for estimates.
vec3 read_texel(const scene::Scene& scene, scene::Id texture, uint32_t x, uint32_t y);

/// Linear colour of the nearest texel at uv (before the use's transform), as in shaders. Host side, for
/// estimates.
vec3 read_texture(const scene::Scene& scene, const scene::TextureUse& use, vec2 uv);

}  // namespace lucerna::upload
