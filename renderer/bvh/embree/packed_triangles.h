#pragma once
// The watertight triangle test of shaders/lib/bvh.glsl for the host: one ray against up to four triangles at
// once.
//
// S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. Vertices are moved
// so that the ray starts at the origin and sheared so that it runs along an axis; then the signs of three 2D
// edge functions decide. A vertex lands on the same 2D point whichever triangle asks. Rounding can turn an
// edge function into zero (its two products round to the same float) but never change its sign, and zeros are
// recomputed exactly. So the signs are those of exact geometry on those 2D points, and no ray passes between
// triangles that share an edge or a vertex.
//
// The arithmetic is the shader's, operation by operation: where the device divides with correct rounding
// (lavapipe does), t, u and v are the same bits.
#include <cmath>
#include <limits>

#include "bvh/bvh.h"

namespace lucerna::bvh {

typedef float Float4 __attribute__((vector_size(16)));
typedef int32_t Int4 __attribute__((vector_size(16)));

/// Up to four triangles, transposed. Unused lanes repeat another lane, which changes no result.
struct alignas(16) PackedTriangles {
  Float4 vertex[3][3];  ///< [vertex][axis]
  uint32_t prim[4];
};

/// What the test needs to know of a ray, computed once.
struct ShearedRay {
  float origin[3];  ///< permuted: kx, ky, kz
  float shear[3];
  float limit;                            ///< hits beyond it do not count
  uint32_t best_prim = shared::k_no_hit;  ///< hit at `limit`, if any: an equal distance needs a lower id
  int kx, ky, kz;                         ///< kz: the axis in which the direction is largest

  explicit ShearedRay(const shared::Ray& ray) : limit(std::nextafter(ray.tmax, 0.0f)) {
    const vec3& d = ray.direction;
    const float x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    kz = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    kx = kz == 2 ? 0 : kz + 1;
    ky = kx == 2 ? 0 : kx + 1;
    shear[2] = 1.0f / d[kz];
    shear[0] = d[kx] * shear[2], shear[1] = d[ky] * shear[2];
    origin[0] = ray.origin[kx], origin[1] = ray.origin[ky], origin[2] = ray.origin[kz];
  }
  ShearedRay() = default;
};

/// t, u, v of the four triangles; returns the lanes that are hit with 0 < t <= ray.limit, as bits 0..3.
int intersect(const PackedTriangles& triangles, const ShearedRay& ray, Float4& t, Float4& u, Float4& v);

}  // namespace lucerna::bvh
