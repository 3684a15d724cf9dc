#include "scene/object_place.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "scene/range.h"

namespace lucerna::scene {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;

/// Exact at multiples of 90 degrees.
double exact_sine(double degrees) {
  const double turn = std::remainder(degrees, 360.0);
  if (std::abs(turn) == 90) return turn < 0 ? -1 : 1;
  if (std::abs(turn) == 180 || turn == 0) return 0;
  return std::sin(glm::radians(turn));
}
double exact_cosine(double degrees) { return exact_sine(degrees + 90); }

std::string named_object(const std::string& name) {
  return name.empty() ? "object" : "object '" + name + "'";
}

bool is_finite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

Box box_of(const Mesh& mesh) {
  Box box;
  for (const Primitive& primitive : mesh.primitives)
    for (const vec3& p : primitive.positions) box.grow(p);
  return box;
}

vec3 middle_of(const Box& box, const mat4& to_world) {
  return vec3(dmat4(to_world) * glm::dvec4(dvec3(box.empty() ? vec3(0) : box.centre()), 1));
}

dmat3 rotation_of(const vec3& turned) {
  const double cx = exact_cosine(double{turned.x}), sx = exact_sine(double{turned.x});
  const double cy = exact_cosine(double{turned.y}), sy = exact_sine(double{turned.y});
  const double cz = exact_cosine(double{turned.z}), sz = exact_sine(double{turned.z});
  const dmat3 x(1, 0, 0, 0, cx, sx, 0, -sx, cx), y(cy, 0, -sy, 0, 1, 0, sy, 0, cy),
      z(cz, sz, 0, -sz, cz, 0, 0, 0, 1);
  return y * x * z;
}

vec3 angles_of(const dmat3& r, const vec3& near) {
  // r[c][r]: the third column is (sin y cos x, -sin x, cos y cos x).
  const double x = std::asin(std::clamp(-r[2][1], -1.0, 1.0));
  dvec3 angles(x, 0, 0);
  if (std::abs(r[2][1]) < 1 - 1e-12) {
    angles.y = std::atan2(r[2][0], r[2][2]);
    angles.z = std::atan2(r[0][1], r[1][1]);
  } else {
    // Only one of y and z is free.
    angles.z = glm::radians(double{near.z});
    const double both = std::atan2(-r[0][2], r[0][0]);
    angles.y = x > 0 ? both + angles.z : both - angles.z;
  }
  const auto nearest = [&](dvec3 degrees) {
    for (int k = 0; k < 3; ++k)
      degrees[k] = double{near[k]} + std::remainder(degrees[k] - double{near[k]}, 360.0);
    return degrees;
  };
  const dvec3 one = nearest(glm::degrees(angles));
  const dvec3 other =
      nearest({180 - glm::degrees(angles.x), 180 + glm::degrees(angles.y), 180 + glm::degrees(angles.z)});
  const auto away = [&](const dvec3& a) { return glm::length(a - dvec3(near)); };
  dvec3 best = away(one) <= away(other) ? one : other;
  for (int k = 0; k < 3; ++k) {
    best[k] = std::remainder(best[k], 360.0);
    if (const double whole = std::round(best[k]); std::abs(best[k] - whole) < 1e-5) best[k] = whole + 0.0;
  }
  return vec3(best);
}

mat4 placed(const mat4& loaded, const Box& box, const ObjectPlace& place) {
  const bool same = place.moved == vec3(0) && place.turned == vec3(0) && place.scaled == vec3(1);
  if (same) return loaded;
  const dvec3 centre(box.empty() ? vec3(0) : box.centre());
  const dmat4 from(loaded);
  const dvec3 middle(from * glm::dvec4(centre, 1));
  const dmat3 turned = rotation_of(place.turned);
  dmat4 to(turned * dmat3(from) * dmat3(place.scaled.x, 0, 0, 0, place.scaled.y, 0, 0, 0, place.scaled.z));
  to[3] = glm::dvec4(middle + dvec3(place.moved) - dmat3(to) * centre, 1);
  // Without turning and scaling the way alone is added: no digit of the rest changes.
  if (place.turned == vec3(0) && place.scaled == vec3(1)) to[3] = from[3] + glm::dvec4(dvec3(place.moved), 0);
  return mat4(to);
}

void check_range(const ObjectPlace& place, const std::string& name) {
  const std::string where = named_object(name);
  const auto reach = [](const vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  if (!is_finite(place.moved) || reach(place.moved) > k_most_way)
    throw_error(where, "moved by ({:.4g}, {:.4g}, {:.4g}) m, expected at most {:.0g}", place.moved.x,
                place.moved.y, place.moved.z, k_most_way);
  if (!is_finite(place.turned) || reach(place.turned) > 1e6f)
    throw_error(where, "its angles are not finite, or beyond a million degrees");
  for (int k = 0; k < 3; ++k) {
    const float factor = std::abs(place.scaled[k]);
    if (!(factor >= k_least_factor && factor <= k_most_factor))
      throw_error(where,
                  "its scale ({:.4g}, {:.4g}, {:.4g}) has a factor that is not {:g} to {:g}, or minus that",
                  place.scaled.x, place.scaled.y, place.scaled.z, k_least_factor, k_most_factor);
  }
}

void check_range(const Instance& instance, const Box& box) {
  const std::string where = named_object(instance.name);
  const dmat4 m(instance.to_world);
  double size = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r])) throw_error(where, "its matrix is not finite");
      if (c < 3) size = std::max(size, std::abs(m[c][r]));
    }
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
    throw_error(where, "the last row of its matrix is not 0 0 0 1");
  if (!(size > 0) || !std::isnormal(static_cast<float>(glm::determinant(dmat3(m)))) ||
      std::abs(glm::determinant(dmat3(m) / size)) < 1e-12)
    throw_error(where, "its matrix cannot be inverted: it is scaled to a plane, a line or a point");
  if (box.empty()) return;
  for (int corner = 0; corner < 8; ++corner) {
    const vec3 p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                 corner & 4 ? box.hi.z : box.lo.z);
    if (!in_range(vec3(m * glm::dvec4(dvec3(p), 1))))
      throw_error(where, "it would be beyond {:.0g} m from the origin", k_max_coordinate);
  }
}

}  // namespace lucerna::scene
