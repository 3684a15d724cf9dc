#pragma once
// How a camera maps directions to its picture. The shaders' counterpart: shaders/lib/projection.glsl.
#include <optional>

#include "scene/scene.h"

namespace lucerna::scene {

/// Half the picture's width and height, for a picture of that aspect (width / height): in the plane at
/// distance 1 (perspective), in metres (orthographic), or as angles [radians] (panorama and fisheye). A
/// panorama always shows all directions; the circle of a fisheye fills the smaller side.
vec2 half_extent(const Camera& camera, float aspect);

struct ViewRay {
  vec3 origin, direction;  ///< direction: unit
};
/// The ray through a point of the picture, 0..1 to the right and down, without lens and section plane;
/// nullopt outside the circle of a fisheye.
std::optional<ViewRay> view_ray(const Camera& camera, float right, float down, float aspect);

/// Where a point is in the picture, 0..1 to the right and down (outside 0..1: beyond its borders); nullopt
/// behind the camera, or outside the circle of a fisheye.
std::optional<vec2> place_in_picture(const Camera& camera, const vec3& point, float aspect);

}  // namespace lucerna::scene
