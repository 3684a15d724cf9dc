#pragma once
// Reference for tests of tracers: every ray against every triangle, in double precision; O(rays x triangles).
#include <algorithm>

#include "bvh/bvh.h"

namespace lucerna::bvh {

/// A ray against one triangle's plane, in double precision.
struct Crossing {
  bool plane = false;   ///< the ray crosses the triangle's plane (it is not parallel and the area is not 0)
  double t = 0;         ///< distance along the ray, in units of its direction's length
  double u = 0, v = 0;  ///< barycentrics of p1 and p2; may lie outside [0, 1]
  /// Smallest barycentric coordinate of the crossing (negative: outside).
  double inside() const { return std::min({u, v, 1 - u - v}); }
  /// Likewise, as a distance in world units across the ray: to the nearest edge's line (negative: outside).
  /// This is what single-precision rounding of the vertices moves, whatever the triangle's shape.
  double margin = 0;
};

Crossing cross(const shared::Ray& ray, const vec3& p0, const vec3& p1, const vec3& p2);

/// The hit by definition of the query (bvh.h): 0 < t < tmax, edges and vertices belong to the triangle, at
/// equal distance (in double precision) the lower id.
shared::Hit oracle(const Triangles& triangles, Query query, const shared::Ray& ray);

}  // namespace lucerna::bvh
