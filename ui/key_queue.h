#pragma once
// Order of keys and text that arrive between two frames.
#include <cstddef>
#include <optional>
#include <vector>

namespace lucerna::ui {

/// Splits the keys and characters that arrive between two frames over as many frames as it takes to keep
/// their order and each key's modifiers: ImGui knows one state of the modifiers in a frame, and ignores text
/// while Ctrl is down.
class KeyQueue {
 public:
  /// A key was pressed. `mods`: GLFW's modifier bits at that moment; `text`: characters that had arrived
  /// since the last frame (frames of next() included) before it.
  void press(int key, int mods, size_t text);
  bool empty() const { return keys_.empty(); }

  struct Frame {
    std::vector<int> keys;    ///< down in this frame, even if they are released already
    std::optional<int> mods;  ///< modifier bits of this frame; nullopt: those that are held now
    size_t text = 0;          ///< characters for this frame; the others are for later frames
    std::vector<int> later;   ///< keys of later frames
  };
  /// The next frame, of `text` characters that have arrived.
  Frame next(size_t text);

 private:
  struct Key {
    int key, mods;
    size_t text;
  };
  std::vector<Key> keys_;
};

}  // namespace lucerna::ui
