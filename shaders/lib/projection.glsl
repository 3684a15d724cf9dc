// Projections of the camera that show directions by their angles, all round: panorama and fisheye. Perspective and
// orthographic ones are planes, whose points are camera_forward (or camera_origin) plus a shift.
//
//   panorama  latitude-longitude: to the right the longitude, up the latitude
//   fisheye   equidistant: the distance from the middle is the angle from the axis, up to 90 degrees
#ifndef LUCERNA_LIB_PROJECTION
#define LUCERNA_LIB_PROJECTION
#include "shaders/shared/scene.h"
#include "lib/math.glsl"

bool is_wide(uint projection) { return projection >= k_projection_panorama; }
bool is_parallel(uint projection) { return projection == k_projection_orthographic; }

// Unit direction at these angles [radians] to the right (x) and up (y); x, y, axis: unit vectors, axis to the middle.
vec3 wide_direction(uint projection, vec2 angles, vec3 x, vec3 y, vec3 axis) {
  if (projection == k_projection_panorama)
    return cos(angles.y) * (cos(angles.x) * axis + sin(angles.x) * x) + sin(angles.y) * y;
  float angle = length(angles);
  vec2 to = angles * (angle > 0.0 ? sin(angle) / angle : 1.0);
  return cos(angle) * axis + to.x * x + to.y * y;
}

// Angles of a unit direction.
vec2 wide_angles(uint projection, vec3 direction, vec3 x, vec3 y, vec3 axis) {
  float ahead = dot(direction, axis);
  vec2 aside = vec2(dot(direction, x), dot(direction, y));
  if (projection == k_projection_panorama)
    return vec2(aside.x == 0.0 && ahead == 0.0 ? 0.0 : atan(aside.x, ahead), asin(clamp(aside.y, -1.0, 1.0)));
  float sine = length(aside);
  return sine > 0.0 ? aside * (atan(sine, ahead) / sine) : vec2(ahead < 0.0 ? k_pi : 0.0, 0.0);
}

// Whether the picture shows something at these angles.
bool wide_covers(uint projection, vec2 angles) {
  return projection == k_projection_panorama || dot(angles, angles) <= 0.25 * k_pi * k_pi;
}

// Solid angle of a small part of the picture over its area in squared angles.
float wide_stretch(uint projection, vec2 angles) {
  if (projection == k_projection_panorama) return max(cos(angles.y), 0.0);
  float angle = length(angles);
  return angle > 1e-3 ? sin(angle) / angle : 1.0;
}
#endif
