#pragma once
// Listens to the log.
#include <string>
#include <vector>

#include "base/log.h"

namespace lucerna::test {

/// What is logged as a warning or an error while it lives.
struct Complaints {
  std::vector<std::string> lines;
  int token = log::add_listener([this](log::Level level, const std::string& line) {
    if (level >= log::Level::warning) lines.push_back(line);
  });
  ~Complaints() { log::remove_listener(token); }
};

}  // namespace lucerna::test
