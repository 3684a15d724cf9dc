#include "scene/io/portals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scene/range.h"

namespace lucerna::scene {
namespace {

using glm::dvec3;

/// Deviations from a flat rectangle, over its size, that rounding of the file's numbers explains.
constexpr double k_flat = 1e-3, k_full = 1e-2;

enum class Shape { rectangle, other, not_flat, empty, far };

struct Fit {
  Shape shape = Shape::empty;
  dvec3 centre{0}, half_width{0}, half_height{0};
};

/// The smallest rectangle around the corners that has an edge of the triangles at their farthest corner as
/// side: for a rectangle, however it is cut into triangles, the rectangle itself.
Fit fit_rectangle(const std::vector<dvec3>& corners, bool flipped) {
  Fit fit;
  if (corners.empty()) return fit;
  dvec3 middle(0);
  for (const dvec3& p : corners) {
    const dvec3 a = glm::abs(p);
    if (!(std::max({a.x, a.y, a.z}) <= double{k_max_coordinate})) return {.shape = Shape::far};
    middle += p / double(corners.size());
  }
  dvec3 normal(0), farthest = corners[0];
  double area = 0;
  for (size_t i = 0; i < corners.size(); i += 3) {
    const dvec3 twice = glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]);
    normal += 0.5 * twice, area += 0.5 * glm::length(twice);
  }
  for (const dvec3& p : corners)
    if (glm::length(p - middle) > glm::length(farthest - middle)) farthest = p;
  const double size = glm::length(farthest - middle);
  if (!(area > 1e-9 * size * size)) return fit;
  fit.shape = Shape::not_flat;
  if (glm::length(normal) < (1 - k_flat) * area) return fit;
  normal = glm::normalize(flipped ? -normal : normal);
  for (const dvec3& p : corners)
    if (std::abs(glm::dot(p - middle, normal)) > k_flat * size) return fit;

  double smallest = std::numeric_limits<double>::infinity();
  const auto consider = [&](const dvec3& edge) {
    const dvec3 flat = edge - glm::dot(edge, normal) * normal;
    if (glm::length(flat) < 1e-6 * size) return;
    const dvec3 along = glm::normalize(flat), across = glm::cross(normal, along);
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const dvec3& p : corners) {
      const glm::dvec2 at(glm::dot(p - middle, along), glm::dot(p - middle, across));
      low = glm::min(low, at), high = glm::max(high, at);
    }
    const glm::dvec2 half = 0.5 * (high - low), centre = 0.5 * (high + low);
    if (!(half.x * half.y < (1 - 1e-9) * smallest)) return;
    smallest = half.x * half.y;
    fit.centre = middle + centre.x * along + centre.y * across;
    fit.half_width = half.x * along, fit.half_height = half.y * across;
  };
  for (size_t i = 0; i < corners.size(); ++i)
    if (glm::length(corners[i] - farthest) <= 1e-6 * size) {
      const size_t first = i / 3 * 3;
      for (size_t k = 0; k < 3; ++k) consider(corners[first + (k + 1) % 3] - corners[first + k]);
    }
  const double around = 4 * smallest;
  if (!(around > 0) || !std::isfinite(around)) return {};
  fit.shape = std::abs(around - area) <= k_full * around ? Shape::rectangle : Shape::other;
  return fit;
}

/// True if some of the scene's box is in front of the portal.
bool has_front(const Box& box, const Portal& portal) {
  const vec3 normal = normal_of(portal);
  for (int k = 0; k < 8 && !box.empty(); ++k) {
    const vec3 corner(k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y, k & 4 ? box.hi.z : box.lo.z);
    if (glm::dot(corner - portal.centre, normal) > 1e-5f * box.radius()) return true;
  }
  return false;
}

/// True if the portals share more than a hundredth of the smaller one's area, by the box of the one in the
/// axes of the other.
bool overlap(const Portal& a, const Portal& b) {
  const vec3 n = normal_of(a), off = b.centre - a.centre;
  const float size = glm::length(a.half_width) + glm::length(a.half_height);
  if (std::abs(glm::dot(n, normal_of(b))) < 0.999f || std::abs(glm::dot(off, n)) > 0.01f * size) return false;
  float shared = 1;
  for (const vec3& side : {a.half_width, a.half_height}) {
    const vec3 along = glm::normalize(side);
    const float half = std::abs(glm::dot(b.half_width, along)) + std::abs(glm::dot(b.half_height, along));
    const float at = glm::dot(off, along), own = glm::length(side);
    shared *= std::max(0.f, std::min(own, at + half) - std::max(-own, at - half));
  }
  return shared > 0.01f * std::min(area_of(a), area_of(b));
}

}  // namespace

void take_corners(const Document& document, const Mesh& mesh, const dvec3& origin, MarkedPortal& portal) {
  size_t triangles = 0;
  for (const Primitive& primitive : mesh.primitives) triangles += primitive.triangles.size();
  document.budget.take(3 * triangles * sizeof(dvec3), portal.where, "a portal of {} triangles", triangles);
  portal.corners.reserve(3 * triangles);
  for (const Primitive& primitive : mesh.primitives)
    for (const uvec3& t : primitive.triangles)
      for (int k = 0; k < 3; ++k)
        portal.corners.emplace_back(portal.to_world * glm::dvec4(dvec3(primitive.positions[t[k]]), 1) +
                                    glm::dvec4(origin, 0));
}

void load_portals(Document& document, Scene& scene, const std::vector<MarkedPortal>& marked) {
  std::vector<std::string> places;
  const Box box = marked.empty() ? Box() : bounds(scene);
  for (const MarkedPortal& m : marked) {
    const Fit fit = fit_rectangle(m.corners, m.flipped);
    if (fit.shape == Shape::empty) {
      document.warnings.add("{} portals without area: left out", m.where);
    } else if (fit.shape == Shape::far) {
      document.warnings.add("{} portals beyond 1e9 m from the origin: left out", m.where);
    } else if (fit.shape == Shape::not_flat) {
      document.warnings.add("{} portals that are not flat: left out", m.where);
    } else {
      Portal portal{.name = m.name,
                    .centre = vec3(fit.centre - scene.origin),
                    .half_width = vec3(fit.half_width),
                    .half_height = vec3(fit.half_height)};
      if (fit.shape == Shape::other)
        document.warnings.add("{} portals that are not rectangles: the rectangle around them is used",
                              m.where);
      if (!has_front(box, portal)) {
        document.warnings.add("{} portals that face away from all surfaces: left out", m.where);
        continue;
      }
      scene.portals.push_back(std::move(portal));
      places.push_back(m.where);
    }
  }
  if (scene.portals.size() > k_max_portals) {
    std::vector<size_t> order(scene.portals.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      return area_of(scene.portals[a]) > area_of(scene.portals[b]);
    });
    document.warnings.add(fmt::format("{{}} portals more than {}: the smallest are left out", k_max_portals),
                          places[order[k_max_portals]], order.size() - k_max_portals);
    order.resize(k_max_portals);
    std::sort(order.begin(), order.end());
    std::vector<Portal> kept;
    std::vector<std::string> kept_places;
    for (const size_t i : order)
      kept.push_back(std::move(scene.portals[i])), kept_places.push_back(std::move(places[i]));
    scene.portals = std::move(kept), places = std::move(kept_places);
  }
  for (size_t b = 0; b < scene.portals.size(); ++b)
    for (size_t a = 0; a < b; ++a)
      if (overlap(scene.portals[a], scene.portals[b])) {
        document.warnings.add("{} portals that overlap others: all are used", places[b]);
        break;
      }
}

}  // namespace lucerna::scene
