#pragma once
// Matrices of glTF nodes, in double precision.
#include <glm/gtc/quaternion.hpp>

#include "base/math.h"

namespace lucerna::scene {

/// Translation after rotation (unit) after scale.
inline glm::dmat4 node_matrix(const glm::dvec3& t, const glm::dquat& r, const glm::dvec3& s) {
  const glm::dmat3 rotation = glm::mat3_cast(r);
  return glm::dmat4(glm::dvec4(rotation[0] * s.x, 0), glm::dvec4(rotation[1] * s.y, 0),
                    glm::dvec4(rotation[2] * s.z, 0), glm::dvec4(t, 1));
}

/// An axis of a matrix of rank 2 or 3, unit; where it has no length, what the two others give.
inline glm::dvec3 axis(const glm::dmat4& m, int i) {
  const glm::dvec3 column(m[i]);
  const glm::dvec3 across = glm::cross(glm::dvec3(m[(i + 1) % 3]), glm::dvec3(m[(i + 2) % 3]));
  return glm::normalize(glm::length(column) > 0 ? column : across);
}

}  // namespace lucerna::scene
