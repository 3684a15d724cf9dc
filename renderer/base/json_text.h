#pragma once
#include <string>

namespace lucerna {

/// The text of a JSON value (nlohmann::json or ordered_json); `indent` -1: on one line. Bytes that are no
/// UTF-8, as names of files and of things in scenes may hold, become U+FFFD; dump() by itself throws at them.
/// A test checks that nothing else calls dump().
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lucerna
