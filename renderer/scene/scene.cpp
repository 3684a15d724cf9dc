#include "scene/scene.h"

#include "base/error.h"

#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace lucerna::scene {

const std::vector<Primitive>& shown_parts(const Scene& scene, const Instance& instance) {
  static const std::vector<Primitive> none;
  return instance.hidden || instance.mesh >= scene.meshes.size() ? none
                                                                 : scene.meshes[instance.mesh].primitives;
}

Box bounds(const Scene& scene, const Instance& instance) {
  Box box;
  for (const Primitive& p : shown_parts(scene, instance))
    for (const uvec3& t : p.triangles)
      for (int k = 0; k < 3; ++k) box.grow(vec3(instance.to_world * vec4(p.positions[t[k]], 1)));
  return box;
}

Box bounds(const Scene& scene) {
  Box box;
  for (const Instance& instance : scene.instances) box.grow(bounds(scene, instance));
  return box;
}

uint64_t count_triangles(const Scene& scene) {
  uint64_t count = 0;
  for (const Instance& instance : scene.instances)
    for (const Primitive& p : shown_parts(scene, instance)) count += p.triangles.size();
  return count;
}

Camera default_camera(const Scene& scene) {
  Camera camera;
  camera.name = "default";
  camera.yfov = 0.7f;
  const Box box = bounds(scene);
  const vec3 centre = box.empty() ? vec3(0) : box.centre();
  const float radius = box.empty() ? 1.f : std::max(box.radius(), 1e-3f);
  const float distance = radius / std::sin(0.5f * camera.yfov);
  const vec3 eye = centre + distance * glm::normalize(vec3(0.35f, 0.3f, 1));
  camera.to_world = glm::inverse(glm::lookAt(eye, centre, vec3(0, 1, 0)));
  return camera;
}

const Camera& find_camera(const Scene& scene, const std::string& name) {
  std::string names;
  for (const Camera& c : scene.cameras) {
    if (c.name == name) return c;
    names += (names.empty() ? "'" : ", '") + c.name + "'";
  }
  size_t number = 0;
  const char* end = name.data() + name.size();
  if (const auto [stop, error] = std::from_chars(name.data(), end, number);
      error == std::errc() && stop == end) {
    if (number >= 1 && number <= scene.cameras.size()) return scene.cameras[number - 1];
  }
  throw_error("camera", "the scene has no camera '{}'; it has {}", name, names.empty() ? "none" : names);
}

Camera starting_camera(const Scene& scene, const std::string& name) {
  if (!name.empty()) return find_camera(scene, name);
  return scene.cameras.empty() ? default_camera(scene) : scene.cameras.front();
}

vec3 normal_of(const Portal& portal) {
  return glm::normalize(glm::cross(portal.half_width, portal.half_height));
}

float area_of(const Portal& portal) {
  return 4 * glm::length(portal.half_width) * glm::length(portal.half_height);
}

}  // namespace lucerna::scene
