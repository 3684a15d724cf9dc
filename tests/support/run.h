#pragma once
// Runs the program, for tests of the command line.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

namespace lucerna::test {

struct Run {
  int status;       ///< exit status, or 128 + the signal that ended it
  std::string out;  ///< standard output and error, in order
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

/// Runs the program with arguments; `wrapper` is put in front of it ("timeout 5").
inline Run run(const std::string& arguments, const std::string& wrapper = "") {
  return run_command(wrapper + " " + LUCERNA_BINARY + " " + arguments);
}

/// The running program; the destructor kills it unless it has ended.
class Running {
 public:
  explicit Running(const std::string& arguments) {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ == 0) {
      dup2(ends[1], 1), dup2(ends[1], 2);
      close(ends[0]), close(ends[1]);
      // Tests started in the background or by nohup have these signals ignored, and so would the program.
      for (const int ignored : {SIGINT, SIGHUP, SIGPIPE}) signal(ignored, SIG_DFL);
      execl("/bin/sh", "sh", "-c", (std::string("exec ") + LUCERNA_BINARY + " " + arguments).c_str(),
            nullptr);
      _exit(127);
    }
    close(ends[1]);
    from_ = ends[0];
  }
  ~Running() {
    if (pid_ > 0) kill(pid_, SIGKILL), waitpid(pid_, nullptr, 0);
    close(from_);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// Waits without limit until it has printed this text; false: it has ended without.
  bool says(const std::string& text) {
    while (out_.find(text) == std::string::npos)
      if (!read_some()) return false;
    return true;
  }
  void send(int signal) const { kill(pid_, signal); }
  /// Closes the reading end of its output.
  void stop_reading() { close(from_), from_ = -1; }
  Run finish() {
    while (read_some()) {
    }
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), out_};
  }

 private:
  bool read_some() {
    char buffer[512];
    const ssize_t n = from_ < 0 ? 0 : read(from_, buffer, sizeof buffer);
    if (n > 0) out_.append(buffer, size_t(n));
    return n > 0;
  }
  pid_t pid_ = -1;
  int from_ = -1;
  std::string out_;
};

}  // namespace lucerna::test
