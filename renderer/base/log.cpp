#include "base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <map>
#include <mutex>

namespace lucerna::log {
namespace {

struct State {
  std::mutex mutex;
  std::map<int, std::function<void(Level, const std::string&)>> listeners;
  int next_token = 1;
  std::shared_ptr<spdlog::logger> logger;
  State() {
    logger =
        std::make_shared<spdlog::logger>("lucerna", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    logger->set_pattern("lucerna: %^%l%$: %v");
    logger->set_level(spdlog::level::warn);
  }
};

State& state() {
  static State s;
  return s;
}

spdlog::level::level_enum to_spdlog(Level level) {
  switch (level) {
    case Level::debug:
      return spdlog::level::debug;
    case Level::info:
      return spdlog::level::info;
    case Level::warning:
      return spdlog::level::warn;
    case Level::error:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

}  // namespace

void set_console_level(Level level) { state().logger->set_level(to_spdlog(level)); }

int add_listener(std::function<void(Level, const std::string&)> listener) {
  std::lock_guard lock(state().mutex);
  const int token = state().next_token++;
  state().listeners.emplace(token, std::move(listener));
  return token;
}

void remove_listener(int token) {
  std::lock_guard lock(state().mutex);
  state().listeners.erase(token);
}

void write(Level level, const std::string& line) {
  state().logger->log(to_spdlog(level), "{}", line);
  std::lock_guard lock(state().mutex);
  for (const auto& [token, listener] : state().listeners) listener(level, line);
}

}  // namespace lucerna::log
