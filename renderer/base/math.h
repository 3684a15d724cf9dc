#pragma once
// glm under our names, and the few constants that everyone needs. Right-handed, Y up, metres (as glTF).
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace lucerna {

using glm::ivec2;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr float k_pi = 3.14159265358979323846f;
inline constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// Rec.709 luminance of a linear colour.
inline float luminance(const vec3& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// Axis-aligned box; empty when lo > hi.
struct Box {
  vec3 lo{k_infinity};
  vec3 hi{-k_infinity};
  void grow(const vec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  void grow(const Box& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
  bool empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
  vec3 centre() const { return 0.5f * (lo + hi); }
  vec3 size() const { return empty() ? vec3(0) : hi - lo; }
  float radius() const { return 0.5f * glm::length(size()); }
};

}  // namespace lucerna
