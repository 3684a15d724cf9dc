// Diffuse reflection of a rough surface: the energy-preserving Oren-Nayar model "EON" and its sampling by a clipped linearly
// transformed cosine (J. Portsmouth, P. Kutz and S. Hill, "EON: A practical energy-preserving rough diffuse BRDF", Journal of
// Computer Graphics Techniques 14(1), 2025; equations in brackets). Roughness 0..1; at 0 it is Lambert's model. White reflects
// all light at every angle.
//
// Everything is relative to Lambert's lobe of the same colour: f = colour / pi times rough_shape(). Local frame: z is the
// normal, on the viewer's side.
#ifndef LUCERNA_LIB_ROUGH_DIFFUSE
#define LUCERNA_LIB_ROUGH_DIFFUSE
#include "lib/math.glsl"

const float k_rough_1 = 0.5 - 2.0 / (3.0 * k_pi);            // [eq. 9]
const float k_rough_2 = 2.0 / 3.0 - 28.0 / (15.0 * k_pi);    // [eq. 18]
const float k_rough_drawn_share = 0.75;  // of the draws of a rough lobe; the others are a cosine's

struct RoughDiffuse {
  vec3 wo;
  float roughness;  // 0: Lambert's
  float a;          // [eq. 9]
  float lost;       // rough_lost() towards wo
  vec3 repeated;    // colour of several bounces over that of one [eq. 19]
};

// 1 - E of a white surface with one bounce, over a * roughness [eqs. 15, 16]; without cancellation. 0 at grazing angles.
float rough_lost(float mu) {
  float s = sqrt(max(0.0, 1.0 - mu * mu));
  float g = s * (acos(min(mu, 1.0)) - s * mu) + (2.0 / 3.0) * (s * mu * (1.0 + s + s * s) / (1.0 + s) - s);
  return max(0.0, k_rough_1 - g * k_inv_pi);
}

RoughDiffuse rough_diffuse(vec3 color, float roughness, vec3 wo) {
  RoughDiffuse d;
  d.wo = wo;
  d.roughness = roughness;
  d.a = 1.0 / (1.0 + k_rough_1 * roughness);
  d.lost = rough_lost(wo.z);
  float average = d.a * (1.0 + k_rough_2 * roughness);
  d.repeated = color * average / (1.0 - color * (1.0 - average));
  return d;
}

// [eqs. 7, 20]
vec3 rough_shape(RoughDiffuse d, vec3 wi) {
  float s = dot(d.wo.xy, wi.xy);
  float t = s > 0.0 ? max(max(d.wo.z, wi.z), 1e-6) : 1.0;
  float once = d.a * (1.0 + d.roughness * s / t);
  return once + d.repeated * (d.a * d.roughness * d.lost * rough_lost(wi.z) / (k_rough_1 - k_rough_2));
}

// What the lobe reflects of uniform light, over its colour.
vec3 rough_albedo(RoughDiffuse d) {
  float lost = d.a * d.roughness * d.lost;
  return 1.0 - lost + d.repeated * lost;
}

// Coefficients of the transformation [listing 3].
vec4 rough_transform(float mu, float r) {
  return vec4(1.0 + r * (0.303392 + (-0.518982 + 0.111709 * mu) * mu + (-0.276266 + 0.335918 * mu) * r),
              r * (-1.16407 + 1.15859 * mu + (0.150815 - 0.150105 * mu) * r) / (mu * mu * mu - 1.43545),
              1.0 + (0.20013 + (-0.506373 + 0.261777 * mu) * mu) * r,
              (0.540852 + (-1.01625 + 0.475392 * mu) * mu) * r / (-1.0743 + mu * (0.0725628 + mu)));
}

// Directions with wo's azimuth as x, and back.
vec2 rough_azimuth(vec3 wo) {
  float l = length(wo.xy);
  return l > 1e-6 ? wo.xy / l : vec2(1.0, 0.0);
}

// Share of the clipped cosine's hemisphere [eq. 44].
float rough_kept(float d) { return 0.5 * (1.0 + inversesqrt(d * d + 1.0)); }

// [listing 4]
vec3 rough_sample(RoughDiffuse d, vec2 u) {
  vec4 m = rough_transform(d.wo.z, d.roughness);
  float radius = sqrt(u.x), phi = 2.0 * k_pi * u.y, x = radius * cos(phi), y = radius * sin(phi);
  x = -mix(sqrt(max(0.0, 1.0 - y * y)), x, rough_kept(m.w));
  vec3 h = vec3(x, y, sqrt(max(0.0, 1.0 - x * x - y * y)));
  vec3 w = normalize(vec3(m.x * h.x + m.y * h.z, m.z * h.y, m.w * h.x + h.z));
  vec2 along = rough_azimuth(d.wo);
  return vec3(along.x * w.x - along.y * w.y, along.y * w.x + along.x * w.y, max(w.z, 1e-6));
}

// Density of rough_sample() per solid angle; 0 below the surface.
float rough_pdf(RoughDiffuse d, vec3 wi) {
  vec4 m = rough_transform(d.wo.z, d.roughness);
  vec2 along = rough_azimuth(d.wo);
  vec3 w = vec3(dot(along, wi.xy), along.x * wi.y - along.y * wi.x, wi.z);
  float det = m.z * (m.x - m.y * m.w);
  vec3 h = vec3(m.z * (w.x - m.y * w.z), (m.x - m.y * m.w) * w.y, m.z * (m.x * w.z - m.w * w.x));
  float l2 = dot(h, h);
  return wi.z > 0.0 ? det * det * max(h.z, 0.0) / (l2 * l2 * k_pi * rough_kept(m.w)) : 0.0;
}
#endif
