#pragma once
// Textures of held results, with the exposure and the tone curve of the live picture.
#include <functional>
#include <string>

#include "commands/comparing.h"
#include "texture_cache.h"

namespace lucerna::ui {

class ComparePictures {
 public:
  explicit ComparePictures(const commands::OpenScene& open) : open_(open) {}

  /// TextureCache::get; empty without a window, and all textures are 0 then.
  std::function<unsigned(const std::string& slot, const std::string& content, bool smooth,
                         const std::function<PictureBytes()>& make)>
      texture = {};

  unsigned held(const commands::HeldResult& held) const;
  /// Reduced to at most `width` pixels in a row.
  unsigned thumbnail(const commands::HeldResult& held, uint32_t width) const;
  /// The live picture minus the held result, in colours (film::difference_colors).
  unsigned difference(const commands::Comparing& compare, const commands::HeldResult& held) const;

 private:
  /// Identifies the present exposure and tone curve.
  std::string display() const;
  std::vector<uint8_t> displayed(const session::HeldPicture& picture) const;

  const commands::OpenScene& open_;
};

/// A picture in which each pixel is the mean of a square of at least `width` / picture.width; at most `width`
/// pixels in a row, 1 at least.
session::HeldPicture reduced(const session::HeldPicture& picture, uint32_t width);

}  // namespace lucerna::ui
