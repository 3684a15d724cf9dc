#include "scene/light_units.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/color.h"
#include "scene/lamp.h"

namespace lucerna::scene {
namespace {

using std::numbers::pi;

/// Irradiance from a rectangle of radiance 1 on a parallel plane in front of its middle.
double from_rectangle(double half_width, double half_height, double distance) {
  const double x = half_width / distance, y = half_height / distance;
  const double u = std::sqrt(1 + x * x), v = std::sqrt(1 + y * y);
  return 2 * (x / u * std::atan(y / u) + y / v * std::atan(x / v));
}

/// Irradiance from the side of a tube of radiance 1 on a plane beside its middle that faces it. Along the
/// axis the integral of 1 / D^4 is known; around it, Simpson's rule.
double from_tube(double half_length, double radius, double distance) {
  const double last = std::acos(radius / distance);
  constexpr int k_steps = 256;
  double sum = 0;
  for (int i = 0; i <= k_steps; ++i) {
    const double cosine = std::cos(last * i / k_steps);
    const double a2 = distance * distance + radius * radius - 2 * distance * radius * cosine;
    const double along = half_length / (a2 * (half_length * half_length + a2)) +
                         std::atan(half_length / std::sqrt(a2)) / (a2 * std::sqrt(a2));
    const double weight = i == 0 || i == k_steps ? 1 : i % 2 ? 4 : 2;
    sum += weight * (distance * cosine - radius) * (distance - radius * cosine) * along;
  }
  return 2 * radius * sum * last / k_steps / 3;
}

/// Lux of a lamp of 1 cd.
std::optional<double> lux(const Light& lamp, double d) {
  const double radius{lamp.radius}, half_width = 0.5 * double{lamp.width},
                                    half_height = 0.5 * double{lamp.height};
  if (!(d > 0)) return std::nullopt;
  switch (lamp.kind) {
    case LightKind::sphere:
      if (d <= radius) return std::nullopt;
      break;
    case LightKind::disk:
      return 1 / (d * d + radius * radius);
    case LightKind::rectangle:
      return from_rectangle(half_width, half_height, d) / (4 * half_width * half_height);
    case LightKind::tube:
      if (d <= radius) return std::nullopt;
      return from_tube(half_width, radius, d) / (4 * half_width * radius);
    case LightKind::directional:
      return 1;
    case LightKind::point:
    case LightKind::spot:
    case LightKind::profile:
      break;
  }
  return 1 / (d * d);
}

/// Area that a lamp with a shape shows to its front.
double shown_area(const Light& lamp) {
  const vec2 half = half_size(lamp);
  const bool is_round = lamp.kind == LightKind::sphere || lamp.kind == LightKind::disk;
  return (is_round ? pi : 4.0) * double{half.x} * double{half.y};
}

}  // namespace

std::optional<LightUnit> unit_named(const std::string& word) {
  for (const LightUnitInfo& info : k_unit_table)
    if (word == info.word) return info.unit;
  return std::nullopt;
}

std::optional<double> unit_factor(const Light& light, LightUnit unit, double distance) {
  const bool is_sun = light.kind == LightKind::directional;
  switch (unit) {
    case LightUnit::candela:
      return is_sun ? std::nullopt : std::optional(1.0);
    case LightUnit::lumen:
      return is_sun ? std::nullopt : std::optional(solid_angle(light));
    case LightUnit::lux:
      return lux(light, distance);
    case LightUnit::watt:
      return (is_sun ? 1 : solid_angle(light)) / k_lumens_per_watt;
    case LightUnit::nit:
      return has_shape(light.kind) ? std::optional(1 / shown_area(light)) : std::nullopt;
  }
  return std::nullopt;
}

std::optional<double> unit_factor(double area, LightUnit unit) {
  switch (unit) {
    case LightUnit::lumen:
      return pi * area;
    case LightUnit::watt:
      return pi * area / k_lumens_per_watt;
    case LightUnit::nit:
      return 1;
    case LightUnit::candela:
    case LightUnit::lux:
      break;
  }
  return std::nullopt;
}

double exact_luminance(const vec3& c) {
  return 0.2126 * double{c.x} + 0.7152 * double{c.y} + 0.0722 * double{c.z};
}

std::optional<double> strength_in(const Light& light, LightUnit unit, double distance) {
  const std::optional<double> factor = unit_factor(light, unit, distance);
  if (!factor) return std::nullopt;
  return *factor * exact_luminance(light.intensity);
}

vec3 with_strength(const vec3& intensity, double factor, double strength) {
  if (float(factor * exact_luminance(intensity)) == float(strength)) return intensity;
  const vec3 tint = tint_of(intensity);
  return float(strength / (factor * exact_luminance(tint))) * tint;
}

LightUnit shown_unit(const Light& light, LightUnit wished, double distance) {
  for (const LightUnit unit : {wished, LightUnit::candela})
    if (unit_factor(light, unit, distance)) return unit;
  return LightUnit::lux;
}

const char* unit_symbol(const Light& light, LightUnit unit) {
  if (unit == LightUnit::watt && light.kind == LightKind::directional) return "W/m\xC2\xB2";
  return info_of(unit).symbol;
}

double emitting_area(const Scene& scene, Id material) {
  double area = 0;
  for (const Instance& instance : scene.instances)
    for (const Primitive& p : shown_parts(scene, instance)) {
      if (p.material != material) continue;
      const glm::dmat4 to_world(instance.to_world);
      for (const uvec3& t : p.triangles) {
        const auto at = [&](uint32_t vertex) {
          return glm::dvec3(to_world * glm::dvec4(glm::dvec3(p.positions[vertex]), 1));
        };
        const glm::dvec3 a = at(t.x);
        area += 0.5 * glm::length(glm::cross(at(t.y) - a, at(t.z) - a));
      }
    }
  return scene.materials.at(material).double_sided ? 2 * area : area;
}

}  // namespace lucerna::scene
