#include "scene/io/json.h"

#include <algorithm>
#include <cmath>

namespace lucerna::scene {
namespace {

constexpr int k_max_depth = 256;

// The parser itself does not recurse, but code that walks a document does: so depth is bounded beforehand.
bool too_deep(const char* begin, const char* end) {
  int depth = 0;
  bool in_string = false;
  for (const char* c = begin; c != end; ++c) {
    if (in_string) {
      if (*c == '\\' && c + 1 != end) {
        ++c;
      } else if (*c == '"') {
        in_string = false;
      }
    } else if (*c == '"') {
      in_string = true;
    } else if (*c == '[' || *c == '{') {
      if (++depth > k_max_depth) return true;
    } else if (*c == ']' || *c == '}') {
      --depth;
    }
  }
  return false;
}

}  // namespace

nlohmann::json parse_json(const std::string& file, const char* begin, const char* end) {
  if (too_deep(begin, end)) throw_error(file, "JSON is nested more than {} levels deep", k_max_depth);
  try {
    return nlohmann::json::parse(begin, end);
  } catch (const nlohmann::json::parse_error& error) {
    const auto offset = std::min(static_cast<std::ptrdiff_t>(error.byte), end - begin);
    const auto line = 1 + std::count(begin, begin + offset, '\n');
    std::string text =
        error.what();  // "[json.exception.parse_error.101] parse error at ...: syntax error ..."
    const size_t start = text.find("] ");
    throw_error(fmt::format("{}:{}", file, line), "not valid JSON: {}",
                start == std::string::npos ? text : text.substr(start + 2));
  } catch (const nlohmann::json::exception& error) {
    throw_error(file, "not valid JSON: {}", error.what());
  }
}

const Item& Item::object() const {
  if (!value_->is_object()) fail("expected an object, found {}", value_->type_name());
  return *this;
}

const Item& Item::array() const {
  if (!value_->is_array()) fail("expected an array, found {}", value_->type_name());
  return *this;
}

std::optional<Item> Item::find(const char* key) const {
  object();
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return Item(*file_, *found, path_.empty() ? std::string(key) : path_ + "." + key);
}

Item Item::at(const char* key) const {
  std::optional<Item> item = find(key);
  if (!item) fail("'{}' is missing", key);
  return *item;
}

Item Item::at(size_t index) const {
  return Item(*file_, (*value_)[index], fmt::format("{}[{}]", path_, index));
}

double Item::number() const {
  if (!value_->is_number()) fail("expected a number, found {}", value_->type_name());
  const double value = value_->get<double>();
  if (!std::isfinite(value) || std::abs(value) > 3.0e38) fail("{} is beyond the range of numbers", value);
  return value;
}

bool Item::boolean() const {
  if (!value_->is_boolean()) fail("expected true or false, found {}", value_->type_name());
  return value_->get<bool>();
}

const std::string& Item::text() const {
  if (!value_->is_string()) fail("expected a string, found {}", value_->type_name());
  return value_->get_ref<const std::string&>();
}

int64_t Item::integer(int64_t lo, int64_t hi) const {
  const double value = number();
  if (value != std::floor(value)) fail("expected a whole number, found {}", value);
  if (value < static_cast<double>(lo) || value > static_cast<double>(hi))
    fail("{} is outside {} to {}", value, lo, hi);
  return static_cast<int64_t>(value);
}

uint32_t Item::index(size_t size, const char* what) const {
  const int64_t value = integer(-(int64_t{1} << 53), int64_t{1} << 53);
  if (value < 0 || static_cast<uint64_t>(value) >= size)
    fail("{} is not an index of {} (there are {})", value, what, size);
  return static_cast<uint32_t>(value);
}

vec3 Item::rgb() const {
  if (size() != 3) fail("expected 3 numbers, found {}", size());
  return vec3(at(size_t{0}).number(), at(size_t{1}).number(), at(size_t{2}).number());
}

double Item::number(const char* key, double fallback) const {
  const auto item = find(key);
  return item ? item->number() : fallback;
}

bool Item::boolean(const char* key, bool fallback) const {
  const auto item = find(key);
  return item ? item->boolean() : fallback;
}

std::string Item::text(const char* key, const std::string& fallback) const {
  const auto item = find(key);
  return item ? item->text() : fallback;
}

int64_t Item::integer(const char* key, int64_t fallback, int64_t lo, int64_t hi) const {
  const auto item = find(key);
  return item ? item->integer(lo, hi) : fallback;
}

}  // namespace lucerna::scene
