#pragma once
// Runs the commands of controls.
#include <functional>
#include <string>

#include "commands/workspace.h"

namespace lucerna::ui {

/// Everything done while one control is held, or during one flight, is one gesture: one undo step. Failures
/// go to the log and the error strip.
class Actions {
 public:
  /// `wake`: called after each line, with the number of frames to draw.
  Actions(commands::Workspace& work, const commands::Flight& flight, std::function<void(int)> wake)
      : work_(work), flight_(flight), wake_(std::move(wake)) {}
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;

  /// Runs a command with these words.
  template <class... A>
  void act(const std::string& command, const A&... words) {
    act_line(commands::line(command, words...));
  }
  void act_line(const std::string& line);
  /// Toggles a boolean setting.
  void toggle(const std::string& key) { act("set", key, work_.open.setting_on(key) ? "false" : "true"); }

  /// Reverts what the gesture of the held control has changed last, and forgets it.
  void cancel_gesture();

  double now() const { return work_.now; }  ///< seconds since the window opened
  /// Lets the window draw this number of frames.
  void wake(int frames = 2) { wake_(frames); }
  /// Determines the held control; call once per frame.
  void follow_gesture();
  /// A gesture that no control has, for act_in().
  uint64_t new_gesture() { return ++gestures_; }
  /// Runs a line as part of that gesture.
  void act_in(uint64_t gesture, const std::string& line);

 private:
  commands::Workspace& work_;
  const commands::Flight& flight_;
  std::function<void(int)> wake_;
  uint64_t gesture_ = 0;  ///< of the control that is held now; 0: none
  uint64_t gestures_ = 0;
  unsigned held_ = 0;  ///< id of the control that is held
  bool flying_ = false;
};

}  // namespace lucerna::ui
