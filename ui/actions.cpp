#include "actions.h"

#include <imgui_internal.h>

#include <utility>

#include "base/log.h"

namespace lucerna::ui {

void Actions::act_line(const std::string& line) {
  // A change at the moment of a press belongs to the drag that begins there.
  if (gesture_ == 0 && ImGui::GetActiveID() != 0) follow_gesture();
  try {
    work_.run(line, gesture_);
  } catch (const std::exception& error) {
    log::error("{}", error.what());
  }
  wake();
}

void Actions::cancel_gesture() {
  work_.history.cancel(gesture_);
  wake();
}

void Actions::act_in(uint64_t gesture, const std::string& line) {
  const uint64_t held = std::exchange(gesture_, gesture);
  act_line(line);
  gesture_ = held;
}

void Actions::follow_gesture() {
  const unsigned held = ImGui::GetActiveID();
  const bool flying = flight_.moving();
  if (held != held_ || flying != flying_) gesture_ = held != 0 || flying ? ++gestures_ : 0;
  held_ = held, flying_ = flying;
}

}  // namespace lucerna::ui
