#pragma once
// Runs another lucerna for the bench, in a separate process.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lucerna::bench {

struct ProgramHooks {
  std::function<bool()> interrupted;      ///< queried about twenty times a second; true ends the program
  std::function<void(double)> waiting{};  ///< called at the same rate, with the seconds since its start
};

struct ProgramResult {
  bool interrupted = false;  ///< it was ended; the other fields are not valid
  int status = 0;            ///< exit status, or 128 + the signal that ended it
  std::string text;          ///< its standard output and error
  /// The last line of `text` that is not empty: the reason of a failure.
  std::string last_line() const;
};

/// Runs a program with arguments and waits for it. It has no input, is not in the terminal's process group
/// (Ctrl-C ends the bench, which ends it), and does not outlive the bench. When `interrupted`, it gets
/// SIGTERM, and SIGKILL two seconds later. Throws Error located at `program` if it cannot be started.
ProgramResult run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const ProgramHooks& hooks);

}  // namespace lucerna::bench
