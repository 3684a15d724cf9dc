#pragma once
#include <cstdint>
#include <string>
#include <utility>

namespace lucerna::app {

/// Width and height of "WIDTHxHEIGHT" [pixels]. Throws Error located at --size.
std::pair<uint32_t, uint32_t> parse_size(const std::string& text);

}  // namespace lucerna::app
