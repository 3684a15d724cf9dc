#include "texture_cache.h"

#include <utility>

#include "window.h"

namespace lucerna::ui {

unsigned TextureCache::get(const std::string& slot, const std::string& content, bool smooth,
                           const std::function<PictureBytes()>& make) {
  Slot& s = slots_[slot];
  s.used = true;
  if (s.content == content) return s.texture;
  if (s.texture) replaced_.push_back(std::exchange(s.texture, 0));
  s.content = content;
  const PictureBytes bytes = make();
  if (!bytes.rgba.empty()) s.texture = window_.make_texture(bytes.rgba, bytes.width, bytes.height, smooth);
  return s.texture;
}

void TextureCache::end_frame() {
  for (const unsigned texture : std::exchange(replaced_, {})) window_.drop_texture(texture);
  for (auto at = slots_.begin(); at != slots_.end();) {
    Slot& slot = at->second;
    if (std::exchange(slot.used, false)) {
      ++at;
      continue;
    }
    if (slot.texture) window_.drop_texture(slot.texture);
    at = slots_.erase(at);
  }
}

}  // namespace lucerna::ui
