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

}  // namespace lucerna::scene
