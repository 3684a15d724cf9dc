#pragma once
// Progress of the long benches.
#include <unistd.h>

#include <cstdio>
#include <string>

#include "bench/html.h"
#include "bench/runner.h"

namespace lucerna::app {

/// A line that is overwritten on a terminal; otherwise one line per render.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(2)) {}
  void show(const bench::Status& s) {
    if (quiet_ || (!terminal_ && s.step == step_)) return;
    step_ = s.step;
    const std::string left = s.left_s ? ", about " + bench::seconds_text(*s.left_s) + " left" : "";
    if (terminal_)
      std::fprintf(stderr, "\r\033[K%zu of %zu  %s  %3.0f %%%s", s.step, s.steps, s.what.c_str(),
                   100 * s.fraction, left.c_str());
    else
      std::fprintf(stderr, "%zu of %zu  %s%s\n", s.step, s.steps, s.what.c_str(), left.c_str());
    std::fflush(stderr);
  }
  void message(const std::string& line) {
    clear();
    std::fprintf(stderr, "lucerna: %s\n", line.c_str());
  }
  void clear() const {
    if (terminal_ && !quiet_ && step_ > 0) std::fprintf(stderr, "\r\033[K");
  }

 private:
  bool quiet_, terminal_;
  size_t step_ = 0;
};

}  // namespace lucerna::app
