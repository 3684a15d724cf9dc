#pragma once
// What the cards over the picture show: notices, errors, the first steps, and the command in progress.
#include <cstdint>
#include <string>
#include <vector>

#include "actions.h"

namespace lucerna::ui {

struct CardsView {
  explicit CardsView(Actions& a) : actions(a) {}

  Actions& actions;
  /// A sentence over the picture that disappears by itself.
  struct {
    std::string text;
    double until = 0;
    bool of_click = false;  ///< says what the next click does, and stays until then
  } note;
  /// Shows such a sentence.
  void notice(const std::string& text, double seconds = 6) {
    note = {text, actions.now() + seconds, false};
    actions.wake(3);
  }
  /// Says what the next click in the picture does, until end_click_notice().
  void click_notice(const std::string& text) {
    note = {text, 1e300, true};
    actions.wake(3);
  }
  void end_click_notice() {
    if (note.of_click) note = {};
  }
  std::vector<std::string> errors;  ///< the strip's, newest last
  bool welcome = false;             ///< the first steps are shown
  /// The command in progress and its start. Once a command is done and not shown yet, the first picture of it
  /// is in progress.
  struct {
    uint64_t command = 0;  ///< its number in the session; 0: none
    bool done = false;     ///< done, but no picture shows it yet
    double since = 0;
    std::string text;  ///< its line; "" for none
  } busy;
  /// Duration of the command in progress [s]; 0 while it is too short to show.
  double busy_seconds(double now) const {
    const double seconds = busy.command != 0 ? now - busy.since : 0;
    return seconds > 0.5 ? seconds : 0;
  }
};

}  // namespace lucerna::ui
