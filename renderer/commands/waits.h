#pragma once
// The conditions of the command 'wait'.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "commands/expectation.h"

namespace lucerna::commands {

class Workspace;

/// A parsed wait. done() is polled; it throws Error if the condition can never hold.
struct Wait {
  std::string condition;        ///< for messages
  std::optional<double> limit;  ///< seconds; none: the usual one
  std::function<bool()> done;
};

/// Reads "samples 64 within 30" and the like. `expectations`: for 'until'. Throws Error with the position of
/// the mistake.
Wait read_wait(Workspace& work, const Expectations& expectations, const std::string& text,
               const ExpectContext& context);

/// Suggestions for the next word.
std::vector<std::string> wait_suggestions(const std::vector<std::string>& before);

}  // namespace lucerna::commands
