#include "session/pick.h"

#include <utility>

#include "scene/projection.h"
#include "session/picked_surface.h"

namespace lucerna::session {
namespace {

/// True if a ray is stopped at barycentric coordinates (a, b) of the second and third vertex.
bool stops(const scene::Scene& s, const scene::Primitive& p, const uvec3& t, float a, float b) {
  const scene::Material& m = s.materials[p.material];
  if (m.alpha_mode == scene::AlphaMode::opaque) return true;
  float alpha = m.base_color.w;
  if (!p.colors.empty()) alpha *= (1 - a - b) * p.colors[t.x].w + a * p.colors[t.y].w + b * p.colors[t.z].w;
  if (m.base_color_texture) {
    const std::vector<vec2>& uv = m.base_color_texture.uv_set == 1 ? p.uv1 : p.uv0;
    if (!uv.empty())
      alpha *= texel_at(s, m.base_color_texture, (1 - a - b) * uv[t.x] + a * uv[t.y] + b * uv[t.z]).w;
  }
  return alpha >= (m.alpha_mode == scene::AlphaMode::mask ? m.alpha_cutoff : 0.5f);
}

}  // namespace

std::optional<vec2> picked_uv(const scene::Scene& scene, const Picked& picked) {
  const scene::Primitive& p =
      scene.meshes[scene.instances[picked.instance].mesh].primitives[picked.primitive];
  if (p.uv0.empty()) return std::nullopt;
  const uvec3& t = p.triangles[picked.triangle];
  const auto [a, b] = std::pair(picked.barycentric.x, picked.barycentric.y);
  return (1 - a - b) * p.uv0[t.x] + a * p.uv0[t.y] + b * p.uv0[t.z];
}

PickRay pick_ray(const scene::Camera& camera, float x, float y, float aspect) {
  const std::optional<scene::ViewRay> view = scene::view_ray(camera, x, y, aspect);
  if (!view) return {vec3(camera.to_world[3]), vec3(0)};
  const PickRay ray{view->origin, view->direction};
  const scene::Section& section = camera.section;
  const float before = section.offset - glm::dot(ray.origin, section.normal);
  if (!section.cuts() || before <= 0) return ray;
  const float speed = glm::dot(ray.direction, section.normal);
  if (speed > 0) return {ray.origin + before / speed * ray.direction, ray.direction};
  return {ray.origin, vec3(0)};
}

std::optional<Picked> pick(const scene::Scene& scene, const scene::Camera& camera, float x, float y,
                           float aspect) {
  const auto [origin, direction] = pick_ray(camera, x, y, aspect);
  if (direction == vec3(0)) return std::nullopt;
  std::optional<Picked> best;
  float nearest = k_infinity;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    const std::vector<scene::Primitive>& primitives = scene::shown_parts(scene, instance);
    if (primitives.empty()) continue;
    // The ray keeps its parameter in object space, so distances are comparable.
    const mat4 to_object = glm::inverse(instance.to_world);
    const vec3 o(to_object * vec4(origin, 1)), d(to_object * vec4(direction, 0));
    for (uint32_t part = 0; part < primitives.size(); ++part) {
      const scene::Primitive& p = primitives[part];
      for (uint32_t triangle = 0; triangle < p.triangles.size(); ++triangle) {
        const uvec3& t = p.triangles[triangle];
        const vec3 &v0 = p.positions[t.x], e1 = p.positions[t.y] - v0, e2 = p.positions[t.z] - v0;
        const vec3 q = glm::cross(d, e2);
        const float det = glm::dot(e1, q);
        if (det == 0) continue;
        const vec3 s = o - v0, r = glm::cross(s, e1);
        const float a = glm::dot(s, q) / det, b = glm::dot(d, r) / det, distance = glm::dot(e2, r) / det;
        if (!(a >= 0 && b >= 0 && a + b <= 1 && distance > 0 && distance < nearest)) continue;
        if (!stops(scene, p, t, a, b)) continue;
        nearest = distance;
        const vec3 normal = glm::normalize(glm::transpose(glm::mat3(to_object)) * glm::cross(e1, e2));
        best = Picked{i,
                      p.material,
                      distance,
                      origin + distance * direction,
                      glm::dot(normal, direction) > 0 ? -normal : normal,
                      part,
                      triangle,
                      {a, b}};
      }
    }
  }
  return best;
}

namespace {

std::vector<bvh::InstancedTracer::Instance> traced_instances(const scene::Scene& scene) {
  std::vector<bvh::InstancedTracer::Instance> instances;
  for (const scene::Instance& instance : scene.instances)
    instances.push_back({instance.hidden ? scene::k_none : instance.mesh, instance.to_world});
  return instances;
}

bvh::InstancedTracer make_tracer(const scene::Scene& scene) {
  std::vector<bvh::InstancedTracer::Mesh> meshes;
  for (const scene::Mesh& mesh : scene.meshes) {
    meshes.emplace_back();
    for (const scene::Primitive& p : mesh.primitives) meshes.back().push_back({p.positions, p.triangles});
  }
  // One thread: the others render.
  return {meshes, traced_instances(scene), 1};
}

}  // namespace

Probe::Probe(std::shared_ptr<const scene::Scene> scene)
    : scene_(std::move(scene)), tracer_(make_tracer(*scene_)) {}

Probe::Probe(std::shared_ptr<const scene::Scene> scene, const Probe& before)
    : scene_(std::move(scene)),
      tracer_(scene_->meshes.shares_with(before.scene_->meshes)
                  ? bvh::InstancedTracer(before.tracer_, traced_instances(*scene_))
                  : make_tracer(*scene_)) {}

std::optional<Picked> Probe::nearest(const vec3& origin, const vec3& direction, float limit,
                                     const std::function<bool(const Picked&)>& wanted) const {
  const auto primitive = [&](const bvh::InstancedTracer::Hit& hit) -> const scene::Primitive& {
    return scene_->meshes[scene_->instances[hit.instance].mesh].primitives[hit.part];
  };
  const auto picked = [&](const bvh::InstancedTracer::Hit& hit) {
    return Picked{hit.instance, primitive(hit).material,
                  hit.distance, origin + hit.distance * direction,
                  hit.normal,   hit.part,
                  hit.triangle, {hit.u, hit.v}};
  };
  const auto hit = tracer_.nearest(origin, direction, limit, [&](const bvh::InstancedTracer::Hit& h) {
    const scene::Primitive& p = primitive(h);
    return stops(*scene_, p, p.triangles[h.triangle], h.u, h.v) && (!wanted || wanted(picked(h)));
  });
  if (!hit) return std::nullopt;
  return picked(*hit);
}

}  // namespace lucerna::session
