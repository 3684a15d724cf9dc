#pragma once
// Signals that ask a long verb to end: what there is is written first.

namespace lucerna::app {

/// While one lives, the first of Ctrl-C (SIGINT), SIGTERM and SIGHUP ends nothing and is told by signal(); a
/// second one ends the program at once. SIGHUP stays ignored where it was (nohup). A reader of the output
/// that has gone (SIGPIPE) ends nothing. One at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// The signal that came, or 0.
  static int signal();
  /// The exit status of a program that it ended: 128 + signal().
  static int status();
};

}  // namespace lucerna::app
