#pragma once
// The watertight triangle test of shaders/lib/bvh.glsl for the host: one ray against up to eight triangles
// at once.
//
// S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. Vertices are moved
// so that the ray starts at the origin and sheared so that it runs along an axis; then the signs of three 2D
// edge functions decide. A vertex has the same 2D point for all of its triangles. Rounding can turn an
// edge function into zero (its two products round to the same float) but never change its sign, and zeros are
// recomputed exactly. So the signs are those of exact geometry on those 2D points, and no ray passes between
// triangles that share an edge or a vertex.
//
// The arithmetic is the shader's, operation by operation: where the device divides with correct rounding
// (lavapipe does), t, u and v are the same bits.
#include <emmintrin.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "bvh/bvh.h"

namespace lucerna::bvh {

/// Triangles tested at once: one AVX register of floats, or two of SSE.
inline constexpr int k_lanes = 8;
typedef float Floats __attribute__((vector_size(4 * k_lanes)));
typedef int32_t Ints __attribute__((vector_size(4 * k_lanes)));
/// A function that is compiled for AVX2 too, where its caller is.
#define LUCERNA_LANES_INLINE [[gnu::always_inline]] inline

/// Up to k_lanes triangles, transposed. Unused lanes repeat another lane, which changes no result.
struct alignas(64) PackedTriangles {
  Floats vertex[3][3];  ///< [vertex][axis]
  uint32_t prim[k_lanes];
};

/// Constants of the test for one ray.
struct ShearedRay {
  float origin[3];  ///< permuted: kx, ky, kz
  float shear[3];
  float inverse[3];                       ///< of the direction, permuted, without infinities
  float limit;                            ///< hits beyond it do not count
  uint32_t best_prim = shared::k_no_hit;  ///< hit at `limit`, if any: an equal distance needs a lower id
  int kx, ky, kz;                         ///< kz: the axis in which the direction is largest
  float along;                            ///< |direction| in that axis

  explicit ShearedRay(const shared::Ray& ray) : limit(before(ray.tmax)) {
    const vec3& d = ray.direction;
    const float x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    kz = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    kx = kz == 2 ? 0 : kz + 1;
    ky = kx == 2 ? 0 : kx + 1;
    along = std::abs(d[kz]);
    shear[2] = 1.0f / d[kz];
    shear[0] = d[kx] * shear[2], shear[1] = d[ky] * shear[2];
    inverse[0] = inverse_of(d[kx]), inverse[1] = inverse_of(d[ky]), inverse[2] = inverse_of(d[kz]);
    origin[0] = ray.origin[kx], origin[1] = ray.origin[ky], origin[2] = ray.origin[kz];
  }
  ShearedRay() = default;

  /// 1 / d, so that no product with it is 0 * infinity.
  static float inverse_of(float d) {
    constexpr float k_least = 1e-25f;
    return 1.0f / (std::abs(d) < k_least ? d < 0 ? -k_least : k_least : d);
  }
  /// The float before a positive one: std::nextafter(x, 0), without its call.
  static float before(float x) { return x > 0 ? std::bit_cast<float>(std::bit_cast<uint32_t>(x) - 1) : x; }
  /// The direction of the line that the test follows: unlike ray.direction's it has no rounding of the shear
  /// against it. Its largest component is 1 or -1.
  vec3 direction() const {
    const float forward = shear[2] < 0 ? -1.0f : 1.0f;
    vec3 d;
    d[kx] = forward * shear[0], d[ky] = forward * shear[1], d[kz] = forward;
    return d;
  }
  /// A distance along that direction within which every triangle lies whose t is at most `t`, in spite of t's
  /// rounding.
  float reach(float t) const { return 1.000002f * (t * along); }
};

/// The lanes whose mask is set, as bits.
LUCERNA_LANES_INLINE uint32_t lanes(const Ints& mask) {
  __m128i half[2];
  static_assert(sizeof(half) == sizeof(mask));
  std::memcpy(half, &mask, sizeof(mask));
  return static_cast<uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(half[0])) |
                               _mm_movemask_ps(_mm_castsi128_ps(half[1])) << 4);
}

/// If r = a * b - c * d is zero, computes it without rounding: both products fit a double.
LUCERNA_LANES_INLINE void refine(Floats& r, const Floats& a, const Floats& b, const Floats& c,
                                 const Floats& d) {
  for (int i = 0; i < k_lanes; ++i) {
    if (r[i] != 0.0f) continue;
    const double p = static_cast<double>(a[i]) * static_cast<double>(b[i]);
    const double q = static_cast<double>(c[i]) * static_cast<double>(d[i]);
    r[i] = static_cast<float>(p - q);
  }
}

LUCERNA_LANES_INLINE void keep_lesser(Floats& a, const Floats& b) { a = b < a ? b : a; }
LUCERNA_LANES_INLINE void keep_greater(Floats& a, const Floats& b) { a = b > a ? b : a; }

/// `t` held to where the ray is within the box around the triangle. In a sliver, t by the edge functions is
/// wrong by much more than the ray's place beside the triangle: by the cube of its length over its area, in
/// roundings. Then a triangle just behind the ray's origin would lie in front of it, or not, as its leaf's
/// box has room. The box has half the margin of those in the tree (margin_of(), bvh/tree.h).
LUCERNA_LANES_INLINE void keep_within_box(const PackedTriangles& triangles, const ShearedRay& ray,
                                          Floats& t) {
  constexpr float k_half_margin = 0x1p-21f, k_slack = 0x1p-21f;
  const int axes[3] = {ray.kx, ray.ky, ray.kz};
  Floats low[3], high[3];
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    low[k] = high[k] = triangles.vertex[0][axes[k]] - ray.origin[k];
#pragma GCC unroll 2
    for (int corner = 1; corner < 3; ++corner) {
      const Floats place = triangles.vertex[corner][axes[k]] - ray.origin[k];
      keep_lesser(low[k], place), keep_greater(high[k], place);
    }
  }
  Floats margin = high[0] - low[0];
  keep_greater(margin, high[1] - low[1]), keep_greater(margin, high[2] - low[2]);
  margin *= k_half_margin;
  Floats enter = Floats{} - std::numeric_limits<float>::infinity(), leave = -enter;
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    const Floats a = (low[k] - margin) * ray.inverse[k], b = (high[k] + margin) * ray.inverse[k];
    keep_greater(enter, a < b ? a : b), keep_lesser(leave, a < b ? b : a);
  }
  keep_greater(t, enter * (1.0f - k_slack)), keep_lesser(t, leave * (1.0f + k_slack));
}

/// t, u, v of the triangles; returns the lanes that are hit with 0 < t <= ray.limit, as bits.
LUCERNA_LANES_INLINE uint32_t intersect(const PackedTriangles& triangles, const ShearedRay& ray, Floats& t,
                                        Floats& u, Floats& v) {
  Floats x[3], y[3], z[3];
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    const Floats along = triangles.vertex[k][ray.kz] - ray.origin[2];
    x[k] = (triangles.vertex[k][ray.kx] - ray.origin[0]) - ray.shear[0] * along;
    y[k] = (triangles.vertex[k][ray.ky] - ray.origin[1]) - ray.shear[1] * along;
    z[k] = ray.shear[2] * along;
  }
  Floats a = x[2] * y[1] - y[2] * x[1];
  Floats b = x[0] * y[2] - y[0] * x[2];
  Floats c = x[1] * y[0] - y[1] * x[0];
  if (lanes((a == 0.0f) | (b == 0.0f) | (c == 0.0f)) != 0) [[unlikely]] {
    refine(a, x[2], y[1], y[2], x[1]);
    refine(b, x[0], y[2], y[0], x[2]);
    refine(c, x[1], y[0], y[1], x[0]);
  }
  const Ints negative = (a < 0.0f) | (b < 0.0f) | (c < 0.0f);
  const Ints positive = (a > 0.0f) | (b > 0.0f) | (c > 0.0f);
  const Floats det = a + b + c;
  Ints hit = ~(negative & positive) & (det != 0.0f);
  if (lanes(hit) == 0) return 0;
  const Floats scale = 1.0f / det;
  t = (a * z[0] + b * z[1] + c * z[2]) * scale;
  u = b * scale, v = c * scale;
  keep_within_box(triangles, ray, t);
  hit &= (t > 0.0f) & (t <= ray.limit);
  return lanes(hit);
}

}  // namespace lucerna::bvh
