#include "key_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace lucerna::ui {
namespace {

constexpr int k_all_mods = GLFW_MOD_CONTROL | GLFW_MOD_SHIFT | GLFW_MOD_ALT | GLFW_MOD_SUPER;

bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

/// True if ImGui ignores text under these modifiers. Ctrl and Alt together are AltGr, which types.
bool ignores_text(int mods) { return (mods & GLFW_MOD_CONTROL) && !(mods & GLFW_MOD_ALT); }

}  // namespace

void KeyQueue::press(int key, int mods, size_t text) {
  if (key >= 0 && !is_modifier(key)) keys_.push_back({key, mods & k_all_mods, text});
}

KeyQueue::Frame KeyQueue::next(size_t text) {
  Frame frame{.keys = {}, .mods = {}, .text = text, .later = {}};
  if (keys_.empty()) return frame;
  const Key first = keys_.front();
  auto end = keys_.begin();
  if (ignores_text(first.mods) && first.text > 0) {
    // The text before a shortcut has its own frame.
    frame.text = std::min(text, first.text), frame.mods = 0;
  } else {
    end = std::find_if(keys_.begin(), keys_.end(), [&](const Key& k) { return k.mods != first.mods; });
    frame.mods = first.mods;
    if (ignores_text(first.mods))
      frame.text = 0;
    else if (end != keys_.end())
      frame.text = std::min(text, end->text);
  }
  for (auto k = keys_.begin(); k != end; ++k) frame.keys.push_back(k->key);
  keys_.erase(keys_.begin(), end);
  for (Key& k : keys_) frame.later.push_back(k.key), k.text -= std::min(k.text, frame.text);
  return frame;
}

}  // namespace lucerna::ui
