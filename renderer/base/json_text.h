#pragma once
#include <string>

namespace lucerna {

/// Serializes a JSON value (nlohmann::json or ordered_json); `indent` -1: on one line. Bytes that are not
/// UTF-8 (possible in file names and names in scenes) become U+FFFD, whereas dump() throws. A test checks
/// that no other code calls dump().
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lucerna
