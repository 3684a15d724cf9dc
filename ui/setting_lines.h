#pragma once
#include <string>
#include <vector>

#include "commands/registry.h"
#include "commands/text.h"
#include "plan/settings.h"

namespace lucerna::ui {

/// Settings of the command line, KEY=VALUE each, as commands. Throws Error.
inline std::vector<std::string> setting_lines(const commands::Registry& registry,
                                              const std::vector<std::string>& changes) {
  std::vector<std::string> lines;
  for (const std::string& change : changes) {
    const auto [key, value] = split_change(change, "--set");
    lines.push_back(commands::line("set", key, value));
    registry.parse(lines.back(), "--set");
  }
  return lines;
}

}  // namespace lucerna::ui
