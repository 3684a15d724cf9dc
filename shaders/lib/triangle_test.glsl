// Watertight test of a ray's line against a triangle: no ray passes between adjacent triangles.
#ifndef LUCERNA_LIB_TRIANGLE_TEST
#define LUCERNA_LIB_TRIANGLE_TEST
#include "lib/variants.glsl"
#include "shaders/shared/ray.h"

// Watertight test of Woop, Benthin and Wald (JCGT 2(1), 2013): vertices are moved so that the ray starts at the origin
// and sheared so that it runs along the axis kz in which its direction is largest; the signs of three 2D edge functions
// then decide. `precise` matters: a fused multiply-add would give two triangles different signs for the edge that they
// share. renderer/bvh/embree/packed_triangles.h is the same test, operation by operation.

// By how much of a distance faces of boxes are moved away from each other, so that a box holds what the test accepts of the
// triangles in it (lib/bvh.glsl).
const float k_bvh_slack = 2e-6;

struct ShearedRay {
  vec3 origin;  // kx, ky, kz
  vec3 shear;
  vec3 inverse;  // of the direction, without infinities
  bvec3 along;   // which axis kz is
};

// A direction without zeros, so that no product below is 0 * infinity.
vec3 bvh_inverse(vec3 d) {
  const float tiny = 1e-25;
  bvec3 small = lessThan(abs(d), vec3(tiny));
  return 1.0 / mix(d, mix(vec3(tiny), vec3(-tiny), lessThan(d, vec3(0.0))), small);
}

vec3 bvh_permute(vec3 v, bvec3 along) {
  return along.x ? v.yzx : along.y ? v.zxy : v;
}

ShearedRay bvh_shear(Ray ray) {
  vec3 a = abs(ray.direction);
  ShearedRay s;
  s.along.x = a.x >= a.y && a.x >= a.z;
  s.along.y = !s.along.x && a.y >= a.z;
  s.along.z = !s.along.x && !s.along.y;
  vec3 d = bvh_permute(ray.direction, s.along);
  s.origin = bvh_permute(ray.origin, s.along);
  precise float inverse = 1.0 / d.z;
  precise vec2 shear = d.xy * inverse;
  s.shear = vec3(shear, inverse);
  s.inverse = bvh_inverse(d);
  return s;
}

// The rounding error of the product a * b = p, exactly (T. J. Dekker, Numer. Math. 18, 1971): each factor is cut in two
// halves whose products need no rounding. It needs neither a fused multiply-add, which Vulkan does not promise to be
// fused, nor double precision, which a device may lack.
float bvh_product_error(float a, float b, float p) {
  precise float ca = 4097.0 * a, cb = 4097.0 * b;
  precise float ah = ca - (ca - a), bh = cb - (cb - b);
  precise float al = a - ah, bl = b - bh;
  precise float e = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
  return e;
}

// a * b - c * d. Where both products round to the same float, it is the difference of their errors, so that the sign
// is always exact.
float bvh_difference(float a, float b, float c, float d) {
  precise float p = a * b;
  precise float q = c * d;
  precise float r = p - q;
#if !LUCERNA_ROUNDED_EDGES
  precise float e = bvh_product_error(a, b, p) - bvh_product_error(c, d, q);
  r = r == 0.0 ? e : r;
#endif
  return r;
}

// Clamps `t` to the part of the ray inside the triangle's box, whose corners relative to the ray's origin are `lo` and `hi`.
// For slivers, t from the edge functions is much less accurate than the ray's position relative to the triangle: by the cube
// of its length over its area, in roundings. Then a triangle just behind the ray's origin might count as in front of it,
// depending on the size of its leaf's box. This box has half the margin of those in the tree (margin_of(),
// renderer/bvh/tree.h).
float bvh_within_box(float t, vec3 lo, vec3 hi, vec3 inverse) {
  precise vec3 size = hi - lo;
  precise float margin = 4.76837158203125e-7 * max(size.x, max(size.y, size.z));  // 2^-21
  precise vec3 low = lo - margin, high = hi + margin;
  precise vec3 a = low * inverse, b = high * inverse;
  vec3 enters = min(a, b), leaves = max(a, b);
  precise float enter = max(enters.x, max(enters.y, enters.z)) * 0.999999523162841796875;  // 1 - 2^-21
  precise float leave = min(leaves.x, min(leaves.y, leaves.z)) * 1.000000476837158203125;  // 1 + 2^-21
  return min(max(t, enter), leave);
}

// True if the ray's line hits the triangle; then distance t (of any sign), weights u of p1, v of p2.
bool bvh_test(ShearedRay s, vec3 p0, vec3 p1, vec3 p2, out float t, out float u, out float v) {
  precise vec3 a = bvh_permute(p0, s.along) - s.origin;
  precise vec3 b = bvh_permute(p1, s.along) - s.origin;
  precise vec3 c = bvh_permute(p2, s.along) - s.origin;
  precise vec2 a2 = a.xy - s.shear.xy * a.z;
  precise vec2 b2 = b.xy - s.shear.xy * b.z;
  precise vec2 c2 = c.xy - s.shear.xy * c.z;
  precise float wa = bvh_difference(c2.x, b2.y, c2.y, b2.x);
  precise float wb = bvh_difference(a2.x, c2.y, a2.y, c2.x);
  precise float wc = bvh_difference(b2.x, a2.y, b2.y, a2.x);
  precise float det = wa + wb + wc;
  precise float scale = 1.0 / det;
  precise float along = wa * (s.shear.z * a.z) + wb * (s.shear.z * b.z) + wc * (s.shear.z * c.z);
  precise float distance = along * scale;
  precise float weight_b = wb * scale;
  precise float weight_c = wc * scale;
  t = distance;
  u = weight_b;
  v = weight_c;
  float least = min(wa, min(wb, wc)), most = max(wa, max(wb, wc));
  bool accept = (least >= 0.0 || most <= 0.0) && det != 0.0;
  if (accept) t = bvh_within_box(t, min(a, min(b, c)), max(a, max(b, c)), s.inverse);
  return accept;
}
#endif
