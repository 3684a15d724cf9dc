#pragma once
// Textures of pictures that change now and then, by what they show.
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lucerna::ui {

class Window;

struct PictureBytes {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

class TextureCache {
 public:
  explicit TextureCache(Window& window) : window_(window) {}

  /// OpenGL name of the texture in a slot. `make` is called, and the texture replaced, if `content` is not
  /// that of the last call. 0 if make() returns no pixels.
  unsigned get(const std::string& slot, const std::string& content, bool smooth,
               const std::function<PictureBytes()>& make);
  /// Call after each drawn frame, when no draw list refers to textures: drops those that were not used in it,
  /// and replaced ones.
  void end_frame();

 private:
  struct Slot {
    std::string content;
    unsigned texture = 0;
    bool used = false;
  };
  Window& window_;
  std::map<std::string, Slot> slots_;
  std::vector<unsigned> replaced_;
};

}  // namespace lucerna::ui
