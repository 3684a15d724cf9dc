#include "commands/object_drop.h"

#include <algorithm>
#include <vector>

namespace lucerna::commands {
namespace {

constexpr int k_raster = 24;  // points along a side of the box
constexpr size_t k_most_vertices = 4096;

/// Points of the object from which it may be held, each the lowest of its vertical line or a vertex.
std::vector<vec3> soles(const session::Probe& probe, uint32_t object, const mat4& to_world) {
  const scene::Scene& scene = probe.scene();
  const scene::Instance& instance = scene.instances[object];
  std::vector<vec3> points;
  Box box;
  for (const scene::Primitive& p : scene.meshes[instance.mesh].primitives) {
    const size_t stride = p.positions.size() / k_most_vertices + 1;
    for (size_t i = 0; i < p.positions.size(); ++i) {
      const vec3 at(to_world * vec4(p.positions[i], 1));
      box.grow(at);
      if (i % stride == 0) points.push_back(at);
    }
  }
  if (box.empty() || instance.hidden) return points;
  // The probe has the object where it was: rays are taken there.
  const mat4 back = instance.to_world * glm::inverse(to_world);
  const vec3 up(back * vec4(0, 1, 0, 0));
  const float below = 0.01f * std::max(box.size().y, 1e-4f);
  for (int j = 0; j < k_raster; ++j)
    for (int i = 0; i < k_raster; ++i) {
      const vec2 share((float(i) + 0.5f) / k_raster, (float(j) + 0.5f) / k_raster);
      const vec3 from(glm::mix(box.lo.x, box.hi.x, share.x), box.lo.y - below,
                      glm::mix(box.lo.z, box.hi.z, share.y));
      const auto hit = probe.nearest(vec3(back * vec4(from, 1)), up, k_infinity,
                                     [&](const session::Picked& p) { return p.instance == object; });
      if (hit) points.push_back(from + vec3(0, hit->distance, 0));
    }
  return points;
}

}  // namespace

std::optional<float> way_down(const session::Probe& probe, uint32_t object, const mat4& to_world) {
  if (object >= probe.scene().instances.size()) return std::nullopt;
  const std::vector<vec3> points = soles(probe, object, to_world);
  Box box;
  for (const vec3& p : points) box.grow(p);
  const float lift = 0.01f * box.size().y;
  std::optional<float> least;
  for (const vec3& p : points) {
    const auto hit = probe.nearest(p + vec3(0, lift, 0), vec3(0, -1, 0), k_infinity,
                                   [&](const session::Picked& other) { return other.instance != object; });
    if (hit && (!least || hit->distance - lift < *least)) least = hit->distance - lift;
  }
  return least;
}

}  // namespace lucerna::commands
