#include "raybench/rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "base/error.h"

namespace lucerna::raybench {
namespace {

using namespace shared;

/// Some roundings of the triangle's size and place off the surface: enough for a bench, whose rays only need
/// to be like a renderer's.
class Surface {
 public:
  explicit Surface(const FlatFile& f) : flat_(f.scene) {}

  vec3 normal(const Ray& ray, const Hit& hit) const {
    const vec3* p = &flat_.positions[3 * size_t(hit.prim)];
    const vec3 n = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    return glm::dot(n, ray.direction) > 0 ? -n : n;
  }
  vec3 point(const Hit& hit, vec3 n) const {
    const vec3* p = &flat_.positions[3 * size_t(hit.prim)];
    const vec3 at = (1 - hit.u - hit.v) * p[0] + hit.u * p[1] + hit.v * p[2];
    return at + n * (bvh::margin_of(p) + 1e-6f * (std::abs(at.x) + std::abs(at.y) + std::abs(at.z)));
  }

 private:
  const upload::FlatScene& flat_;
};

class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  float operator()() { return float(engine_() >> 8) * (1.0f / 16777216.0f); }

 private:
  std::mt19937 engine_;
};

vec3 cosine_direction(vec3 n, Random& u) {
  const float r = std::sqrt(u()), phi = 6.2831853f * u();
  const vec3 t =
      glm::normalize(std::abs(n.x) > 0.5f ? glm::cross(n, vec3(0, 1, 0)) : glm::cross(n, vec3(1, 0, 0)));
  return glm::normalize(r * std::cos(phi) * t + r * std::sin(phi) * glm::cross(n, t) +
                        std::sqrt(std::max(0.0f, 1 - r * r)) * n);
}

std::vector<Ray> primary_rays(const FlatFile& f, uint32_t count, Random& u) {
  const float aspect = f.camera.aspect > 0 ? f.camera.aspect : 16.0f / 9;
  const uint32_t tiles_x = std::max(1u, uint32_t(std::sqrt(count * aspect) / 8)),
                 tiles_y = std::max(1u, count / 64 / tiles_x);
  const uint32_t width = 8 * tiles_x, height = 8 * tiles_y;
  const mat4& m = f.camera.to_world;
  const bool flat = f.camera.orthographic;
  const float half_h = flat ? f.camera.ymag : std::tan(0.5f * f.camera.yfov),
              half_w = half_h * float(width) / float(height);
  const vec3 right = half_w * glm::normalize(vec3(m[0])), up = half_h * glm::normalize(vec3(m[1])),
             forward = -glm::normalize(vec3(m[2]));
  const auto compact = [](uint32_t x) { return (x & 1u) | (x >> 1 & 2u) | (x >> 2 & 4u); };
  std::vector<Ray> rays;
  rays.reserve(size_t(width) * height);
  for (uint32_t tile = 0; tile < tiles_x * tiles_y; ++tile)
    for (uint32_t code = 0; code < 64; ++code) {
      const float x = float(8 * (tile % tiles_x) + compact(code)) + u(),
                  y = float(8 * (tile / tiles_x) + compact(code >> 1)) + u();
      const vec3 shift = (2 * x / float(width) - 1) * right - (2 * y / float(height) - 1) * up;
      Ray ray;
      ray.origin = vec3(m[3]) + (flat ? shift : vec3(0));
      ray.direction = glm::normalize(forward + (flat ? vec3(0) : shift));
      ray.tmax = k_infinity;
      ray.slot = uint32_t(rays.size());
      rays.push_back(ray);
    }
  return rays;
}

/// Towards a light chosen through the renderer's own table; the ray ends at `distance`.
vec3 light_direction(const FlatFile& f, vec3 from, Random& u, float& distance) {
  const upload::FlatScene& s = f.scene;
  distance = k_infinity;
  const auto towards = [&](vec3 target) {
    distance = glm::length(target - from) * 0.9999f;
    return glm::normalize(target - from);
  };
  if (s.lights.empty()) return towards(f.tree.bounds.lo + f.tree.bounds.size() * vec3(u(), u(), u()));
  const size_t count = s.light_alias.size(), entry = std::min(count - 1, size_t(u() * float(count)));
  const vec4 choice = s.light_alias[entry];
  const size_t light = u() < choice.x ? entry : std::bit_cast<uint32_t>(choice.y);
  const vec4* texel = &s.lights[light * k_light_texels];
  switch (std::bit_cast<uint32_t>(texel[0].w)) {
    case k_light_triangle: {
      const float a = std::sqrt(u()), b = u();
      return towards((1 - a) * vec3(texel[0]) + a * (1 - b) * vec3(texel[1]) + a * b * vec3(texel[2]));
    }
    case k_light_directional:
      return -vec3(texel[2]);
    case k_light_environment: {
      const float y = 2 * u() - 1, phi = 6.2831853f * u(), r = std::sqrt(std::max(0.0f, 1 - y * y));
      return vec3(r * std::cos(phi), y, r * std::sin(phi));
    }
    default:
      return towards(vec3(texel[0]));
  }
}

}  // namespace

std::vector<RaySet> make_rays(const FlatFile& f, uint32_t count, uint32_t seed, const TraceBatch& trace) {
  Random u(seed);
  const Surface surface(f);
  std::vector<RaySet> sets;
  sets.push_back({"primary", bvh::Query::closest, true, primary_rays(f, count, u)});
  RaySet shadow{"shadow", bvh::Query::any_opaque, false, {}};
  for (const char* name : {"diffuse", "diffuse 2"}) {
    const std::vector<Ray>& before = sets.back().rays;
    std::vector<Hit> hits(before.size());
    trace(bvh::Query::closest, before, hits);
    RaySet next{name, bvh::Query::closest, false, {}};
    const auto add = [](std::vector<Ray>& list, vec3 origin, vec3 direction, float tmax) {
      Ray ray;
      ray.origin = origin;
      ray.direction = direction;
      ray.tmax = tmax;
      ray.slot = uint32_t(list.size());
      list.push_back(ray);
    };
    for (size_t i = 0; i < before.size(); ++i) {
      if (hits[i].prim == k_no_hit) continue;
      const vec3 n = surface.normal(before[i], hits[i]), at = surface.point(hits[i], n);
      add(next.rays, at, cosine_direction(n, u), k_infinity);
      if (&before == &sets.front().rays) {
        float distance = 0;
        const vec3 direction = light_direction(f, at, u, distance);
        add(shadow.rays, at, direction, distance);
      }
    }
    if (next.rays.empty()) {
      if (sets.size() == 1) throw_error(f.name, "the camera sees nothing; choose another with --camera");
      break;
    }
    sets.push_back(std::move(next));
  }
  sets.push_back(std::move(shadow));
  return sets;
}

}  // namespace lucerna::raybench
