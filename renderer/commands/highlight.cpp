#include "commands/highlight.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "commands/light_words.h"
#include "scene/lamp.h"
#include "session/picked_surface.h"

namespace lucerna::commands {
namespace {

constexpr int k_most_mirrors = 4;
/// Roughness of the smoothest surface, so that a click finds the image of a point, a degree or two wide.
constexpr float k_least_alpha = 0.02f;
/// A surface this smooth shows other surfaces.
constexpr float k_mirror_roughness = 0.25f;
/// Radiance that a person notices, as a share of white.
constexpr float k_noticed = 0.05f;

/// The share of a point's distance by which rays start off surfaces.
constexpr float k_off = 1e-4f;

vec3 off_the_surface(const session::Picked& hit, const vec3& to) {
  const float off = k_off * (hit.distance + glm::length(hit.position) * 0.1f);
  return hit.position + (glm::dot(hit.normal, to) > 0 ? off : -off) * hit.normal;
}

float schlick(float f0, float cosine) { return f0 + (1 - f0) * std::pow(1 - cosine, 5.0f); }

struct Lobe {
  float alpha;     ///< width of GGX: the squared roughness
  float f0;        ///< reflectance of perpendicular light
  float strength;  ///< 0..1
};

struct Reflector {
  session::PickedSurface surface;
  vec3 to_eye;
  float diffuse;  ///< reflectance
  Lobe lobes[2];  ///< of the surface and of its coat
};

Reflector reflector_at(const scene::Scene& scene, const session::Picked& hit, const vec3& direction) {
  Reflector r{.surface = session::surface_at(scene, hit), .to_eye = -direction, .diffuse = 0, .lobes = {}};
  const scene::Material& m = scene.materials[hit.material];
  const float ratio = (m.ior - 1) / (m.ior + 1), base = luminance(r.surface.base_color);
  const float dielectric = std::min(1.0f, ratio * ratio * m.specular * luminance(m.specular_color));
  const float metallic = std::clamp(r.surface.metallic, 0.0f, 1.0f);
  const auto alpha = [](float roughness) { return std::max(roughness * roughness, k_least_alpha); };
  r.diffuse = base * (1 - metallic) * (1 - m.transmission);
  r.lobes[0] = {alpha(r.surface.roughness), glm::mix(dielectric, base, metallic), 1};
  r.lobes[1] = {alpha(r.surface.coat_roughness), 0.04f, r.surface.clearcoat};
  return r;
}

/// Share of light that a polished surface mirrors; 0: it is too rough.
float mirrored(const Reflector& r) {
  const float cosine = std::clamp(glm::dot(r.surface.normal, r.to_eye), 0.0f, 1.0f);
  float share = r.surface.roughness <= k_mirror_roughness ? schlick(r.lobes[0].f0, cosine) : 0;
  if (r.surface.coat_roughness <= k_mirror_roughness)
    share = std::max(share, r.surface.clearcoat * schlick(r.lobes[1].f0, cosine));
  return share;
}

/// The way to a light and what it sends, seen from a point.
struct Seen {
  vec3 to_light{0};             ///< unit, to its part nearest to the reflected ray
  float distance = k_infinity;  ///< metres
  float irradiance = 0;         ///< perpendicular to the way, luminance
  float size = 0;               ///< sine of the angle of half its extent
};

vec3 shortened(const vec3& v, float most) {
  const float length = glm::length(v);
  return length > most ? most / length * v : v;
}

/// The point of a lamp with a shape that is nearest to a ray.
vec3 nearest_point(const scene::Light& light, const vec3& from, const vec3& ray) {
  if (!has_shape(light.kind)) return light.position;
  const vec3 way = light.position - from;
  if (light.kind == scene::LightKind::sphere)
    return light.position + shortened(glm::dot(way, ray) * ray - way, light.radius);
  if (light.kind == scene::LightKind::tube) {
    // Nearest points of two lines: of the ray and of the axis.
    const float along = glm::dot(light.right, ray), det = 1 - along * along;
    const float s = det > 1e-6f ? (along * glm::dot(way, ray) - glm::dot(way, light.right)) / det : 0;
    return light.position + std::clamp(s, -0.5f * light.width, 0.5f * light.width) * light.right;
  }
  const float towards = glm::dot(ray, light.direction);
  if (std::abs(towards) < 1e-6f || glm::dot(way, light.direction) / towards <= 0) return light.position;
  const vec3 off = glm::dot(way, light.direction) / towards * ray - way;
  if (light.kind == scene::LightKind::disk) return light.position + shortened(off, light.radius);
  const vec3 up = glm::cross(light.right, light.direction);
  return light.position +
         std::clamp(glm::dot(off, light.right), -0.5f * light.width, 0.5f * light.width) * light.right +
         std::clamp(glm::dot(off, up), -0.5f * light.height, 0.5f * light.height) * up;
}

/// Relative intensity of a lamp in a direction away from it, unit.
float relative_intensity(const scene::Light& light, const vec3& away) {
  const float cosine = glm::dot(away, light.direction);
  switch (light.kind) {
    case scene::LightKind::spot:
      return cosine > std::cos(light.outer_cone) ? 1 : 0;
    case scene::LightKind::rectangle:
    case scene::LightKind::disk:
      return light.two_sided ? std::abs(cosine) : std::max(cosine, 0.0f);
    case scene::LightKind::tube:
      return std::sqrt(std::max(0.0f, 1 - glm::dot(away, light.right) * glm::dot(away, light.right)));
    default:
      return 1;
  }
}

Seen seen_from(const vec3& point, const vec3& ray, const scene::Light& light) {
  Seen s;
  const float strength = luminance(light.intensity);
  if (light.kind == scene::LightKind::directional) {
    s.to_light = -light.direction, s.irradiance = strength;
    return s;
  }
  const vec3 way = nearest_point(light, point, ray) - point;
  s.distance = glm::length(way);
  if (!(s.distance > 0)) return s;
  s.to_light = way / s.distance;
  s.irradiance = strength * relative_intensity(light, -s.to_light) / (s.distance * s.distance);
  const vec2 half = scene::half_size(light);
  s.size = std::min(1.0f, std::max(half.x, half.y) / s.distance);
  return s;
}

/// Radiance of the light's image on the surface towards the eye; 0 where its diffuse light is brighter.
float highlight(const Reflector& r, const Seen& light) {
  const vec3& n = r.surface.normal;
  const float in = glm::dot(n, light.to_light), out = glm::dot(n, r.to_eye);
  if (!(in > 0) || !(out > 0)) return 0;
  const vec3 half = glm::normalize(light.to_light + r.to_eye);
  const float nh = glm::dot(n, half), toward = std::max(glm::dot(half, r.to_eye), 0.0f);
  float sum = 0;
  for (const Lobe& lobe : r.lobes) {
    const float wide = std::min(1.0f, lobe.alpha + 0.5f * light.size);
    const float a2 = wide * wide, base = nh * nh * (a2 - 1) + 1;
    // Beyond a quarter of its peak a lobe is no image of the light.
    if (a2 * a2 / (base * base) < 0.25f) continue;
    const float d = a2 / (k_pi * base * base), narrow = lobe.alpha / wide;
    sum += lobe.strength * schlick(lobe.f0, toward) * d * narrow * narrow / (4 * std::max(out, 0.05f));
  }
  const float diffuse = r.diffuse / k_pi * in;
  return sum > diffuse ? sum * light.irradiance : 0;
}

bool reaches(const session::Probe& probe, const session::Picked& hit, const Seen& light) {
  const float limit = light.distance * (1 - 1e-3f);
  return !probe.nearest(off_the_surface(hit, light.to_light), light.to_light, limit,
                        [&](const session::Picked& other) {
                          const scene::Material& m = probe.scene().materials[other.material];
                          return m.transmission < 0.5f && m.emission == vec3(0);
                        });
}

}  // namespace

Selection light_in_highlight(const session::Probe& probe, const std::vector<scene::Light>& lights,
                             const session::PickRay& ray, float exposure) {
  vec3 origin = ray.origin, direction = ray.direction;
  float weight = exposure;
  for (int mirrors = 0; mirrors <= k_most_mirrors; ++mirrors) {
    const auto hit = probe.nearest(origin, direction);
    if (!hit) return {};
    const float emitted = luminance(probe.scene().materials[hit->material].emission);
    if (emitted > 0) {
      // One that is seen directly is an object like others.
      if (mirrors == 0 || weight * emitted < k_noticed) return {};
      return {Kind::material, hit->material};
    }
    const Reflector r = reflector_at(probe.scene(), *hit, direction);
    const vec3 reflected = glm::reflect(direction, r.surface.normal);
    std::optional<uint32_t> best;
    float most = k_noticed;
    for (size_t i = 0; i < lights.size(); ++i) {
      if (!lights[i].enabled) continue;
      const Seen seen = seen_from(hit->position, reflected, lights[i]);
      const float radiance = weight * highlight(r, seen);
      if (radiance > most && reaches(probe, *hit, seen)) most = radiance, best = static_cast<uint32_t>(i);
    }
    if (best) return {Kind::light, *best};
    weight *= mirrored(r);
    if (weight <= 0 || glm::dot(reflected, hit->normal) <= 0) return {};
    origin = off_the_surface(*hit, reflected), direction = reflected;
  }
  return {};
}

bool place_highlight(const session::Probe& probe, const session::PickRay& ray, scene::Light& light) {
  const auto hit = ray.direction == vec3(0) ? std::nullopt : probe.nearest(ray.origin, ray.direction);
  if (!hit) throw Error("", "there is no surface at this point of the picture");
  const vec3 way = glm::reflect(ray.direction, session::surface_at(probe.scene(), *hit).normal);
  if (!(glm::dot(way, hit->normal) > 1e-3f))
    throw Error("", "the surface is seen edge-on there; its reflection goes into it");
  if (light.kind == scene::LightKind::directional) {
    light.direction = -way, light.sun.reset();
    return true;
  }
  const float before = glm::distance(light.position, hit->position);
  float distance = before;
  const vec2 half = scene::half_size(light);
  const vec3 start = off_the_surface(*hit, way);
  if (const auto wall = probe.nearest(start, way, 1.2f * distance + std::max(half.x, half.y)))
    distance = std::min(distance, std::max(0.8f * wall->distance, wall->distance - std::max(half.x, half.y)));
  light.position = hit->position + distance * way;
  if (can_be_aimed(light)) scene::turn_to(light, -way);
  return distance == before;
}

}  // namespace lucerna::commands
