#pragma once
// The origin of a scene's coordinates. The renderer computes in single precision, whose steps grow with the
// distance from the origin: 8 mm at 100 km. So a scene far from the origin of its file is moved near it when
// it is loaded.
#include <glm/glm.hpp>
#include <span>

namespace lucerna::scene {

/// An object is far if it is more than this multiple of its radius away.
inline constexpr double k_far = 100;

/// Input of choose_origin() for a placed mesh, in the file's coordinates [m].
struct Extent {
  glm::dvec3 centre{0};
  double radius = 0;  ///< above 0
  double weight = 1;  ///< weight of its vote
};

/// The new origin for an object: near its centre, in round decimal numbers of about its radius, so that users
/// can add it. 0 if the centre is within k_far radii; on each axis, 0 if within a tenth of that.
glm::dvec3 round_origin(const glm::dvec3& centre, double radius);

/// The point of the file that becomes the scene's origin, in round numbers; 0 unless the main part of the
/// scene is far away relative to its own extent.
/// - Objects that are far relative to their own radius vote for moving; objects that would become far vote
///   against. Votes weigh by size and triangles, and those with a camera nearby outweigh all others: a stray
///   object decides nothing.
/// - An object that reaches from the old origin to the new one within k_far times its radius (a room around a
///   small object, a dome, a terrain) belongs to the scene's extent, and the scene stays; unless the rest is
///   so far that single precision no longer resolves it: k_far^2 times its radius with a camera nearby,
///   k_far^3 without.
/// Lamps are not extents: nothing is seen from there.
glm::dvec3 choose_origin(std::span<const Extent> extents, std::span<const glm::dvec3> cameras);

}  // namespace lucerna::scene
