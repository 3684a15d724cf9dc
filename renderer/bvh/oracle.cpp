#include "bvh/oracle.h"

#include <cmath>

namespace lucerna::bvh {

using glm::dvec3;

Crossing cross(const shared::Ray& ray, const vec3& p0, const vec3& p1, const vec3& p2) {
  // Signed volumes of the ray's line with the edges, from the ray's origin; differences of floats are exact
  // enough in double that nothing here is near a rounding limit of single precision.
  const dvec3 o(ray.origin), d(ray.direction);
  const dvec3 a = dvec3(p0) - o, b = dvec3(p1) - o, c = dvec3(p2) - o;
  const dvec3 n = glm::cross(b - a, c - a);
  const double wa = glm::dot(d, glm::cross(c, b)), wb = glm::dot(d, glm::cross(a, c)),
               wc = glm::dot(d, glm::cross(b, a));
  const double det = wa + wb + wc;
  Crossing x;
  if (det == 0 || n == dvec3(0)) return x;
  x.plane = true;
  x.t = glm::dot(a, n) / glm::dot(d, n);
  x.u = wb / det, x.v = wc / det;
  // The volume over |d x e| is the distance between the ray's line and that of the edge e.
  const auto distance = [&](double w, const dvec3& e) {
    const double seen = glm::length(glm::cross(d, e));
    return seen > 0 ? (det > 0 ? w : -w) / seen : 0.0;
  };
  x.margin = std::min({distance(wa, c - b), distance(wb, a - c), distance(wc, b - a)});
  return x;
}

shared::Hit oracle(const Triangles& triangles, Query query, const shared::Ray& ray) {
  shared::Hit hit{0, shared::k_no_hit, 0, 0};
  double best = ray.tmax;
  for (size_t i = 0; i < triangles.count(); ++i) {
    if (query == Query::any_opaque && !triangles.opaque(i)) continue;
    if (query == Query::closest_non_opaque && triangles.opaque(i)) continue;
    const vec3* p = &triangles.vertices[3 * i];
    const Crossing x = cross(ray, p[0], p[1], p[2]);
    if (!x.plane || !(x.t > 0) || !(x.t < best) || x.inside() < 0) continue;
    best = x.t;
    hit = {static_cast<float>(x.t), static_cast<uint32_t>(i), static_cast<float>(x.u),
           static_cast<float>(x.v)};
  }
  return hit;
}

}  // namespace lucerna::bvh
