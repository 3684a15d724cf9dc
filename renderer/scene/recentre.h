#pragma once
// Where the origin of a scene's coordinates is put. The renderer computes in single precision, whose steps
// grow with the distance from the origin: 8 mm at 100 km, half a metre at the coordinates of national grids.
// So a scene that lies far from the origin of its file is moved near it when it is loaded.
#include <glm/glm.hpp>
#include <span>

namespace lucerna::scene {

/// What is far: more than so many times its own radius away.
inline constexpr double k_far = 100;

/// A placed mesh, as far as choose_origin must know it, in the file's coordinates [m].
struct Extent {
  glm::dvec3 centre{0};
  double radius = 0;  ///< above 0
  double weight = 1;  ///< of its vote
};

/// The new origin for something about `centre`, of the radius: near the centre, in round decimal numbers of
/// about the radius, so that people can add it. 0 where centre is within k_far times the radius, and on each
/// axis where it is within a tenth of that.
glm::dvec3 round_origin(const glm::dvec3& centre, double radius);

/// The point of the file that becomes the scene's origin, in round numbers; 0 unless what matters in the
/// scene is far away relative to its own extent.
/// - What is far relative to its own radius votes for moving; what is not, and would be far then, against.
/// Votes
///   weigh by size and triangles, and those with a camera near outweigh all others: a stray object decides
///   nothing.
/// - What is large enough to reach from the old origin to the new one at k_far times its radius (a room about
///   a small object, a dome, a terrain) belongs to the scene's extent, and the scene stays; unless the rest
///   is so far that single precision no longer shows it: k_far^2 times its radius with a camera near it,
///   k_far^3 without.
/// Lamps do not belong among the extents: nothing is seen from there.
glm::dvec3 choose_origin(std::span<const Extent> extents, std::span<const glm::dvec3> cameras);

}  // namespace lucerna::scene
