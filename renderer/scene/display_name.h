#pragma once
#include <fmt/format.h>

#include <string>

namespace lucerna::scene {

/// The name that lists and overlays show: the scene's, or the kind and number from 1, "Light 3".
inline std::string display_name(const std::string& name, const char* kind, size_t index) {
  return name.empty() ? fmt::format("{} {}", kind, index + 1) : name;
}

}  // namespace lucerna::scene
