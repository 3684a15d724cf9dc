#pragma once
// Signals that end a long verb after it has written its results.

namespace lucerna::app {

/// During the lifetime of an object the first Ctrl-C (SIGINT), SIGTERM or SIGHUP does not end the program but
/// is returned by signal(); a second one ends it immediately. An ignored SIGHUP stays ignored (nohup). A
/// closed output pipe (SIGPIPE) does not end the program. One object at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// The received signal, or 0.
  static int signal();
  /// The exit status after that signal: 128 + signal().
  static int status();
};

}  // namespace lucerna::app
