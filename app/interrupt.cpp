#include "app/interrupt.h"

#include <signal.h>

#include <array>
#include <atomic>

namespace lucerna::app {
namespace {

std::atomic<int> came{0};
static_assert(std::atomic<int>::is_always_lock_free, "set in a signal handler");

constexpr std::array<int, 4> k_signals{SIGINT, SIGTERM, SIGHUP, SIGPIPE};
std::array<struct sigaction, k_signals.size()> before{};

}  // namespace

Interrupt::Interrupt() {
  came = 0;
  for (size_t i = 0; i < k_signals.size(); ++i) {
    sigaction(k_signals[i], nullptr, &before[i]);
    if (k_signals[i] == SIGHUP && before[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = [](int signal) {
      came = signal;
      // The next signal has its default effect.
      for (const int each : {SIGINT, SIGTERM, SIGHUP}) ::signal(each, SIG_DFL);
    };
    if (k_signals[i] == SIGPIPE) action.sa_handler = SIG_IGN;
    sigaction(k_signals[i], &action, nullptr);
  }
}

Interrupt::~Interrupt() {
  for (size_t i = 0; i < k_signals.size(); ++i) sigaction(k_signals[i], &before[i], nullptr);
}

int Interrupt::signal() { return came; }
int Interrupt::status() { return 128 + came; }

}  // namespace lucerna::app
