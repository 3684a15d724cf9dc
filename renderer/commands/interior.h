#pragma once
// Movement in rooms, with collisions. Pure functions: obstacles come from a callback, so no scene is needed.
// Metres and radians, Y up.
#include <functional>
#include <optional>

#include "commands/camera_control.h"

namespace lucerna::commands {

/// A surface hit by a ray.
struct Obstacle {
  float distance = 0;
  vec3 normal{0, 1, 0};  ///< unit, towards the origin of the ray
};
/// The nearest surface along a ray (unit direction) within the limit.
using Look = std::function<std::optional<Obstacle>(const vec3& origin, const vec3& direction, float limit)>;

/// Minimum distance of the eye from surfaces: 0.2 m in a room, less in a small scene.
float clearance(float extent);

/// Moves `eye` by `step`, sliding along obstacles, never nearer than `clear` to the surface ahead. `blocked`,
/// if given, is set if there was an obstacle.
vec3 step_among(const Look& look, const vec3& eye, const vec3& step, float clear, bool* blocked = nullptr);
/// Likewise, in a straight line: stops instead of sliding.
vec3 step_straight(const Look& look, const vec3& eye, const vec3& step, float clear, bool* blocked = nullptr);

/// Turns eye and view together about any point, which keeps its horizontal position in the picture; stops at
/// the poles as in orbit(). The pivot of later turns is at its depth.
void orbit_about(Viewpoint& view, const vec3& point, const vec2& angles);
/// Approaches a point by 10 % of the distance per step; negative: away from it. Keeps the direction.
void dolly_towards(Viewpoint& view, const vec3& point, float steps);

inline constexpr float k_eye_height = 1.65f;  ///< metres above the floor
inline constexpr float k_stair = 0.4f;        ///< maximum height of a step [m]; higher surfaces are no floor

/// Distance of the floor below the eye: the highest surface that faces up and is at least `least` metres
/// below it, or else the lowest one; none if there is none.
std::optional<float> floor_below(const Look& look, const vec3& eye, float least, float extent);
/// Walks by metres to the right and forwards, horizontally, `height` above the floor, up and down stairs;
/// without a floor the height is kept. `through`: without collisions. True if there was an obstacle.
bool walk(Viewpoint& view, const Look& look, const vec2& metres, float height, bool through);

/// True if walls are all around: at least 11 of 14 directions hit something within four radii of the scene.
bool enclosed(const Look& look, const vec3& eye, float extent);

/// Like frame(), but the eye is neither behind nor inside an obstacle. `look` must pass through the framed
/// object. Without room in the view's direction, others are tried, the nearest first.
void frame_clear(Viewpoint& view, const Box& box, float aspect, const Look& look);
/// Like frame() of the whole scene for a camera inside it: moves back within the available room.
void frame_inside(Viewpoint& view, const Box& box, float aspect, const Look& look);

}  // namespace lucerna::commands
