#pragma once
// Runs another lucerna that renders for the bench, in a separate process.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lucerna::bench {

struct ProgramHooks {
  std::function<bool()> interrupted;      ///< queried about twenty times a second; true ends the program
  std::function<void(double)> waiting{};  ///< as often, with the seconds since its start
};

struct ProgramResult {
  bool interrupted = false;  ///< then it was ended, and the rest says nothing
  int status = 0;            ///< exit status, or 128 + the signal that ended it
  std::string text;          ///< its standard output and error, as they came
  /// The last line of `text` that is not empty: of a program that failed, why.
  std::string last_line() const;
};

/// Runs a program with arguments and waits for it. It has nothing to read, is no part of the terminal's group
/// (Ctrl-C ends the bench, which ends it), and does not outlive the bench. When `interrupted`, it gets
/// SIGTERM, and SIGKILL two seconds later. Throws Error located at `program` when it cannot be started.
ProgramResult run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const ProgramHooks& hooks);

}  // namespace lucerna::bench
