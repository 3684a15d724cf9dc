#pragma once
// Runs a program as a person would, for tests of the command line.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

namespace lucerna::test {

struct Run {
  int status;       ///< exit status, or 128 + the signal that ended it
  std::string out;  ///< standard output and error, as they came
};

inline Run run_command(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  REQUIRE(pipe);
  std::string out;
  char buffer[512];
  while (size_t n = fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, n);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), out};
}

/// The program with arguments; `wrapper` goes in front of it ("timeout 5").
inline Run run(const std::string& arguments, const std::string& wrapper = "") {
  return run_command(wrapper + " " + LUCERNA_BINARY + " " + arguments);
}

}  // namespace lucerna::test
