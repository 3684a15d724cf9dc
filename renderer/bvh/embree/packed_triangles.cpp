#include "bvh/embree/packed_triangles.h"

#include <emmintrin.h>

namespace lucerna::bvh {

namespace {

Float4 splat(float f) { return Float4{f, f, f, f}; }
int lanes(Int4 mask) { return _mm_movemask_ps(_mm_castsi128_ps(reinterpret_cast<__m128i&>(mask))); }

/// Where r = a * b - c * d is zero, the same without rounding: both products fit a double.
void refine(Float4& r, Float4 a, Float4 b, Float4 c, Float4 d) {
  for (int i = 0; i < 4; ++i) {
    if (r[i] != 0.0f) continue;
    const double p = static_cast<double>(a[i]) * static_cast<double>(b[i]);
    const double q = static_cast<double>(c[i]) * static_cast<double>(d[i]);
    r[i] = static_cast<float>(p - q);
  }
}

}  // namespace

int intersect(const PackedTriangles& triangles, const ShearedRay& ray, Float4& t, Float4& u, Float4& v) {
  Float4 x[3], y[3], z[3];
  const Float4 ox = splat(ray.origin[0]), oy = splat(ray.origin[1]), oz = splat(ray.origin[2]);
  const Float4 sx = splat(ray.shear[0]), sy = splat(ray.shear[1]), sz = splat(ray.shear[2]);
  for (int k = 0; k < 3; ++k) {
    const Float4 along = triangles.vertex[k][ray.kz] - oz;
    x[k] = (triangles.vertex[k][ray.kx] - ox) - sx * along;
    y[k] = (triangles.vertex[k][ray.ky] - oy) - sy * along;
    z[k] = sz * along;
  }
  Float4 a = x[2] * y[1] - y[2] * x[1];
  Float4 b = x[0] * y[2] - y[0] * x[2];
  Float4 c = x[1] * y[0] - y[1] * x[0];
  if (lanes((a == 0.0f) | (b == 0.0f) | (c == 0.0f)) != 0) [[unlikely]] {
    refine(a, x[2], y[1], y[2], x[1]);
    refine(b, x[0], y[2], y[0], x[2]);
    refine(c, x[1], y[0], y[1], x[0]);
  }
  const Int4 negative = (a < 0.0f) | (b < 0.0f) | (c < 0.0f);
  const Int4 positive = (a > 0.0f) | (b > 0.0f) | (c > 0.0f);
  const Float4 det = a + b + c;
  Int4 hit = ~(negative & positive) & (det != 0.0f);
  if (lanes(hit) == 0) return 0;
  const Float4 scale = 1.0f / det;
  t = (a * z[0] + b * z[1] + c * z[2]) * scale;
  u = b * scale, v = c * scale;
  hit &= (t > 0.0f) & (t <= splat(ray.limit));
  return lanes(hit);
}

}  // namespace lucerna::bvh
