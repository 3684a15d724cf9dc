#pragma once
// The texts of the last frame, by the panel that shows them, for 'expect text'. The controls note them while
// a script asks for it.
#include <string>
#include <utility>
#include <vector>

namespace lucerna::ui {

/// Names of the parts of the window.
extern const std::vector<std::string> k_parts;

class ShownLines {
 public:
  static ShownLines& instance();
  /// Whether texts are noted from the next frame on.
  void record(bool on) { recording_ = on; }
  /// Begins a frame: its texts replace those of the last one.
  void begin_frame();
  /// Notes a text of the current ImGui window. Elided texts are noted in full.
  void note(const std::string& text);
  /// Texts of one of k_parts, in the order of drawing; "": of all.
  std::vector<std::string> lines(const std::string& part) const;
  /// Number of frames recorded so far.
  uint64_t frames() const { return frames_; }

 private:
  bool recording_ = false;
  uint64_t frames_ = 0;
  std::vector<std::pair<std::string, std::string>> lines_;  ///< part and text
};

}  // namespace lucerna::ui
