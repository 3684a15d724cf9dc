// Sheen of fibres that stand up from a surface (Estevez and Kulla 2017, as in KHR_materials_sheen). Local frame with z the
// normal.
#ifndef LUCERNA_LIB_SHEEN
#define LUCERNA_LIB_SHEEN
#include "lib/math.glsl"
#include "shaders/shared/bsdf_table.h"

// Equation 3.
float sheen_fit(float x, float share) {
  float a = mix(21.5473, 25.3245, share), b = mix(3.82987, 3.32435, share), c = mix(0.19823, 0.16801, share);
  return a / (1.0 + b * pow(x, c)) + mix(-1.97760, -1.27393, share) * x + mix(-4.32054, -4.85967, share);
}
float sheen_lambda(float cosine, float alpha) {
  float share = square(1.0 - alpha);
  return cosine < 0.5 ? exp(sheen_fit(cosine, share)) : exp(2.0 * sheen_fit(0.5, share) - sheen_fit(1.0 - cosine, share));
}
// f cos_i for a white sheen; both directions above the surface.
float sheen_value(vec3 wo, vec3 wi, float roughness) {
  float alpha = square(max(roughness, k_least_sheen_roughness));
  vec3 h = normalize(wo + wi);
  float d = (2.0 + 1.0 / alpha) * pow(max(dot(h.xy, h.xy), 1e-12), 0.5 / alpha) * 0.5 * k_inv_pi;
  return d / ((1.0 + sheen_lambda(wo.z, alpha) + sheen_lambda(wi.z, alpha)) * 4.0 * max(wo.z, 1e-4));
}

// Uniform over the hemisphere: what sheen reflects lies at grazing angles.
vec3 sheen_sample(vec2 u) {
  float s = sqrt(max(0.0, 1.0 - u.y * u.y)), phi = 2.0 * k_pi * u.x;
  return vec3(s * cos(phi), s * sin(phi), u.y);
}
const float k_sheen_pdf = 0.5 * k_inv_pi;

#endif
