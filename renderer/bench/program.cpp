#include "bench/program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/timer.h"

namespace lucerna::bench {
namespace {

constexpr int k_poll_ms = 50;
constexpr double k_patience_s = 2;
constexpr int k_not_started = 127;

/// In the child process: only calls that are safe after fork() in a program with threads.
[[noreturn]] void become(const char* program, char* const* arguments, int output) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int each : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) signal(each, SIG_DFL);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, 0);
  dup2(output, 1), dup2(output, 2);
  execv(program, arguments);
  const char* const why = strerror(errno);
  const ssize_t ignored = write(2, why, strlen(why));
  (void)ignored;
  _exit(k_not_started);
}

}  // namespace

std::string ProgramResult::last_line() const {
  size_t end = text.size();
  while (end > 0 && (text[end - 1] == '\n' || text[end - 1] == '\r')) --end;
  const size_t before = end == 0 ? std::string::npos : text.find_last_of("\n\r", end - 1);
  const size_t begin = before == std::string::npos ? 0 : before + 1;
  return text.substr(begin, end - begin);
}

ProgramResult run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const ProgramHooks& hooks) {
  const std::string where = program.string();
  if (access(where.c_str(), X_OK) != 0) throw_error(where, "cannot be run: {}", std::strerror(errno));
  std::vector<std::string> words{where};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw_error(where, "cannot be run: {}", std::strerror(errno));
  const pid_t child = fork();
  if (child == 0) become(where.c_str(), pointers.data(), ends[1]);
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    throw_error(where, "cannot be run: {}", std::strerror(errno));
  }

  ProgramResult result;
  const Timer timer;
  double end_requested_s = 0;
  for (bool open = true; open;) {
    pollfd from{ends[0], POLLIN, 0};
    if (poll(&from, 1, k_poll_ms) > 0) {
      char buffer[4096];
      const ssize_t n = read(ends[0], buffer, sizeof buffer);
      if (n > 0) result.text.append(buffer, size_t(n));
      open = n > 0 || (n < 0 && errno == EINTR);
    }
    if (hooks.waiting) hooks.waiting(timer.seconds());
    if (!result.interrupted && hooks.interrupted && hooks.interrupted()) {
      result.interrupted = true, end_requested_s = timer.seconds();
      kill(child, SIGTERM);
    }
    if (result.interrupted && timer.seconds() > end_requested_s + k_patience_s) kill(child, SIGKILL);
  }
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (!result.interrupted && result.status == k_not_started)
    throw_error(where, "cannot be run: {}", result.last_line());
  return result;
}

}  // namespace lucerna::bench
