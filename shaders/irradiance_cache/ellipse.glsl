// Region of validity of a record: an ellipse in its tangent plane, and up to the minor radius off that plane. A sphere if
// both axes are equal.
#ifndef LUCERNA_IRRADIANCE_CACHE_ELLIPSE
#define LUCERNA_IRRADIANCE_CACHE_ELLIPSE
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/math.glsl"

// Eigensystem of a Hessian in the tangent plane (xx, xy, yy), |l1| >= |l2|.
struct Principal {
  float strongest;  // |l1|
  float ratio;      // sqrt(|l1 / l2|) >= 1, bounded: axis ratio with equal contributions along both axes
  vec2 along;       // unit direction of the longest axis
};
Principal principal_curvatures(vec3 h) {
  float mean = 0.5 * (h.x + h.z), half_difference = 0.5 * (h.x - h.z);
  float spread = length(vec2(half_difference, h.y));
  Principal p;
  p.strongest = abs(mean) + spread;
  float weakest = max(abs(abs(mean) - spread), p.strongest / square(k_record_ratio));
  p.ratio = p.strongest > 0.0 ? sqrt(p.strongest / weakest) : 1.0;
  // Eigenvector of mean + spread, which is l1 if the mean is not negative.
  float angle = spread > 0.0 ? 0.5 * atan(h.y, half_difference) : 0.0;
  vec2 upper = vec2(cos(angle), sin(angle));
  p.along = mean >= 0.0 ? vec2(-upper.y, upper.x) : upper;
  return p;
}

// Normalized distance from a record's centre: 1 at the border. `shape`: texel 3 (k_record_texels).
float record_distance(vec3 away, vec4 shape) {
  return sqrt(max(0.0, dot(away, away) / square(shape.w) - square(dot(away, shape.xyz))));
}
#endif
