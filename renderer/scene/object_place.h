#pragma once
// Where an object was put by hand, relative to where its file has it.
#include "scene/scene.h"

namespace lucerna::scene {

/// The object is scaled along its own axes and turned, both about the middle of its box, then moved.
struct ObjectPlace {
  vec3 moved{0};   ///< metres
  vec3 turned{0};  ///< degrees about x, y (up) and z: about z first, y last
  vec3 scaled{1};  ///< factors along its axes; negative mirrors
  bool hidden = false;
  bool operator==(const ObjectPlace&) const = default;
};
/// Smallest and largest absolute factor, and the largest distance along an axis [m].
inline constexpr float k_least_factor = 1e-4f, k_most_factor = 1e4f, k_most_way = 1e7f;

/// The mesh's box in its own space; empty without vertices.
Box box_of(const Mesh& mesh);
/// Middle of the box in the world.
vec3 middle_of(const Box& box, const mat4& to_world);
/// The matrix of an object that its file places by `loaded`; exactly that if it is not moved, turned or
/// scaled. `box`: of its mesh.
mat4 placed(const mat4& loaded, const Box& box, const ObjectPlace& place);

glm::dmat3 rotation_of(const vec3& turned);
/// Angles [degrees] as in ObjectPlace of a rotation: of all that give it, the nearest to `near`.
vec3 angles_of(const glm::dmat3& rotation, const vec3& near);

/// Throws Error, located at the object's name: a number is not finite, a factor is 0 or out of range.
void check_range(const ObjectPlace& place, const std::string& name);
/// Throws Error, located at the object's name: the matrix is not finite or cannot be inverted, or puts its
/// box beyond k_max_coordinate.
void check_range(const Instance& instance, const Box& box);

}  // namespace lucerna::scene
