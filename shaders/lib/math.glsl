// Small maths shared by all kernels.
#ifndef LUCERNA_LIB_MATH
#define LUCERNA_LIB_MATH

const float k_pi = 3.14159265358979323846;
const float k_inv_pi = 0.31830988618379067154;
#define k_infinity uintBitsToFloat(0x7f800000u)
const float k_epsilon = 5.9604644775390625e-08;  // half an ulp at 1: the unit roundoff

// gamma(n): bound of the relative error of n floating-point operations (Higham; pbrt 6.8).
float error_gamma(float n) { return n * k_epsilon / (1.0 - n * k_epsilon); }

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }
float max3(vec3 c) { return max(c.x, max(c.y, c.z)); }
float square(float x) { return x * x; }
bool is_finite(vec3 v) {
  // No NaN and no infinity: exponent bits not all set. (isnan may be optimized away.)
  uvec3 e = floatBitsToUint(v) & 0x7f800000u;
  return e.x != 0x7f800000u && e.y != 0x7f800000u && e.z != 0x7f800000u;
}

// Sine of -pi/2..pi/2 by its series: the device's function may be wrong by as much as a small angle.
float sine(float x) {
  float q = x * x;
  return x * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0 * (1.0 - q / 110.0)))));
}

// Orthonormal basis around n (Duff et al. 2017), without a branch.
void make_basis(vec3 n, out vec3 t, out vec3 b) {
  float s = n.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (s + n.z);
  float c = n.x * n.y * a;
  t = vec3(1.0 + s * n.x * n.x * a, s * c, -s * n.x);
  b = vec3(c, s + n.y * n.y * a, -n.y);
}

// Concentric map of the unit square to the unit disk (Shirley and Chiu 1997).
vec2 sample_disk(vec2 u) {
  vec2 o = 2.0 * u - 1.0;
  bool wide = abs(o.x) > abs(o.y);
  float r = wide ? o.x : o.y;
  float ratio = wide ? o.y / (o.x == 0.0 ? 1.0 : o.x) : o.x / (o.y == 0.0 ? 1.0 : o.y);
  float phi = wide ? 0.25 * k_pi * ratio : 0.5 * k_pi - 0.25 * k_pi * ratio;
  return r * vec2(cos(phi), sin(phi));
}

// Cosine-distributed direction around +z; pdf cos/pi per solid angle.
vec3 sample_cosine(vec2 u) {
  vec2 d = sample_disk(u);
  return vec3(d, sqrt(max(0.0, 1.0 - dot(d, d))));
}

#endif
