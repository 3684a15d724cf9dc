#pragma once
// Base64 (RFC 4648, section 4), for data URIs.
#include <cstdint>
#include <string>
#include <string_view>

namespace lucerna {

inline std::string base64(std::string_view bytes) {
  static constexpr char k_digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? k_digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace lucerna
