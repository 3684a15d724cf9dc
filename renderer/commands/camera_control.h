#pragma once
// Movements of the view: pure functions on a camera, without a window. Metres and radians; right-handed, Y
// up. A camera looks down its -Z. All functions leave the matrix rigid (orthonormal axes), whatever it was
// before.
#include "scene/scene.h"

namespace lucerna::commands {

/// A camera with its pivot, `distance` metres ahead.
struct Viewpoint {
  scene::Camera camera;
  float distance = 1;  ///< to the pivot, metres, > 0
  float extent = 1;    ///< radius of the scene's core, metres, > 0; scales speeds and smallest steps
};

vec3 eye_of(const scene::Camera& camera);
vec3 right_of(const scene::Camera& camera);
vec3 up_of(const scene::Camera& camera);
vec3 forward_of(const scene::Camera& camera);
vec3 pivot_of(const Viewpoint& view);

/// From a scene camera; the pivot is ahead at the depth of the centre of `core` (scene::core_bounds()),
/// limited to between 1/20 and 2 radii, so that orbiting turns about the visible object. An empty box counts
/// as one metre.
Viewpoint make_viewpoint(const scene::Camera& camera, const Box& core);

/// Turns the eye about the pivot: x about world Y (positive: counter-clockwise seen from above), y raises the
/// eye. Elevation stops 1 degree before the poles. The distance does not change.
void orbit(Viewpoint& view, const vec2& angles);
/// Turns the view about the eye: x to the left, y upwards; the same stop at the poles.
void look(Viewpoint& view, const vec2& angles);
/// Moves sideways so that the pivot follows a drag by `pixels` (y down) in a picture `picture_height` pixels
/// high.
void pan(Viewpoint& view, const vec2& pixels, float picture_height);
/// Moves closer by 10 % of the distance per step (negative: away). Near the pivot the pivot is moved ahead,
/// so that the camera can continue through a doorway. Orthographic cameras change their size instead.
void dolly(Viewpoint& view, float steps);
/// Places the eye, looking at `target`, which becomes the pivot. False, without a change, if there is no
/// direction.
bool place(Viewpoint& view, const vec3& eye, const vec3& target, const vec3& up);
/// Moves by metres along the camera's own axes: right, up, forward.
void fly(Viewpoint& view, const vec3& metres);
/// Keeps the direction and moves so that the sphere around `box` fills the picture (aspect = width / height).
void frame(Viewpoint& view, const Box& box, float aspect);
/// Levels a perspective camera, so that vertical lines are vertical in the picture, and shifts the lens so
/// that the middle of the picture stays, at the same scale. False, without a change, if the camera is
/// orthographic, or looks too steeply (80 degrees) up or down. `aspect`: width / height of the picture.
bool upright(Viewpoint& view, float aspect);
/// A walking pace for a scene of that extent, m/s: 1.5 in a room, proportional beyond.
float walking_speed(float extent);

/// Flight with soft starts and stops, independent of the frame rate.
struct Flight {
  vec3 velocity{0};  ///< m/s along the camera's right, up, forward
  bool moving() const { return glm::dot(velocity, velocity) > 0; }
};
/// Advances by `seconds` towards the wished direction (each component -1, 0 or 1) at `speed` m/s; returns the
/// metres to fly. The time constant is 80 ms; below 1/1000 of the speed it stands still.
vec3 advance(Flight& flight, const vec3& wish, float speed, float seconds);

/// Horizontal focal length, in millimetres on a 36 mm wide frame, of a perspective camera at that aspect; and
/// back.
/// Half the height of what the picture shows at that depth [m].
float half_height_at(const scene::Camera& camera, float depth);
float focal_length_mm(float yfov, float aspect);
float yfov_from_focal_length(float millimetres, float aspect);

/// True if two cameras make the same picture.
bool same_view(const scene::Camera& a, const scene::Camera& b);

}  // namespace lucerna::commands
