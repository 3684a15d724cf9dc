// Sampling of a rectangle uniformly in solid angle: C. Urena, M. Fajardo and A. King, "An Area-Preserving Parametrization for
// Spherical Rectangles" (2013). Angles are computed as sums of the corners' solid angles, each accurate to a few roundings; a
// rectangle whose solid angle is so small that their difference is not is sampled uniformly in area instead.
#ifndef LUCERNA_LIB_SPHERICAL_RECTANGLE
#define LUCERNA_LIB_SPHERICAL_RECTANGLE
#include "lib/math.glsl"

// A rectangle in front of a point, in a frame with the point as the origin: n points to its plane, at `height` > 0.
struct SphericalRectangle {
  vec3 x, y, n;
  float height;
  vec2 lo, hi;     // along x and y
  float angle;     // solid angle [sr]; 0: sampled in area
};

const float k_least_rectangle_angle = 1e-3;

// Arc tangent to about 2 roundings (S. Moshier, Cephes): the device's may be much less accurate.
float arc_tangent(float q) {
  float a = abs(q);
  bool large = a > 2.414213562373095, middle = a > 0.4142135623730950;
  float x = large ? -1.0 / a : middle ? (a - 1.0) / (a + 1.0) : a;
  float z = x * x;
  float r = (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * x + x;
  r += large ? 0.5 * k_pi : middle ? 0.25 * k_pi : 0.0;
  return q < 0.0 ? -r : r;
}

// Signed solid angle of the rectangle from the foot of the perpendicular to (x, y).
float corner_angle(float x, float y, float height) { return arc_tangent(x * y / (height * sqrt(x * x + y * y + height * height))); }

SphericalRectangle spherical_rectangle(vec3 x, vec3 y, vec3 n, float height, vec2 lo, vec2 hi) {
  float angle = corner_angle(hi.x, hi.y, height) + corner_angle(lo.x, lo.y, height) - corner_angle(hi.x, lo.y, height) -
                corner_angle(lo.x, hi.y, height);
  return SphericalRectangle(x, y, n, height, lo, hi, angle >= k_least_rectangle_angle ? angle : 0.0);
}

// Density per solid angle of the direction to the point (p, height) of the rectangle's plane.
float spherical_rectangle_pdf(SphericalRectangle r, vec2 p) {
  float d2 = dot(p, p) + r.height * r.height;
  vec2 size = r.hi - r.lo;
  return r.angle > 0.0 ? 1.0 / r.angle : d2 * sqrt(d2) / max(r.height * size.x * size.y, 1e-37);
}

// A point of the rectangle, along x and y.
vec2 sample_spherical_rectangle(SphericalRectangle r, vec2 u) {
  if (r.angle == 0.0) return mix(r.lo, r.hi, u);
  float h = r.height, h2 = h * h;
  // Solid angle between the foot of the perpendicular and the wanted x; then x where the strip up to it has that angle.
  float turn = u.x * r.angle + corner_angle(r.lo.x, r.hi.y, h) - corner_angle(r.lo.x, r.lo.y, h);
  float s = sine(0.5 * turn), c = sqrt(max(0.0, 1.0 - s * s));
  float b0 = -r.lo.y * inversesqrt(h2 + r.lo.y * r.lo.y), b1 = r.hi.y * inversesqrt(h2 + r.hi.y * r.hi.y);
  float f = ((1.0 - 2.0 * s * s) * b0 + b1) / (2.0 * s * c);
  float x = sign(f) * h * inversesqrt(max(f * f - h2 / (h2 + r.lo.y * r.lo.y), 1e-37));
  x = s == 0.0 ? 0.0 : clamp(x, r.lo.x, r.hi.x);
  float d2 = x * x + h2;
  float along = mix(r.lo.y * inversesqrt(d2 + r.lo.y * r.lo.y), r.hi.y * inversesqrt(d2 + r.hi.y * r.hi.y), u.y);
  float y = along * sqrt(d2 / max(1.0 - along * along, 1e-37));
  return vec2(x, clamp(y, r.lo.y, r.hi.y));
}

#endif
