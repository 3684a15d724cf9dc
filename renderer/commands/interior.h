#pragma once
// Movement in rooms, with collisions. Pure functions: obstacles come from a callback, so no scene is needed.
// Metres and radians, Y up.
#include <functional>
#include <optional>

#include "commands/camera_control.h"

namespace lucerna::commands {

/// A surface that a ray meets.
struct Obstacle {
  float distance = 0;
  vec3 normal{0, 1, 0};  ///< unit, towards where the ray came from
};
/// The nearest surface along a ray (unit direction) nearer than the limit.
using Look = std::function<std::optional<Obstacle>(const vec3& origin, const vec3& direction, float limit)>;

/// How far from surfaces the eye is kept: 0.2 m in a room, less in a small scene.
float clearance(float extent);

/// Goes from `eye` by `step`, along surfaces that stand in the way, never nearer than `clear` to the one
/// ahead. `blocked`, where given, is set when one stood in the way.
vec3 step_among(const Look& look, const vec3& eye, const vec3& step, float clear, bool* blocked = nullptr);
/// The same along a straight line: stops instead of sliding.
vec3 step_straight(const Look& look, const vec3& eye, const vec3& step, float clear, bool* blocked = nullptr);

/// Turns about any point: the eye and the view turn with one another, so that the point stays where it is in
/// the picture sideways, and the pole stops as in orbit(). The pivot of later turns lies at its depth.
void orbit_about(Viewpoint& view, const vec3& point, const vec2& angles);
/// Comes closer to a point by 10 % of the way a step; negative: away from it. The direction does not change.
void dolly_towards(Viewpoint& view, const vec3& point, float steps);

inline constexpr float k_eye_height = 1.65f;  ///< metres above the floor
inline constexpr float k_stair = 0.4f;        ///< maximum height of a step [m]; higher surfaces are no floor

/// The floor below the eye: the highest surface that faces up and is at least `least` metres below it, or
/// else the lowest there is. Its distance; nothing when there is none.
std::optional<float> floor_below(const Look& look, const vec3& eye, float least, float extent);
/// Walks by metres to the right and forwards, horizontal whatever the view's slope, `height` above the floor,
/// up and down stairs; without a floor it stays at its height. `through`: without collisions. True if
/// something was in the way.
bool walk(Viewpoint& view, const Look& look, const vec2& metres, float height, bool through);

/// True if walls are all around: at least 11 of 14 directions hit something within four radii of the scene.
bool enclosed(const Look& look, const vec3& eye, float extent);

/// As frame(), but the eye ends neither behind nor inside what stands between. `look` must pass through what
/// is framed. Where there is no room in the view's own direction others are tried, the nearest first.
void frame_clear(Viewpoint& view, const Box& box, float aspect, const Look& look);
/// As frame() of the whole scene for a camera inside it: moves back within the available room.
void frame_inside(Viewpoint& view, const Box& box, float aspect, const Look& look);

}  // namespace lucerna::commands
