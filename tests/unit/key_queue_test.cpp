// links: ui
// Keys and text that arrive between two frames keep their order and their modifiers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <catch2/catch.hpp>

#include "ui/key_queue.h"

namespace key_queue_tests {

using namespace lucerna;
using Keys = std::vector<int>;

TEST_CASE("without keys all text is for the frame, under the modifiers that are held") {
  ui::KeyQueue queue;
  const auto frame = queue.next(4);
  CHECK(frame.text == 4);
  CHECK(frame.keys.empty());
  CHECK(!frame.mods);
}

TEST_CASE("a shortcut keeps its modifiers, and text around it has its own frames") {
  ui::KeyQueue queue;
  queue.press(GLFW_KEY_LEFT_CONTROL, 0, 2);  // modifiers are no keys here
  queue.press(GLFW_KEY_A, GLFW_MOD_CONTROL, 2);
  queue.press(GLFW_KEY_ENTER, 0, 5);
  auto frame = queue.next(5);  // two characters came before the shortcut, three after it
  CHECK(frame.keys.empty());
  CHECK(frame.text == 2);
  CHECK(frame.mods == 0);
  CHECK(frame.later == Keys{GLFW_KEY_A, GLFW_KEY_ENTER});
  frame = queue.next(3);
  CHECK(frame.keys == Keys{GLFW_KEY_A});
  CHECK(frame.text == 0);
  CHECK(frame.mods == GLFW_MOD_CONTROL);
  frame = queue.next(3);
  CHECK(frame.keys == Keys{GLFW_KEY_ENTER});
  CHECK(frame.text == 3);
  CHECK(frame.mods == 0);
  CHECK(queue.empty());
}

TEST_CASE("keys under equal modifiers share a frame; AltGr types") {
  ui::KeyQueue queue;
  queue.press(GLFW_KEY_LEFT, GLFW_MOD_SHIFT, 0);
  queue.press(GLFW_KEY_UP, GLFW_MOD_SHIFT | GLFW_MOD_CAPS_LOCK, 0);
  queue.press(GLFW_KEY_Q, GLFW_MOD_CONTROL | GLFW_MOD_ALT, 0);
  CHECK(queue.next(1).keys == Keys{GLFW_KEY_LEFT, GLFW_KEY_UP});
  const auto frame = queue.next(1);
  CHECK(frame.keys == Keys{GLFW_KEY_Q});
  CHECK(frame.text == 1);
}

}  // namespace key_queue_tests
