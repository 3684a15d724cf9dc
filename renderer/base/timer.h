#pragma once
#include <chrono>

namespace lucerna {

/// Wall-clock stopwatch, started at construction.
class Timer {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  double milliseconds() const { return 1e3 * seconds(); }
  void restart() { start_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Accumulates wall time while running; starts stopped at 0.
class Stopwatch {
 public:
  void go() {
    if (!going_) since_.restart();
    going_ = true;
  }
  void stop() { before_ = seconds(), going_ = false; }
  void reset() { before_ = 0, going_ = false; }
  double seconds() const { return before_ + (going_ ? since_.seconds() : 0); }

 private:
  double before_ = 0;
  bool going_ = false;
  Timer since_;
};

/// CPU time of this process [s], all threads, user and system.
double cpu_seconds();

}  // namespace lucerna
