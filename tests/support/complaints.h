#pragma once
// Records warnings and errors of the log.
#include <string>
#include <vector>

#include "base/log.h"

namespace lucerna::test {

/// Warnings and errors logged during its lifetime.
struct Complaints {
  std::vector<std::string> lines;
  int token = log::add_listener([this](log::Level level, const std::string& line) {
    if (level >= log::Level::warning) lines.push_back(line);
  });
  ~Complaints() { log::remove_listener(token); }
};

}  // namespace lucerna::test
