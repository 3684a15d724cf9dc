// Reflectance of a thin transparent film between air and a base (Belcour and Barla 2017, as in the appendix of
// KHR_materials_iridescence): Airy's sum with the first two orders of interference, integrated over the spectrum by Gaussians
// fitted to the CIE's colour matching functions.
#ifndef LUCERNA_LIB_THIN_FILM
#define LUCERNA_LIB_THIN_FILM
#include "lib/microfacet.glsl"

float film_schlick(float f0, float cosine) { return f0 + (1.0 - f0) * schlick_weight(cosine); }
vec3 film_schlick(vec3 f0, float cosine) { return f0 + (1.0 - f0) * schlick_weight(cosine); }

// Linear Rec.709 response to light whose phase is `shift` plus 2 pi over each wavelength times the path difference [nm].
vec3 film_response(float path_difference, vec3 shift) {
  float phase = 2.0 * k_pi * path_difference * 1e-9;
  vec3 variance = vec3(4.3278e9, 9.3046e9, 6.6121e9), at = vec3(1.6810e6, 1.7953e6, 2.2084e6);
  vec3 xyz = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13) * sqrt(2.0 * k_pi * variance) * cos(at * phase + shift) *
             exp(-phase * phase * variance);
  // The red function's second peak.
  xyz.x += 9.7470e-14 * sqrt(2.0 * k_pi * 4.5282e9) * cos(2.2399e6 * phase + shift.x) * exp(-4.5282e9 * phase * phase);
  xyz /= 1.0685e-7;
  return vec3(dot(xyz, vec3(3.2404542, -1.5371385, -0.4985314)), dot(xyz, vec3(-0.9692660, 1.8760108, 0.0415560)),
              dot(xyz, vec3(0.0556434, -0.2040259, 1.0572252)));
}

// f0: of the base in air; thickness in nanometres. 0 to 1 in each channel.
vec3 film_fresnel(float cosine, float film_ior, float thickness, vec3 f0) {
  // A film that vanishes has the index of air.
  float n = mix(1.0, film_ior, smoothstep(0.0, 0.03, thickness));
  float cos2 = 1.0 - (1.0 - cosine * cosine) / (n * n);
  if (cos2 <= 0.0) return vec3(1.0);
  float inner = sqrt(cos2);
  float r12 = film_schlick(square((n - 1.0) / (n + 1.0)), cosine);
  float t = 1.0 - r12;
  vec3 root = sqrt(clamp(f0 + 1e-4, vec3(0.0), vec3(0.9999)));
  vec3 base_ior = (1.0 + root) / (1.0 - root);
  vec3 step = (base_ior - n) / (base_ior + n);
  vec3 r23 = film_schlick(step * step, inner);
  // Reflection at a denser medium turns the phase by half a wave.
  vec3 shift = vec3(n < 1.0 ? 0.0 : k_pi) + k_pi * vec3(lessThan(base_ior, vec3(n)));
  vec3 r123 = clamp(r12 * r23, vec3(0.0), vec3(0.9999)), amplitude = sqrt(r123);
  vec3 inside = t * t * r23 / (1.0 - r123);
  vec3 reflected = r12 + inside, order = inside - t;
  float path_difference = 2.0 * n * thickness * inner;
  for (float m = 1.0; m <= 2.0; m += 1.0) {
    order *= amplitude;
    reflected += order * 2.0 * film_response(m * path_difference, m * shift);
  }
  return clamp(reflected, vec3(0.0), vec3(1.0));
}

#endif
