#include "scene/range.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/lamp.h"

namespace lucerna::scene {
namespace {

bool finite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool within(float value, float lo, float hi) { return value >= lo && value <= hi; }

/// Each channel is 0 to `most`.
bool within(const vec3& v, float most) {
  return within(v.x, 0, most) && within(v.y, 0, most) && within(v.z, 0, most);
}

void check_place(const char* kind, const std::string& name, const vec3& p) {
  if (!in_range(p))
    throw_error(name.empty() ? kind : fmt::format("{} '{}'", kind, name),
                "its place ({:.4g}, {:.4g}, {:.4g}) is beyond {:.0g} m from the origin", p.x, p.y, p.z,
                k_max_coordinate);
}

}  // namespace

bool in_range(const vec3& p) {
  return within(p.x, -k_max_coordinate, k_max_coordinate) &&
         within(p.y, -k_max_coordinate, k_max_coordinate) && within(p.z, -k_max_coordinate, k_max_coordinate);
}

void check_range(const Camera& c) {
  const std::string where = c.name.empty() ? "camera" : fmt::format("camera '{}'", c.name);
  check_place("camera", c.name, vec3(c.to_world[3]));
  const glm::mat3 axes(c.to_world);
  if (!finite(axes[0]) || !finite(axes[1]) || !finite(axes[2]) || !std::isnormal(glm::determinant(axes)))
    throw_error(where, "its axes are not finite or not independent");
  if (c.orthographic && c.wide != Wide::none)
    throw_error(where, "a {} is not orthographic", k_projection_names[size_t(c.wide)]);
  if (c.orthographic) {
    const bool holds = c.xmag > 0 && c.ymag > 0 && std::max(c.xmag, c.ymag) <= k_max_coordinate;
    if (!holds)
      throw_error(where, "it sees {:.4g} x {:.4g} m, expected above 0 and at most {:.0g}", 2 * c.xmag,
                  2 * c.ymag, 2 * k_max_coordinate);
  } else if (!(c.yfov > 0 && c.yfov <= k_max_yfov)) {
    throw_error(where, "its field of view is {:.4g} radians, expected above 0 and at most {}", c.yfov,
                k_max_yfov);
  }
  if (!within(c.aspect, 0, 1e4f)) throw_error(where, "its aspect is {:.4g}, expected 0 to 10000", c.aspect);
  if (!within(std::abs(c.shift.x), 0, k_max_shift) || !within(std::abs(c.shift.y), 0, k_max_shift))
    throw_error(where, "its lens shift is {:.4g} widths and {:.4g} heights, expected -{} to {}", c.shift.x,
                c.shift.y, k_max_shift, k_max_shift);
  const bool plane = finite(c.section.normal) && std::abs(glm::length(c.section.normal) - 1) < 1e-3f &&
                     within(std::abs(c.section.offset), 0, k_max_coordinate);
  if (c.section.cuts() && !plane)
    throw_error(where, "its section plane has no finite unit normal, or is beyond {:.0g} m from the origin",
                k_max_coordinate);
  const Lens& lens = c.lens;
  if (lens.f_number != 0 && !within(lens.f_number, k_least_f_number, k_max_f_number))
    throw_error(where, "its f-number is {:.4g}, expected {} to {}, or 0 for a pinhole", lens.f_number,
                k_least_f_number, k_max_f_number);
  if (lens.f_number != 0 && !within(lens.focus_distance, k_least_focus, k_max_coordinate))
    throw_error(where, "its plane of focus is {:.4g} m ahead, expected {} to {:.0g}", lens.focus_distance,
                k_least_focus, k_max_coordinate);
  if (lens.blades != 0 && (lens.blades < 3 || lens.blades > k_max_blades))
    throw_error(where, "its aperture has {} blades, expected 3 to {}, or 0 for a round one", lens.blades,
                k_max_blades);
  if (!std::isfinite(lens.rotation)) throw_error(where, "the rotation of its aperture is not finite");
}

void check_range(const Light& l) {
  const std::string where = l.name.empty() ? "light" : fmt::format("light '{}'", l.name);
  check_place("light", l.name, l.position);
  if (!finite(l.direction) || !(glm::length(l.direction) > 0))
    throw_error(where, "its direction is not finite or 0");
  if (!within(l.intensity, k_max_strength))
    throw_error(where, "its intensity ({:.4g}, {:.4g}, {:.4g}) is not between 0 and {:.0g}", l.intensity.x,
                l.intensity.y, l.intensity.z, k_max_strength);
  if (!(l.inner_cone >= 0 && l.inner_cone <= l.outer_cone && l.outer_cone <= 0.5001f * k_pi))
    throw_error(where, "its cones are {:.4g} and {:.4g} radians, expected 0 <= inner <= outer <= pi/2",
                l.inner_cone, l.outer_cone);
  if (l.picture && (l.kind != LightKind::spot || l.outer_cone > k_widest_picture))
    throw_error(where, "it has a picture, but is no spot with a cone of at most {:.4g} radians",
                k_widest_picture);
  if (!can_roll(l)) return;
  const bool across = finite(l.right) && std::abs(glm::length(l.right) - 1) < 1e-3f &&
                      std::abs(glm::dot(l.right, l.direction)) < 1e-3f;
  if (!across) throw_error(where, "the direction of its width is not unit and perpendicular to its own");
  if (l.kind == LightKind::profile && !l.profile) throw_error(where, "it has no distribution");
  if (!has_shape(l.kind)) return;
  const vec2 half = half_size(l);
  const char* size = l.kind == LightKind::rectangle ? "its width and height are"
                     : l.kind == LightKind::tube    ? "its length and diameter are"
                                                    : "its diameters are";
  for (const float value : {2 * half.x, 2 * half.y})
    if (!within(value, k_least_lamp, k_max_lamp))
      throw_error(where, "{} {:.4g} and {:.4g} m, expected {:g} to {:g}", size, 2 * half.x, 2 * half.y,
                  k_least_lamp, k_max_lamp);
}

void check_range(const Material& m) {
  const std::string where = m.name.empty() ? "material" : fmt::format("material '{}'", m.name);
  if (!within(vec3(m.base_color), k_max_strength) || !within(m.roughness, 0, k_max_strength) ||
      !within(m.metallic, 0, k_max_strength))
    throw_error(where, "its colour, roughness or metallic is negative or not finite");
  if (!within(m.clearcoat, 0, 1) || !within(m.clearcoat_roughness, 0, 1))
    throw_error(where, "its clear coat has strength {:.4g} and roughness {:.4g}, expected 0 to 1",
                m.clearcoat, m.clearcoat_roughness);
  if (!within(m.sheen_color, 1) || !within(m.sheen_roughness, 0, 1))
    throw_error(where, "its sheen has a colour or roughness that is not between 0 and 1");
  if (!within(m.anisotropy, 0, 1) || !std::isfinite(m.anisotropy_rotation))
    throw_error(where, "its anisotropy {:.4g} is not between 0 and 1, or its rotation is not finite",
                m.anisotropy);
  if (!within(m.dispersion, 0, k_max_dispersion))
    throw_error(where, "its dispersion is {:.4g}, expected 0 to {}", m.dispersion, k_max_dispersion);
  if (!within(m.diffuse_roughness, 0, 1))
    throw_error(where, "its diffuse roughness is {:.4g}, expected 0 to 1", m.diffuse_roughness);
  if (!within(m.height, m.deep_relief ? 0 : -k_max_height, k_max_height))
    throw_error(where, "the height of its relief is {:.4g} m, expected {} to {}", m.height,
                m.deep_relief ? 0 : -k_max_height, k_max_height);
  if (!within(m.iridescence, 0, 1) || !within(m.iridescence_ior, 1, k_max_strength) ||
      !within(m.iridescence_minimum, 0, k_max_strength) || !within(m.iridescence_maximum, 0, k_max_strength))
    throw_error(where, "its thin film has a strength, index or thickness out of range");
  if (!within(m.emission, k_max_strength))
    throw_error(where, "it emits ({:.4g}, {:.4g}, {:.4g}), expected 0 to {:.0g}", m.emission.x, m.emission.y,
                m.emission.z, k_max_strength);
}

void check_range(const Environment& e) {
  if (!within(e.scale, 0, k_max_strength))
    throw_error("environment", "its factor {:.4g} is not between 0 and {:.0g}", e.scale, k_max_strength);
  if (!std::isfinite(e.rotation)) throw_error("environment", "its rotation is not finite");
}

}  // namespace lucerna::scene
