#include "surface_snap.h"

#include <algorithm>
#include <cmath>

#include "scene/lamp.h"

namespace lucerna::ui {
namespace {

/// Half the size of a lamp along a direction (unit).
float half_along(const scene::Light& lamp, const vec3& way) {
  using scene::LightKind;
  if (!has_shape(lamp.kind)) return 0;
  const float right = std::abs(glm::dot(way, lamp.right)), ahead = std::abs(glm::dot(way, lamp.direction));
  const float across = std::abs(glm::dot(way, glm::cross(lamp.direction, lamp.right)));
  const vec2 half = half_size(lamp);
  if (lamp.kind == LightKind::rectangle) return right * half.x + across * half.y;
  if (lamp.kind == LightKind::disk) return half.x * std::sqrt(std::max(0.0f, 1 - ahead * ahead));
  if (lamp.kind == LightKind::tube)
    return right * half.x + half.y * std::sqrt(std::max(0.0f, 1 - right * right));
  return half.x;
}

}  // namespace

scene::ObjectPlace put_on_surface(const scene::Mesh& mesh, const Box& box, const mat4& loaded,
                                  const scene::ObjectPlace& place, const SurfacePoint& surface) {
  if (box.empty()) return place;
  const glm::dmat4 to_world(placed(loaded, box, place));
  const glm::dvec3 normal(surface.normal), middle(scene::middle_of(box, mat4(to_world)));
  double lowest = 0;
  for (const scene::Primitive& p : mesh.primitives)
    for (const vec3& vertex : p.positions) {
      const glm::dvec3 at(to_world * glm::dvec4(glm::dvec3(vertex), 1));
      lowest = std::min(lowest, glm::dot(at - middle, normal));
    }
  scene::ObjectPlace put = place;
  put.moved = vec3(glm::dvec3(place.moved) + glm::dvec3(surface.position) - lowest * normal - middle);
  return put;
}

vec3 lamp_on_surface(const scene::Light& lamp, const SurfacePoint& surface, float gap) {
  return surface.position + (gap + half_along(lamp, surface.normal)) * surface.normal;
}

}  // namespace lucerna::ui
