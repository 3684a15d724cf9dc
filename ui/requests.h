#pragma once
// Requests of commands and scripts to the main loop.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lucerna::ui {

struct Requests {
  std::optional<int> status;  ///< exit status, if the program must end
  struct Shot {
    std::string file;     ///< "" for none
    int settle = 0;       ///< frames to draw before it is taken
    bool failed = false;  ///< the last one could not be written
  } shot;
  /// The window as drawn, for a script: requested while it has no pixels. Shot::settle applies.
  struct Grab {
    std::vector<uint8_t> rgba;  ///< top row first
    uint32_t width = 0, height = 0;
  };
  std::optional<Grab> grab;
  std::optional<std::pair<int, int>> size;  ///< window size wanted
  std::optional<float> scale;               ///< requested scale of text and controls
  /// Mouse and keys moved by a script.
  struct Input {
    float x = 0, y = 0;  ///< window pixels
    int button = -1;     ///< -1: the pointer moves; otherwise the button changes, where the pointer is
    bool down = false;
  };
  std::vector<Input> inputs;
  std::vector<std::pair<int, bool>> key_holds;   ///< GLFW keys that go down and stay, or come up
  float wheel = 0;                               ///< notches that it is turned
  std::vector<std::pair<int, int>> key_strokes;  ///< GLFW keys with their modifiers
  std::string keyboard;                          ///< text typed
  std::vector<std::string> drops;                ///< files that a script drops on the window
};

}  // namespace lucerna::ui
