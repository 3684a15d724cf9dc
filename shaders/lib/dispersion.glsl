// Dispersion of solids (KHR_materials_dispersion): light that passes one is of a single wavelength from there on.
//
// The first such surface of a path draws a wavelength, uniformly from 400 to 700 nm; every further one uses it. Light that
// passes is multiplied by the wavelength's colour, whose mean over all wavelengths is white: without a deviation the picture
// is that of glass without dispersion. Reflections keep their colour; their small dependence on the wavelength averages out.
// The index follows Cauchy's formula n = A + B / wavelength^2 through the material's index at 587.6 nm, with the Abbe number
// 20 / dispersion: n(486.1 nm) - n(656.3 nm) = (n - 1) dispersion / 20.
#ifndef LUCERNA_LIB_DISPERSION
#define LUCERNA_LIB_DISPERSION
#include "lib/surface.glsl"
#include "lib/sampler.glsl"

const uint k_wavelengths = 4095u;  // that paths distinguish; 0: none yet

uint path_wavelength(PathState p) { return p.bits >> k_path_wavelength_shift & k_wavelengths; }

// 0..1: 400 to 700 nm.
float wavelength_place(uint wavelength) { return (float(wavelength) - 0.5) / float(k_wavelengths); }

// Triangles over the wavelength, each with the mean 1: blue around 466, green around 550, red around 634 nm.
vec3 wavelength_color(float place) {
  const vec3 middle = vec3(0.78, 0.5, 0.22), half_width = vec3(0.22, 0.24, 0.22);
  return max(1.0 - abs(place - middle) / half_width, 0.0) / half_width;
}

float dispersed_ior(float ior, float dispersion, float place) {
  const float d = 0.5876, f = 0.4861, c = 0.6563;  // Fraunhofer's lines [micrometres]
  const float per_line = 1.0 / (f * f) - 1.0 / (c * c);
  float wavelength = mix(0.4, 0.7, place);
  float b = (ior - 1.0) * dispersion / (20.0 * per_line);
  return max(ior + b * (1.0 / (wavelength * wavelength) - 1.0 / (d * d)), 1.0);
}

// Gives a dispersive surface the index for the path's wavelength, and the colour of light that passes it. `random`: of the
// path.
void disperse(inout Surface s, PathState path, Sampler random) {
  s.wavelength = 0u;
  s.spectrum = vec3(1.0);
  float dispersion = texelFetch(scene_materials, int(s.material * k_material_texels + k_material_coat)).w;
  if (dispersion <= 0.0 || !s.parameters.solid) return;
  uint known = path_wavelength(path);
  s.wavelength = known != 0u ? known : 1u + min(uint(sample_2d(random, k_pad_wavelength).x * float(k_wavelengths)), k_wavelengths - 1u);
  float place = wavelength_place(s.wavelength);
  if (known == 0u) s.spectrum = wavelength_color(place);
  s.parameters.ior = dispersed_ior(s.parameters.ior, dispersion, place);
}

// The path's wavelength behind that surface, as bits of PathState::bits. `passes`: the path passes the surface, undiffused.
uint wavelength_bits(Surface s, PathState path, bool passes) {
  return (passes && s.wavelength != 0u ? s.wavelength : path_wavelength(path)) << k_path_wavelength_shift;
}
#endif
