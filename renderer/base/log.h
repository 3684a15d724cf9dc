#pragma once
// Logging to standard error and to listeners (the window's Log panel). Thread-safe.
#include <fmt/format.h>

#include <functional>
#include <string>

namespace lucerna::log {

enum class Level { debug, info, warning, error };

/// Lines below this level are not printed on standard error (listeners receive all). Default: warning.
void set_console_level(Level level);
/// Calls `listener` for every line from now on, on the thread that logs. Returns a token for remove_listener.
int add_listener(std::function<void(Level, const std::string&)> listener);
void remove_listener(int token);
void write(Level level, const std::string& line);

template <class... A>
void debug(fmt::format_string<A...> f, A&&... a) {
  write(Level::debug, fmt::format(f, std::forward<A>(a)...));
}
template <class... A>
void info(fmt::format_string<A...> f, A&&... a) {
  write(Level::info, fmt::format(f, std::forward<A>(a)...));
}
template <class... A>
void warning(fmt::format_string<A...> f, A&&... a) {
  write(Level::warning, fmt::format(f, std::forward<A>(a)...));
}
template <class... A>
void error(fmt::format_string<A...> f, A&&... a) {
  write(Level::error, fmt::format(f, std::forward<A>(a)...));
}

}  // namespace lucerna::log
