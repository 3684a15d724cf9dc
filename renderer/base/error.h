#pragma once
// The one error type that crosses module edges. An error always says where, what, and what to do.
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace lucerna {

/// Thrown by loading, options, device creation and output. `where` locates the cause (a file, "file:
/// element", an option's name); `what` states what is wrong and what was expected, in one line without a
/// final stop. `what()` is "where: what", or only "what" if `where` is empty.
class Error : public std::runtime_error {
 public:
  Error(std::string where, const std::string& what)
      : std::runtime_error(where.empty() ? what : where + ": " + what), where_(std::move(where)) {}
  const std::string& where() const { return where_; }

 private:
  std::string where_;
};

/// throw_error(where, "expected {} entries, found {}", a, b): formats and throws an Error.
template <class... Args>
[[noreturn]] void throw_error(std::string where, fmt::format_string<Args...> format, Args&&... args) {
  throw Error(std::move(where), fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace lucerna
