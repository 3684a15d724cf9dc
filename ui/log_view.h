#pragma once
// What the log panel shows: lines of the log, and the console under them.
#include <array>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "actions.h"
#include "base/log.h"

namespace lucerna::ui {

struct LogLine {
  log::Level level;
  double time;  ///< seconds since the window opened
  std::string text;
};

/// Receives log lines from any thread.
class LogInbox {
 public:
  LogInbox();
  ~LogInbox();
  LogInbox(const LogInbox&) = delete;
  LogInbox& operator=(const LogInbox&) = delete;
  std::vector<LogLine> take();

 private:
  std::mutex mutex_;
  std::vector<LogLine> lines_;
  int token_ = 0;
};

/// The line under the log.
struct Console {
  std::string text;
  std::vector<std::string> history;
  int at = -1;         ///< shown entry of the history, or -1
  bool focus = false;  ///< takes the keyboard in the next frame
  bool active = false;
};

struct LogView {
  explicit LogView(Actions& a) : actions(a) {}

  Actions& actions;
  /// Adds a line to the panel alone.
  void print(log::Level level, const std::string& text) {
    lines.push_back({level, actions.now(), text});
    actions.wake();
  }

  std::deque<LogLine> lines;
  bool follows = true;
  std::array<bool, 4> levels{false, true, true, true};  ///< shown ones
  Console console;
  std::vector<std::string> typed;  ///< lines typed at the console, for the runner
};

}  // namespace lucerna::ui
