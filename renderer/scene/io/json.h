#pragma once
// A JSON value with its location, for messages.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/math.h"

namespace lucerna::scene {

/// A view of one value in a document that outlives it. `file` is the document's name in messages, `path` the
/// location inside it ("meshes[3].primitives[0]"). All readers throw a located Error if the value has another
/// type.
class Item {
 public:
  Item(const std::string& file, const nlohmann::json& value, std::string path = {})
      : file_(&file), value_(&value), path_(std::move(path)) {}

  const nlohmann::json& json() const { return *value_; }
  const std::string& path() const { return path_; }
  /// "file: path", for Error's first argument.
  std::string where() const { return path_.empty() ? *file_ : *file_ + ": " + path_; }
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw Error(where(), fmt::format(format, std::forward<Args>(args)...));
  }

  /// Checks that this is an object (array) and gives it back.
  const Item& object() const;
  const Item& array() const;
  /// Number of elements; this must be an array.
  size_t size() const { return array().json().size(); }

  /// The member, or nothing; this must be an object.
  std::optional<Item> find(const char* key) const;
  /// The member, which must exist.
  Item at(const char* key) const;
  /// The element; `index` must be below size().
  Item at(size_t index) const;

  double number() const;
  bool boolean() const;
  const std::string& text() const;
  /// A whole number in lo..hi.
  int64_t integer(int64_t lo, int64_t hi) const;
  /// An index below `size` into the array called `what`.
  uint32_t index(size_t size, const char* what) const;
  vec3 rgb() const;  ///< three numbers

  double number(const char* key, double fallback) const;
  bool boolean(const char* key, bool fallback) const;
  std::string text(const char* key, const std::string& fallback) const;
  int64_t integer(const char* key, int64_t fallback, int64_t lo, int64_t hi) const;

 private:
  const std::string* file_;
  const nlohmann::json* value_;
  std::string path_;
};

/// Parses JSON; `file` is for messages. Throws an Error with the line; nesting deeper than 256 is refused.
nlohmann::json parse_json(const std::string& file, const char* begin, const char* end);

}  // namespace lucerna::scene
