// GGX microfacets (Walter et al. 2007; Heitz 2014, 2018), isotropic, in the local frame with z the normal, and exact
// Fresnel equations. wo.z > 0 throughout.
#ifndef LUCERNA_LIB_MICROFACET
#define LUCERNA_LIB_MICROFACET
#include "lib/math.glsl"

// h need not be normalized to the last bit: sin^2 comes from x and y, since 1 - z^2 has no digits left for small alpha.
float ggx_d(vec3 h, float alpha) {
  float a2 = alpha * alpha;
  float k = a2 * h.z * h.z + dot(h.xy, h.xy);  // cos^2 (a^2 - 1) + 1
  return h.z > 0.0 ? a2 / (k_pi * k * k) : 0.0;
}

float ggx_lambda(float cos_v, float alpha) {
  float c2 = cos_v * cos_v;
  float tan2 = max(0.0, 1.0 - c2) / max(c2, 1e-30);
  return 0.5 * (sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}
float ggx_g1(float cos_v, float alpha) { return 1.0 / (1.0 + ggx_lambda(cos_v, alpha)); }
// Height-correlated masking and shadowing.
float ggx_g2(float cos_o, float cos_i, float alpha) {
  return 1.0 / (1.0 + ggx_lambda(cos_o, alpha) + ggx_lambda(cos_i, alpha));
}

// Density of visible normals per solid angle of h: G1(wo) max(0, wo.h) D(h) / wo.z.
float ggx_visible_pdf(vec3 wo, vec3 h, float alpha) {
  return ggx_g1(wo.z, alpha) * max(0.0, dot(wo, h)) * ggx_d(h, alpha) / wo.z;
}

// Brushed surfaces (Heitz 2014, section 5.4): alpha along x and along y.
float ggx_d(vec3 h, vec2 alpha) {
  vec2 s = h.xy / alpha;
  float k = h.z * h.z + dot(s, s);
  return h.z > 0.0 ? 1.0 / (k_pi * alpha.x * alpha.y * k * k) : 0.0;
}
float ggx_lambda(vec3 v, vec2 alpha) {
  vec2 s = v.xy * alpha;
  return 0.5 * (sqrt(1.0 + dot(s, s) / max(v.z * v.z, 1e-30)) - 1.0);
}
// Visible normals through spherical caps (Dupuy and Benyoub 2023).
// Visible normals through spherical caps (Dupuy and Benyoub 2023).
vec3 ggx_sample_visible(vec3 wo, vec2 alpha, vec2 u) {
  vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
  float phi = 2.0 * k_pi * u.x;
  float z = (1.0 - u.y) * (1.0 + v.z) - v.z;
  float s = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  vec3 h = vec3(s * cos(phi), s * sin(phi), z) + v;
  return normalize(vec3(alpha * h.xy, max(h.z, 1e-20)));
}
vec3 ggx_sample_visible(vec3 wo, float alpha, vec2 u) { return ggx_sample_visible(wo, vec2(alpha), u); }

// Unpolarized reflectance of a dielectric boundary; eta = n_transmitted / n_incident; 1 at total internal reflection.
float fresnel_dielectric(float cos_i, float eta) {
  float sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
  float cos_t = sqrt(max(0.0, 1.0 - sin2_t));
  float parallel = (eta * cos_i - cos_t) / max(eta * cos_i + cos_t, 1e-30);
  float perpendicular = (cos_i - eta * cos_t) / max(cos_i + eta * cos_t, 1e-30);
  return sin2_t >= 1.0 ? 1.0 : 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// Reflectance of a slab with parallel faces, all interreflections summed: 2R/(1+R).
float fresnel_slab(float cos_i, float eta) {
  float r = fresnel_dielectric(cos_i, eta);
  return 2.0 * r / (1.0 + r);
}

float schlick_weight(float cos_i) {
  float m = clamp(1.0 - cos_i, 0.0, 1.0);
  float m2 = m * m;
  return m2 * m2 * m;
}

#endif
