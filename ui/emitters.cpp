#include "emitters.h"

#include <algorithm>

#include "base/color.h"

namespace lucerna::ui {
namespace {

/// True for each material that a surface uses.
std::vector<bool> used_materials(const scene::Scene& scene) {
  std::vector<bool> used(scene.materials.size());
  for (const scene::Instance& instance : scene.instances)
    for (const scene::Primitive& p : scene::shown_parts(scene, instance)) used[p.material] = true;
  return used;
}

EmittingSurface measured(const scene::Primitive& p, const mat4& to_world) {
  EmittingSurface surface{.material = p.material};
  for (const uvec3& t : p.triangles) {
    const auto at = [&](uint32_t vertex) { return vec3(to_world * vec4(p.positions[vertex], 1)); };
    const vec3 a = at(t.x), b = at(t.y), c = at(t.z);
    const float area = 0.5f * glm::length(glm::cross(b - a, c - a));
    surface.area += area;
    surface.middle += area * (a + b + c) / 3.0f;
  }
  if (surface.area > 0) surface.middle /= surface.area;
  return surface;
}

}  // namespace

const std::vector<uint32_t>& emitters(const commands::OpenScene& open, const commands::Navigation& camera) {
  static uint64_t of = 0;
  static SharedVector<scene::Instance> in;
  static std::vector<bool> used;
  static std::vector<uint32_t> list;
  if (of != camera.view_scene || !in.shares_with(open.scene->instances) ||
      used.size() != open.scene->materials.size())
    used = used_materials(*open.scene), of = camera.view_scene, in = open.scene->instances;
  list.clear();
  for (uint32_t i = 0; i < used.size(); ++i)
    if (used[i] && strength_of(open.emission(i)) > 0 && !open.scene->materials[i].unlit) list.push_back(i);
  return list;
}

const std::vector<EmittingSurface>& emitting_surfaces(const commands::OpenScene& open,
                                                      const commands::Navigation& camera) {
  static uint64_t of = 0;
  static SharedVector<scene::Instance> in;
  static std::vector<uint32_t> materials;
  static std::vector<EmittingSurface> list;
  const std::vector<uint32_t>& now = emitters(open, camera);
  if (of == camera.view_scene && in.shares_with(open.scene->instances) && materials == now) return list;
  of = camera.view_scene, materials = now, in = open.scene->instances;
  list.clear();
  for (const scene::Instance& instance : open.scene->instances) {
    for (const scene::Primitive& p : scene::shown_parts(*open.scene, instance))
      if (std::binary_search(now.begin(), now.end(), p.material)) {
        const EmittingSurface surface = measured(p, instance.to_world);
        if (surface.area > 0) list.push_back(surface);
      }
  }
  if (list.size() > k_most_marked) {
    std::nth_element(list.begin(), list.begin() + k_most_marked, list.end(),
                     [](const EmittingSurface& a, const EmittingSurface& b) { return a.area > b.area; });
    list.resize(k_most_marked);
  }
  return list;
}

}  // namespace lucerna::ui
