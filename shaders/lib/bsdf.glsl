// The surface model: glTF metallic-roughness with transmission, as a sum of lobes, each with its label.
//
//   conductor m            GGX, F = base + (1-base) w                                       G (S when smooth)
//   dielectric (1-m)(1-t)  GGX, F = f0 + (f90-f0) w                                         G (S)
//                          Lambert base/pi, coupled by (1-E(wo))(1-E(wi))/(1-E_avg)         D
//                          (rough: lib/rough_diffuse.glsl times that coupling)
//                          diffuse transmission, coupled likewise                           D
//   glass (1-m)t           GGX reflection and refraction with exact Fresnel (solid), or slab (thin)   G (S)
//   over these, from below:
//   sheen                  fibres (lib/sheen.glsl)                                                     G
//   clear coat             GGX of index 1.5 about a normal of its own                                  G (S)
//
// What lies below layers is seen through them. With T(w) = 1 - E(w), E the layers' directional albedo: the diffuse lobes,
// coupled with the dielectric's reflection, are scaled by c(wo) c(wi) / c_avg as without layers, c = T (1-E_dielectric); all
// others by min(T(wo), T(wi)), the rule of KHR_materials_sheen. Both are reciprocal, and never reflect more than arrives.
// Along a brushed surface (anisotropy) GGX has two widths; its tabulated albedo is the mean of those of both. A thin film
// (iridescence) replaces Fresnel's factor of conductor, dielectric and glass (lib/thin_film.glsl).
// With KHR_materials_specular each glass face reflects f (f0' + (1-f0') (F-f0)/(1-f0)) in place of F, f0' = min(1, f0 color),
// like the extension with Schlick's (F-f0)/(1-f0); it transmits the rest, channel by channel. Total reflection stays total
// (LUCERNA_GLASS_SPECULAR).
// w = (1 - wo.h)^5. Every GGX lobe has its multiple-scattering complement (Kulla and Conty 2017):
//   f_ms = F_ms (1-E1(wo))(1-E1(wi)) / (pi (1-E1_avg)),  F_ms = F_avg^2 E1_avg / (1 - F_avg (1-E1_avg)).
// For solid glass the missing energy leaves on both sides in proportion to the sides' etendue (1-E_avg) n^2, the split
// that satisfies both energy conservation and reciprocity f(wi->wo)/n_o^2 = f(wo->wi)/n_i^2.
//
// Local frame: z is the shading normal on wo's side, so wo.z > 0. Radiance transport: refraction includes (n_o/n_i)^2.
// Compiled in only if the scene needs it: LUCERNA_SPECULAR, LUCERNA_SOLID_GLASS, LUCERNA_THIN_GLASS,
// LUCERNA_DIFFUSE_TRANSMISSION, LUCERNA_ROUGH_DIFFUSE, LUCERNA_CLEARCOAT, LUCERNA_SHEEN, LUCERNA_ANISOTROPY,
// LUCERNA_IRIDESCENCE. The last four need LUCERNA_SPECULAR.
#ifndef LUCERNA_LIB_BSDF
#define LUCERNA_LIB_BSDF
#include "lib/variants.glsl"
#include "shaders/shared/bsdf_table.h"
#include "lib/microfacet.glsl"
#if LUCERNA_SHEEN
#include "lib/sheen.glsl"
#endif
#if LUCERNA_IRIDESCENCE
#include "lib/thin_film.glsl"
#endif
#if LUCERNA_ROUGH_DIFFUSE
#include "lib/rough_diffuse.glsl"
#endif

#if LUCERNA_SPECULAR || LUCERNA_GLASS
uniform samplerBuffer bsdf_table;
#endif

const uint k_event_diffuse = 0u;
const uint k_event_glossy = 1u;
const uint k_event_specular = 2u;
const uint k_event_null = 3u;   // no letter: undeflected through a smooth thin wall

// Indices of refraction closer than this (relative) are the same medium: the half vector of refraction, wo + eta wi, has no
// direction left there.
const float k_same_medium = 1e-3;

// The material at a point.
struct SurfaceParameters {
  vec3 base;
  float metallic;
  float roughness;
  float ior;             // 0: F = 1
  float specular;
  vec3 specular_color;
  float transmission;
  float diffuse_transmission;
  vec3 diffuse_transmission_color;
  bool solid;
  bool inside;           // wo is on the inner side of a solid
  int glass_row;
#if LUCERNA_ROUGH_DIFFUSE
  float diffuse_roughness;
#endif
#if LUCERNA_CLEARCOAT
  float clearcoat;       // strength; 0 on the inner side of a solid
  float clearcoat_roughness;
  vec3 clearcoat_normal; // in the local frame, on wo's side: the cosine of wo is above 0
#endif
#if LUCERNA_SHEEN
  vec3 sheen;
  float sheen_roughness;
#endif
#if LUCERNA_ANISOTROPY
  float anisotropy;
  vec2 grain;            // direction of the greater width in the local frame, unit
#endif
#if LUCERNA_IRIDESCENCE
  float film;            // strength
  float film_ior, film_thickness;
#endif
};

const float k_coat_f0 = 0.04;  // of index 1.5
#if LUCERNA_ROUGH_DIFFUSE
const float k_rough_excess = 0.0088;  // of energy, per roughness; computed by quadrature over all angles
#endif

// Reflectance of glass: one value for all channels, or one for each. Choices use glass_choice().
#if LUCERNA_GLASS_SPECULAR
#define GLASS_VALUE vec3
float glass_choice(vec3 value) { return luminance(value); }
#else
#define GLASS_VALUE float
float glass_choice(float value) { return value; }
#endif

// Constants for one wo.
struct Bsdf {
  vec3 diffuse;          // f_D on wo's side = diffuse * coupling(wi) / pi
  vec3 transmitted;      // f_D on the other side, likewise
  // Reflectance and transmittance of these for uniform light from a side. For other light it is an
  // approximation, exact without a coat: the variation of a coat's coupling with wi is neglected.
  vec3 diffuse_albedo, transmitted_albedo;
#if LUCERNA_ROUGH_DIFFUSE
  RoughDiffuse rough;    // factor of the diffuse lobe on wo's side
#endif
  float alpha;
#if LUCERNA_SPECULAR || LUCERNA_GLASS
  float roughness;
  bool delta;
#endif
#if LUCERNA_SPECULAR
  vec3 f0, f90;          // of conductor and dielectric together, weighted
  vec3 f_ms;             // their complement, weighted, times (1-E1(wo)) / (pi (1-E1_avg))
  vec3 d_f0, d_f90, d_f_ms;  // of the dielectric alone, for the coupling
#endif
#if LUCERNA_LAYERS
  float below;           // transmittance of the layers, towards wo
  float p_coat, p_sheen;
#endif
#if LUCERNA_CLEARCOAT
  float coat, coat_roughness, coat_below;  // coat_below: transmittance of the coat alone, towards wo
  vec3 coat_normal;
  bool coat_delta;
#endif
#if LUCERNA_SHEEN
  vec3 sheen;
  float sheen_roughness;
#endif
#if LUCERNA_ANISOTROPY
  bool brushed;
  vec2 alphas, grain;    // along the grain and across
  float roughness_across;
#endif
#if LUCERNA_IRIDESCENCE
  float film, film_ior, film_thickness;
  float metal;           // weight of the conductor
  vec3 metal_f0;
  float dielectric;      // weight of the dielectric
#endif
#if LUCERNA_GLASS
#if LUCERNA_GLASS_SPECULAR
  vec3 face_0, face_1;   // a face reflects face_0 + face_1 F
#endif
  float glass;           // weight
  vec3 tint;             // colour of transmitted light
  float eta;             // n on the other side / n on wo's side
  bool solid;
  bool glass_delta;      // smooth, or a solid that does not refract: then facets do not deflect rays, however rough
  uint table_here, table_there;
  GLASS_VALUE ms_reflected, ms_transmitted;  // complement, times (1-E(wo)); radiance scale included
#endif
  // Probabilities of the lobes; they sum to 1, or are all 0 for a black surface.
  float p_diffuse, p_transmitted, p_specular, p_specular_ms, p_glass, p_glass_ms;
};

struct BsdfValue {
  vec3 diffuse;          // f_D |cos|
  vec3 glossy;           // f_G |cos|
  float pdf;             // of the mixture of all lobes, per solid angle; deltas excluded
};

struct BsdfSample {
  vec3 wi;
  vec3 weight;           // f_label |cos| / (p_label pdf_mix), or the delta's weight / probability
  float pdf;             // pdf_mix; 0 for deltas
  uint event;            // label
  float eta2;            // (n_o/n_i)^2 contained in weight; 1 unless refracted
  bool transmitted;      // wi is on the other side
#if LUCERNA_CLEARCOAT
  bool mirrored_by_coat; // a delta about the coat's normal
#endif
};

#if LUCERNA_SPECULAR || LUCERNA_GLASS
struct TablePlace {
  int cell, row;
  vec2 at;  // within the cell
};
TablePlace table_place(float mu, float roughness) {
  vec2 p = vec2(sqrt(clamp(mu, 0.0, 1.0)), clamp(roughness, 0.0, 1.0)) * vec2(k_table_mu - 1u, k_table_rough - 1u);
  vec2 low = min(floor(p), vec2(k_table_mu - 2u, k_table_rough - 2u));
  int row = int(low.y);
  return TablePlace(row * int(k_table_mu - 1u) + int(low.x), row, p - low);
}
// Single-scattering reflectance of a GGX reflector: (of f0, of f90).
vec2 specular_albedo(float mu, float roughness, bool delta) {
  TablePlace p = table_place(mu, roughness);
  vec4 a = texelFetch(bsdf_table, 2 * p.cell), b = texelFetch(bsdf_table, 2 * p.cell + 1);
  vec4 row = mix(a, b, p.at.y);
  float w = schlick_weight(mu);
  return delta ? vec2(1.0 - w, w) : mix(row.xy, row.zw, p.at.x);
}
vec2 specular_average(float roughness, bool delta) {
  TablePlace p = table_place(0.0, roughness);
  vec4 a = texelFetch(bsdf_table, int(2u * k_table_cells) + p.row);
  return delta ? vec2(20.0, 1.0) / 21.0 : mix(a.xy, a.zw, p.at.y);
}
#endif
#if LUCERNA_SOLID_GLASS || LUCERNA_SHEEN
float table_cell(uint first, TablePlace p) {
  vec4 e = texelFetch(bsdf_table, int(first) + p.cell);
  vec2 row = mix(e.xy, e.zw, p.at.y);
  return mix(row.x, row.y, p.at.x);
}
float table_row(uint first, TablePlace p) {
  vec4 e = texelFetch(bsdf_table, int(first + k_table_cells) + p.row);
  return mix(e.x, e.y, p.at.y);
}
#endif
#if LUCERNA_SOLID_GLASS
GLASS_VALUE glass_albedo(Bsdf b, uint table, float mu, float roughness) {
  TablePlace p = table_place(mu, roughness);
  uint first = k_table_first_glass + (table - 1u) * k_table_glass_texels;
#if LUCERNA_GLASS_SPECULAR
  return table_cell(first, p) + b.face_0 * table_cell(first + k_table_glass_block, p) +
         (b.face_1 - 1.0) * table_cell(first + 2u * k_table_glass_block, p);
#else
  return table_cell(first, p);
#endif
}
GLASS_VALUE glass_average(Bsdf b, uint table, float roughness) {
  TablePlace p = table_place(0.0, roughness);
  uint first = k_table_first_glass + (table - 1u) * k_table_glass_texels;
#if LUCERNA_GLASS_SPECULAR
  return table_row(first, p) + b.face_0 * table_row(first + k_table_glass_block, p) +
         (b.face_1 - 1.0) * table_row(first + 2u * k_table_glass_block, p);
#else
  return table_row(first, p);
#endif
}
#endif

#if LUCERNA_SPECULAR || LUCERNA_GLASS
// Complement's Fresnel factor for Schlick's F; e1 = E1_avg.
vec3 complement_fresnel(vec3 f0, vec3 f90, float e1) {
  vec3 average = f0 + (f90 - f0) * (1.0 / 21.0);
  return average * average * e1 / (1.0 - average * (1.0 - e1));
}
#endif

#if LUCERNA_SPECULAR || LUCERNA_GLASS
// Of the base's reflection.
vec2 base_albedo(Bsdf b, float mu) {
  vec2 t = specular_albedo(mu, b.roughness, b.delta);
#if LUCERNA_ANISOTROPY
  if (b.brushed) t = 0.5 * (t + specular_albedo(mu, b.roughness_across, false));
#endif
  return t;
}
vec2 base_average(Bsdf b) {
  vec2 t = specular_average(b.roughness, b.delta);
#if LUCERNA_ANISOTROPY
  if (b.brushed) t = 0.5 * (t + specular_average(b.roughness_across, false));
#endif
  return t;
}
#endif

#if LUCERNA_SPECULAR
// (1 - E(wi)) of the dielectric's reflection, E with its complement.
vec3 dielectric_transmittance(Bsdf b, float mu) {
  vec2 t = base_albedo(b, mu);
  vec3 reflected = b.d_f0 * t.x + b.d_f90 * t.y;
#if LUCERNA_IRIDESCENCE
  if (b.film > 0.0)
    reflected = mix(reflected, (t.x + t.y) * film_fresnel(mu, b.film_ior, b.film_thickness, b.d_f0), b.film);
#endif
  return max(vec3(0.0), 1.0 - reflected - b.d_f_ms * (1.0 - t.x - t.y));
}
// Fresnel factor of conductor and dielectric, weighted.
vec3 specular_fresnel(Bsdf b, float cosine) {
  vec3 f = b.f0 + (b.f90 - b.f0) * schlick_weight(cosine);
#if LUCERNA_IRIDESCENCE
  if (b.film > 0.0)
    f = mix(f,
            b.metal * film_fresnel(cosine, b.film_ior, b.film_thickness, b.metal_f0) +
                b.dielectric * b.d_f90 * film_fresnel(cosine, b.film_ior, b.film_thickness, b.d_f0),
            b.film);
#endif
  return f;
}
#endif

#if LUCERNA_CLEARCOAT
float clearcoat_albedo(Bsdf b, float mu) {
  vec2 t = specular_albedo(mu, b.coat_roughness, b.coat_delta);
  return b.coat * (k_coat_f0 * t.x + t.y);
}
// Transmittance along w, on either side.
float clearcoat_below(Bsdf b, vec3 w) {
  return 1.0 - clearcoat_albedo(b, max(dot(vec3(w.xy, abs(w.z)), b.coat_normal), 0.0));
}
#endif
#if LUCERNA_SHEEN
float sheen_albedo(float mu, float roughness) {
  return table_cell(k_table_schlick_texels, table_place(mu, max(roughness, k_least_sheen_roughness)));
}
float sheen_below(Bsdf b, float mu) { return 1.0 - max3(b.sheen) * min(sheen_albedo(mu, b.sheen_roughness), 1.0); }
#endif
#if LUCERNA_LAYERS
float layers_below(Bsdf b, vec3 w) {
  float t = 1.0;
#if LUCERNA_CLEARCOAT
  t *= clearcoat_below(b, w);
#endif
#if LUCERNA_SHEEN
  t *= sheen_below(b, abs(w.z));
#endif
  return t;
}
#endif

#if LUCERNA_LAYERS || LUCERNA_IRIDESCENCE
// Cosine-weighted average of c = T (1-E_dielectric): four Gauss points over the cosine.
vec3 coupled_average(Bsdf b) {
  vec4 at = vec4(0.06943184, 0.33000948, 0.66999052, 0.93056816), weight = vec4(0.17392742, 0.32607258, 0.32607258, 0.17392742);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    vec3 c = dielectric_transmittance(b, at[i]);
#if LUCERNA_CLEARCOAT
    c *= 1.0 - clearcoat_albedo(b, at[i]);
#endif
#if LUCERNA_SHEEN
    c *= sheen_below(b, at[i]);
#endif
    sum += 2.0 * at[i] * weight[i] * c;
  }
  return sum;
}
#endif

Bsdf make_bsdf(SurfaceParameters s, vec3 wo) {
  Bsdf b;
  float mu = wo.z;
  float dielectric = (1.0 - s.metallic) * (1.0 - s.transmission);
  b.alpha = s.roughness * s.roughness;
  b.diffuse = dielectric * s.base;
  b.transmitted = vec3(0.0);
#if LUCERNA_DIFFUSE_TRANSMISSION
  b.transmitted = dielectric * s.diffuse_transmission * s.diffuse_transmission_color;
  b.diffuse *= 1.0 - s.diffuse_transmission;
#endif
  b.p_specular = 0.0;
  b.p_specular_ms = 0.0;
  b.p_glass = 0.0;
  b.p_glass_ms = 0.0;
#if LUCERNA_ROUGH_DIFFUSE
  b.rough = rough_diffuse(s.base, s.diffuse_roughness, wo);
#endif
#if LUCERNA_SPECULAR || LUCERNA_GLASS
  b.delta = b.alpha < k_delta_alpha;
  b.roughness = s.roughness;
#if LUCERNA_ANISOTROPY
  // KHR_materials_anisotropy; glass is never brushed.
  b.brushed = s.anisotropy > 0.0 && s.transmission < 1.0;
  b.grain = s.grain;
  b.alphas = vec2(max(mix(b.alpha, 1.0, square(s.anisotropy)), k_delta_alpha), max(b.alpha, k_delta_alpha));
  if (b.brushed) b.delta = false;
  if (b.brushed) b.roughness = sqrt(b.alphas.x);
  b.roughness_across = sqrt(b.alphas.y);
#endif
  vec4 t = vec4(base_albedo(b, mu), base_average(b));
  float e1 = t.x + t.y, e1_average = t.z + t.w;
  float missing = max(0.0, 1.0 - e1), missing_average = max(1e-6, 1.0 - e1_average);
#endif
#if LUCERNA_SPECULAR
  float r = (s.ior - 1.0) / (s.ior + 1.0);
  b.d_f0 = min(vec3(1.0), (s.ior == 0.0 ? 1.0 : r * r) * s.specular_color) * s.specular;
  b.d_f90 = vec3(s.specular);
  vec3 m_ms = complement_fresnel(s.base, vec3(1.0), e1_average);
  b.d_f_ms = complement_fresnel(b.d_f0, b.d_f90, e1_average);
  b.f0 = s.metallic * s.base + dielectric * b.d_f0;
  b.f90 = vec3(s.metallic) + dielectric * b.d_f90;
  vec3 ms = s.metallic * m_ms + dielectric * b.d_f_ms;
  b.f_ms = ms * missing / (k_pi * missing_average);
#if LUCERNA_IRIDESCENCE
  b.film = s.film;
  b.film_ior = s.film_ior;
  b.film_thickness = s.film_thickness;
  b.metal = s.metallic;
  b.metal_f0 = s.base;
  b.dielectric = dielectric;
#endif
  vec3 below = dielectric_transmittance(b, mu);
  vec3 below_average = max(vec3(1e-6), 1.0 - b.d_f0 * t.z - b.d_f90 * t.w - b.d_f_ms * (1.0 - e1_average));
#if LUCERNA_LAYERS
  b.p_coat = 0.0;
  b.p_sheen = 0.0;
#if LUCERNA_CLEARCOAT
  b.coat = s.clearcoat;
  b.coat_roughness = s.clearcoat_roughness;
  b.coat_delta = square(s.clearcoat_roughness) < k_delta_alpha;
  b.coat_normal = s.clearcoat_normal;
  b.p_coat = clearcoat_albedo(b, dot(wo, b.coat_normal));
  b.coat_below = 1.0 - b.p_coat;
#endif
#if LUCERNA_SHEEN
  b.sheen = s.sheen;
  b.sheen_roughness = s.sheen_roughness;
  b.p_sheen = luminance(s.sheen) * min(sheen_albedo(mu, s.sheen_roughness), 1.0);
#if LUCERNA_CLEARCOAT
  b.p_sheen *= b.coat_below;
#endif
#endif
  b.below = layers_below(b, wo);
  below *= b.below;
#endif
#if LUCERNA_LAYERS || LUCERNA_IRIDESCENCE
  bool layered = false;
#if LUCERNA_CLEARCOAT
  layered = layered || s.clearcoat > 0.0;
#endif
#if LUCERNA_SHEEN
  layered = layered || max3(s.sheen) > 0.0;
#endif
#if LUCERNA_IRIDESCENCE
  layered = layered || s.film > 0.0;
#endif
  if (layered) below_average = max(vec3(1e-6), coupled_average(b));
#endif
  b.diffuse *= below / below_average;
  b.transmitted *= below / below_average;
  b.p_specular = luminance(b.f0 * t.x + b.f90 * t.y);
#if LUCERNA_IRIDESCENCE
  if (b.film > 0.0) b.p_specular = luminance(specular_fresnel(b, mu)) * e1;
#endif
  b.p_specular_ms = b.delta ? 0.0 : luminance(ms) * missing;
  // Total reflectance of the lobe, not only its prefactor: the coupling averages to below_average.
  b.diffuse_albedo = b.diffuse * below_average;
  b.transmitted_albedo = b.transmitted * below_average;
#else
  b.diffuse_albedo = b.diffuse;
  b.transmitted_albedo = b.transmitted;
#endif
#if LUCERNA_ROUGH_DIFFUSE
  if (s.diffuse_roughness > 0.0) {
    b.diffuse_albedo *= rough_albedo(b.rough);
#if LUCERNA_SPECULAR
    // A rough lobe has more light where the coupling lets more pass, near the normal: at most this much more.
    float excess = 1.0 + s.specular * k_rough_excess * s.diffuse_roughness / (1.0 + 0.3 * s.diffuse_roughness);
    b.diffuse /= excess;
    b.diffuse_albedo /= excess;
#endif
  }
#endif
  b.p_diffuse = luminance(b.diffuse_albedo);
  b.p_transmitted = luminance(b.transmitted_albedo);
#if LUCERNA_GLASS
  b.glass = (1.0 - s.metallic) * s.transmission;
  b.tint = s.base;
  b.solid = s.solid;
  float ior = max(s.ior, 1.0);
  b.eta = s.solid ? (s.inside ? 1.0 / ior : ior) : ior;
  // Thin: E1 of a mirror; average slab reflectance through the fit of Kulla and Conty to the Fresnel average.
  GLASS_VALUE average = GLASS_VALUE((ior - 1.0) / (4.08567 + 1.00071 * ior));
#if LUCERNA_GLASS_SPECULAR
  float f_0 = square((ior - 1.0) / (ior + 1.0));
  vec3 own_0 = min(vec3(1.0), f_0 * s.specular_color);
  b.face_1 = s.specular * (1.0 - own_0) / (1.0 - f_0);
  b.face_0 = s.specular * own_0 - b.face_1 * f_0;
  average = b.face_0 + b.face_1 * average;
#endif
  GLASS_VALUE slab = 2.0 * average / (1.0 + average);
  float k = missing / (k_pi * missing_average);
  b.ms_reflected = k * slab;
  b.ms_transmitted = k * (1.0 - slab);
  b.table_here = 0u;
  b.table_there = 0u;
#if LUCERNA_SOLID_GLASS
  if (s.solid) {
    uint outside = 1u + 2u * uint(max(s.glass_row, 0));
    b.table_here = s.inside ? outside + 1u : outside;
    b.table_there = s.inside ? outside : outside + 1u;
    GLASS_VALUE lost_here = max(GLASS_VALUE(1e-7), 1.0 - glass_average(b, b.table_here, s.roughness));
    GLASS_VALUE lost_there = max(GLASS_VALUE(1e-7), 1.0 - glass_average(b, b.table_there, s.roughness));
    // Shares of etendue: n_here = 1, n_there = eta.
    GLASS_VALUE share_there = lost_there * b.eta * b.eta / (lost_here + lost_there * b.eta * b.eta);
    GLASS_VALUE missing_here = max(GLASS_VALUE(0.0), 1.0 - glass_albedo(b, b.table_here, mu, s.roughness));
    b.ms_reflected = (1.0 - share_there) * missing_here / (k_pi * lost_here);
    // Radiance arriving from there: K(there->here) = K(here->there) / eta^2.
    b.ms_transmitted = share_there * missing_here / (k_pi * lost_there * b.eta * b.eta);
    missing = glass_choice(missing_here);
  }
#endif
  b.glass_delta = b.delta || (s.solid && abs(b.eta - 1.0) < k_same_medium);
  float complement = b.glass_delta ? 0.0 : 1.0;
  b.ms_reflected *= complement;
  b.ms_transmitted *= complement;
  b.p_glass = b.glass;
  b.p_glass_ms = b.glass * missing * complement;
#endif
#if LUCERNA_LAYERS
  b.p_specular *= b.below;
  b.p_specular_ms *= b.below;
  b.p_glass *= b.below;
  b.p_glass_ms *= b.below;
#endif
  float total = b.p_diffuse + b.p_transmitted + b.p_specular + b.p_specular_ms + b.p_glass + b.p_glass_ms;
#if LUCERNA_LAYERS
  total += b.p_coat + b.p_sheen;
#endif
  float scale = total > 0.0 ? 1.0 / total : 0.0;
  b.p_diffuse *= scale;
  b.p_transmitted *= scale;
  b.p_specular *= scale;
  b.p_specular_ms *= scale;
  b.p_glass *= scale;
  b.p_glass_ms *= scale;
#if LUCERNA_LAYERS
  b.p_coat *= scale;
  b.p_sheen *= scale;
#endif
  return b;
}

#if LUCERNA_GLASS
// Reflectance of the boundary at a facet.
#if LUCERNA_GLASS_SPECULAR
vec3 glass_fresnel(Bsdf b, float cos_h) {
  float f = fresnel_dielectric(cos_h, b.eta);
  vec3 face = f < 1.0 ? b.face_0 + b.face_1 * f : vec3(1.0);
#if LUCERNA_IRIDESCENCE
  if (b.film > 0.0 && f < 1.0) {
    // From either side as much is reflected as on the same way from outside.
    float outer = b.eta >= 1.0 ? cos_h : sqrt(max(0.0, 1.0 - (1.0 - cos_h * cos_h) / (b.eta * b.eta)));
    vec3 f0 = vec3(square((b.eta - 1.0) / (b.eta + 1.0)));
    face = mix(face, film_fresnel(outer, b.film_ior, b.film_thickness, f0), b.film);
  }
#endif
  return b.solid ? face : 2.0 * face / (1.0 + face);
}
#else
float glass_fresnel(Bsdf b, float cos_h) {
  float slab = fresnel_slab(cos_h, b.eta);
#if LUCERNA_SOLID_GLASS
  float solid = fresnel_dielectric(cos_h, b.eta);
  return b.solid ? solid : slab;
#else
  return slab;
#endif
}
#endif
#endif

#if LUCERNA_SPECULAR || LUCERNA_GLASS
// The complement's draws. What a narrow lobe misses it misses at grazing angles: (1-E(m)) m, m = cos, is far from a cosine
// lobe there. Density of m: 2 a (1+a)^2 m / (m+a)^3, integral m^2 (1+a)^2 / (m+a)^2; a -> infinity is the cosine lobe. The
// factor 8 keeps the weights small (at most 17 where a cosine lobe's reach 500).
float complement_scale(Bsdf b) { return 8.0 * max(b.alpha, k_delta_alpha); }
float complement_pdf(Bsdf b, float m) {
  float a = complement_scale(b), k = (1.0 + a) / (m + a);
  return k_inv_pi * a * m * k * k / (m + a);
}
vec3 complement_sample(Bsdf b, vec2 u) {
  float a = complement_scale(b), r = sqrt(u.y), m = a * r / (1.0 + a - r);
  float s = sqrt(max(0.0, 1.0 - m * m)), phi = 2.0 * k_pi * u.x;
  return vec3(s * cos(phi), s * sin(phi), m);
}
#endif

#if LUCERNA_ANISOTROPY
// The grain along x.
vec3 along_grain(Bsdf b, vec3 v) { return vec3(dot(v.xy, b.grain), b.grain.x * v.y - b.grain.y * v.x, v.z); }
vec3 from_grain(Bsdf b, vec3 v) { return vec3(b.grain.x * v.x - b.grain.y * v.y, b.grain.y * v.x + b.grain.x * v.y, v.z); }
#endif

#if LUCERNA_CLEARCOAT
struct CoatValue {
  float glossy;  // f |cos|, about the coat's normal
  float pdf;
};
// Both directions on wo's side.
CoatValue clearcoat_eval(Bsdf b, vec3 wo, vec3 wi) {
  vec3 x, y, n = b.coat_normal;
  make_basis(n, x, y);
  float cos_o = dot(wo, n), cos_i = dot(wi, n), alpha = square(b.coat_roughness);
  vec3 h = normalize(wo + wi);
  float d = b.coat_delta || cos_i <= 0.0 ? 0.0 : ggx_d(vec3(dot(h, x), dot(h, y), dot(h, n)), alpha) / (4.0 * cos_o);
  float w = schlick_weight(max(dot(wo, h), 0.0));
  return CoatValue(b.coat * (k_coat_f0 + (1.0 - k_coat_f0) * w) * d * ggx_g2(cos_o, cos_i, alpha), d * ggx_g1(cos_o, alpha));
}
// May be below the surface.
vec3 clearcoat_sample(Bsdf b, vec3 wo, vec2 u) {
  vec3 x, y, n = b.coat_normal;
  make_basis(n, x, y);
  vec3 h = b.coat_delta ? vec3(0.0, 0.0, 1.0)
                        : ggx_sample_visible(vec3(dot(wo, x), dot(wo, y), dot(wo, n)), square(b.coat_roughness), u);
  h = h.x * x + h.y * y + h.z * n;
  return 2.0 * dot(wo, h) * h - wo;
}
#endif

// Probability of the draws of the diffuse lobe that do not follow a cosine.
float bsdf_drawn_rough(Bsdf b) {
#if LUCERNA_ROUGH_DIFFUSE
  return b.rough.roughness > 0.0 ? k_rough_drawn_share * b.p_diffuse : 0.0;
#else
  return 0.0;
#endif
}

// All lobes but the deltas.
BsdfValue bsdf_eval(Bsdf b, vec3 wo, vec3 wi) {
  BsdfValue v;
  float cos_i = abs(wi.z);
  bool same_side = wi.z > 0.0;
  float lambert = cos_i * k_inv_pi;
  vec3 diffuse = same_side ? b.diffuse : b.transmitted;
  v.pdf = (same_side ? b.p_diffuse : b.p_transmitted) * lambert;
  v.glossy = vec3(0.0);
#if LUCERNA_ROUGH_DIFFUSE
  if (b.rough.roughness > 0.0 && same_side) diffuse *= rough_shape(b.rough, wi);
#endif
#if LUCERNA_SPECULAR
  diffuse *= dielectric_transmittance(b, cos_i);
#endif
  v.diffuse = diffuse * lambert;
#if LUCERNA_SPECULAR || LUCERNA_GLASS
  vec2 t = base_albedo(b, cos_i);
  float missing = b.delta ? 0.0 : max(0.0, 1.0 - t.x - t.y);
  vec3 h = normalize(wo + vec3(wi.xy, same_side ? wi.z : -wi.z));  // of reflection, or of the mirrored thin wall
  float cos_oh = max(dot(wo, h), 0.0);
  // f cos = F D G2 / (4 cos_o), pdf = visible / (4 wo.h)
  float d = b.delta ? 0.0 : ggx_d(h, b.alpha);
  float shape = d * ggx_g2(wo.z, cos_i, b.alpha) / (4.0 * wo.z);
  float pdf_h = d * ggx_g1(wo.z, b.alpha) / (4.0 * wo.z);
#endif
#if LUCERNA_SPECULAR
  if (same_side) {
#if LUCERNA_ANISOTROPY
    if (b.brushed) {
      vec3 o = along_grain(b, wo), i = along_grain(b, wi);
      float facets = ggx_d(along_grain(b, h), b.alphas) / (4.0 * wo.z), hidden = ggx_lambda(o, b.alphas);
      shape = facets / (1.0 + hidden + ggx_lambda(i, b.alphas));
      pdf_h = facets / (1.0 + hidden);
    }
#endif
    v.glossy += specular_fresnel(b, cos_oh) * shape + b.f_ms * missing * cos_i;
    v.pdf += b.p_specular * pdf_h + b.p_specular_ms * complement_pdf(b, cos_i);
  }
#endif
#if LUCERNA_GLASS
  GLASS_VALUE f = glass_fresnel(b, cos_oh);
  float f_choice = glass_choice(f);
  float ms_pdf_share = glass_choice(b.ms_reflected) / max(glass_choice(b.ms_reflected + b.ms_transmitted), 1e-30);
  GLASS_VALUE missing_i = GLASS_VALUE(missing);
#if LUCERNA_SOLID_GLASS
  GLASS_VALUE there = glass_albedo(b, b.solid && !same_side ? b.table_there : b.solid ? b.table_here : 1u, cos_i, b.roughness);
  missing_i = b.solid ? max(GLASS_VALUE(0.0), 1.0 - there) : GLASS_VALUE(missing);
#endif
  float facets = b.glass_delta ? 0.0 : 1.0;
  vec3 reflected = vec3(f * shape * facets + b.ms_reflected * missing_i * cos_i);
  vec3 passed = b.tint * ((1.0 - f) * shape * facets + b.ms_transmitted * missing_i * cos_i);
  float pdf_reflected = f_choice * pdf_h * facets;
  float pdf_passed = (1.0 - f_choice) * pdf_h * facets;
#if LUCERNA_SOLID_GLASS
  if (b.solid) {
    vec3 g = wo + b.eta * wi;
    vec3 ht = normalize(g * (g.z < 0.0 ? -1.0 : 1.0));
    float oh = dot(wo, ht), ih = dot(wi, ht);
    bool valid = !b.glass_delta && !same_side && oh > 0.0 && ih < 0.0;
    float denominator = square(ih + oh / b.eta);
    float jacobian = valid ? -ih / max(denominator, 1e-30) : 0.0;   // d omega_h / d omega_i
#if LUCERNA_GLASS_SPECULAR
    vec3 ft = 1.0 - glass_fresnel(b, max(oh, 0.0));
#else
    float ft = 1.0 - fresnel_dielectric(max(oh, 0.0), b.eta);
#endif
    float dt = valid ? ggx_d(ht, b.alpha) * max(oh, 0.0) / wo.z * jacobian : 0.0;
    passed = b.tint * (ft * dt * ggx_g2(wo.z, cos_i, b.alpha) / (b.eta * b.eta) + b.ms_transmitted * missing_i * cos_i);
    pdf_passed = glass_choice(ft) * dt * ggx_g1(wo.z, b.alpha);
  }
#endif
  v.glossy += b.glass * (same_side ? reflected : passed);
  v.pdf += b.p_glass * (same_side ? pdf_reflected : pdf_passed) +
           b.p_glass_ms * (same_side ? ms_pdf_share : 1.0 - ms_pdf_share) * complement_pdf(b, cos_i);
#endif
#if LUCERNA_LAYERS
  float below_i = layers_below(b, wi);
  v.diffuse *= below_i;
  v.glossy *= min(b.below, below_i);
#if LUCERNA_SHEEN
  if (same_side) {
    // The fit exceeds the energy that arrives, at grazing angles and low roughness: both directions are scaled to at most 1.
    float most = max(sheen_albedo(wo.z, b.sheen_roughness), sheen_albedo(cos_i, b.sheen_roughness));
    vec3 sheen = b.sheen * (sheen_value(wo, wi, b.sheen_roughness) / max(most, 1.0));
#if LUCERNA_CLEARCOAT
    sheen *= min(b.coat_below, clearcoat_below(b, wi));
#endif
    v.glossy += sheen;
    v.pdf += b.p_sheen * k_sheen_pdf;
  }
#endif
#if LUCERNA_CLEARCOAT
  if (same_side) {
    CoatValue c = clearcoat_eval(b, wo, wi);
    v.glossy += c.glossy;
    v.pdf += b.p_coat * c.pdf;
  }
#endif
#endif
#if LUCERNA_ROUGH_DIFFUSE
  // Last, so that the rounding of other surfaces does not depend on it.
  if (b.rough.roughness > 0.0 && same_side) v.pdf += bsdf_drawn_rough(b) * (rough_pdf(b.rough, wi) - lambert);
#endif
  return v;
}

// The diffuse lobes alone: f_D |cos|, as bsdf_eval has it.
vec3 bsdf_diffuse(Bsdf b, vec3 wi) {
  float cos_i = abs(wi.z);
  vec3 diffuse = wi.z > 0.0 ? b.diffuse : b.transmitted;
#if LUCERNA_ROUGH_DIFFUSE
  if (b.rough.roughness > 0.0 && wi.z > 0.0) diffuse *= rough_shape(b.rough, wi);
#endif
#if LUCERNA_SPECULAR
  diffuse *= dielectric_transmittance(b, cos_i);
#endif
#if LUCERNA_LAYERS
  diffuse *= layers_below(b, wi);
#endif
  return diffuse * (cos_i * k_inv_pi);
}

// Whether it has a glossy lobe that light samples can reach.
bool bsdf_glossy(Bsdf b) {
#if LUCERNA_LAYERS
  if (b.p_sheen > 0.0) return true;
#if LUCERNA_CLEARCOAT
  if (b.p_coat > 0.0 && !b.coat_delta) return true;
#endif
#endif
#if LUCERNA_SPECULAR || LUCERNA_GLASS
  return !b.delta && b.p_specular + b.p_specular_ms + b.p_glass + b.p_glass_ms > 0.0;
#else
  return false;
#endif
}

// Undeflected transmission of a smooth thin wall, for shadow rays; 0 for everything else.
vec3 bsdf_undeflected(Bsdf b, float mu) {
#if LUCERNA_THIN_GLASS
  if (b.delta && !b.solid) {
    vec3 passed = b.glass * b.tint * (1.0 - glass_fresnel(b, mu));
#if LUCERNA_LAYERS
    passed *= b.below;
#endif
    return passed;
  }
#endif
  return vec3(0.0);
}
// Probability of that null event. A separate random number (null_sampler) decides it, before bsdf_sample, which samples the
// other lobes only.
float bsdf_undeflected_probability(Bsdf b, float mu) {
#if LUCERNA_THIN_GLASS
  if (b.delta && !b.solid) return b.p_glass * (1.0 - glass_choice(glass_fresnel(b, mu)));
#endif
  return 0.0;
}

// Samples a direction from the mixture of all lobes except undeflected transmission, then the label. u: direction; cosine:
// direction of the diffuse lobe, mirrored for transmission; lobe: lobe and label. Weight and density are those of the whole
// mixture, of which the cosine distribution is a part. May return weight 0 (absorbed).
BsdfSample bsdf_sample(Bsdf b, vec3 wo, vec2 u, vec3 cosine, vec2 lobe) {
  BsdfSample s;
  s.event = k_event_diffuse;
  s.eta2 = 1.0;
  s.transmitted = false;
  s.weight = vec3(0.0);
  s.pdf = 0.0;
#if LUCERNA_CLEARCOAT
  s.mirrored_by_coat = false;
#endif
  float at = lobe.x;
#if LUCERNA_THIN_GLASS
  at *= 1.0 - bsdf_undeflected_probability(b, wo.z);  // the last share of the lobes
#endif
  s.wi = cosine;
#if LUCERNA_LAYERS
  bool in_coat = at < b.p_coat, in_sheen = !in_coat && at < b.p_coat + b.p_sheen;
  at -= b.p_coat + b.p_sheen;
#endif
#if LUCERNA_ROUGH_DIFFUSE
  if (at >= 0.0 && at < bsdf_drawn_rough(b)) s.wi = rough_sample(b.rough, u);
#endif
  bool through = at >= b.p_diffuse && at < b.p_diffuse + b.p_transmitted;
  if (through) s.wi = vec3(cosine.xy, -cosine.z);
#if LUCERNA_SPECULAR || LUCERNA_GLASS
  at -= b.p_diffuse + b.p_transmitted;
  vec3 h = b.delta ? vec3(0.0, 0.0, 1.0) : ggx_sample_visible(wo, b.alpha, u);
  float cos_oh = dot(wo, h);
  vec3 mirrored = 2.0 * cos_oh * h - wo;
  bool delta = false, lost = false;
#endif
#if LUCERNA_CLEARCOAT
  if (in_coat) {
    s.wi = clearcoat_sample(b, wo, u);
    lost = !b.coat_delta && (s.wi.z <= 0.0 || dot(s.wi, b.coat_normal) <= 0.0);
    if (b.coat_delta) {
      delta = true;
      s.mirrored_by_coat = true;
      s.event = k_event_specular;
      float f = b.coat * (k_coat_f0 + (1.0 - k_coat_f0) * schlick_weight(dot(wo, b.coat_normal)));
      s.weight = s.wi.z > 0.0 ? vec3(f / b.p_coat) : vec3(0.0);
    }
  }
#endif
#if LUCERNA_SHEEN
  if (in_sheen) s.wi = sheen_sample(u);
#endif
#if LUCERNA_SPECULAR
  bool specular = at >= 0.0 && at < b.p_specular;
  if (specular) {
#if LUCERNA_ANISOTROPY
    if (b.brushed) {
      vec3 facet = from_grain(b, ggx_sample_visible(along_grain(b, wo), b.alphas, u));
      mirrored = 2.0 * dot(wo, facet) * facet - wo;
    }
#endif
    s.wi = mirrored;
    lost = !b.delta && s.wi.z <= 0.0;
    if (b.delta) {
      delta = true;
      s.event = k_event_specular;
      s.weight = specular_fresnel(b, wo.z) / b.p_specular;
    }
  }
  if (at >= b.p_specular && at < b.p_specular + b.p_specular_ms) s.wi = complement_sample(b, u);
  at -= b.p_specular + b.p_specular_ms;
#endif
#if LUCERNA_GLASS
  bool in_glass = at >= 0.0 && at < b.p_glass;
  if (in_glass) {
    vec3 facet = b.glass_delta ? vec3(0.0, 0.0, 1.0) : h;
    float cos_facet = dot(wo, facet);
    vec3 off = 2.0 * cos_facet * facet - wo;
    GLASS_VALUE f = glass_fresnel(b, cos_facet);
    float pick = at / b.p_glass, f_choice = glass_choice(f);
    bool reflect_it = pick < f_choice || (b.glass_delta && !b.solid);
    vec3 passed = vec3(off.xy, -off.z);
    float scale = 1.0;
#if LUCERNA_SOLID_GLASS
    if (b.solid) {
      float sin2_t = max(0.0, 1.0 - cos_facet * cos_facet) / (b.eta * b.eta);
      float cos_t = sqrt(max(0.0, 1.0 - sin2_t));
      passed = -wo / b.eta + (cos_facet / b.eta - cos_t) * facet;
      scale = 1.0 / (b.eta * b.eta);
    }
#endif
    s.wi = reflect_it ? off : passed;
    // A facet may send light to the wrong side of the surface: lost here, and returned by the complement. It must not be
    // evaluated as if it had been meant for that side.
    lost = reflect_it != (s.wi.z > 0.0);
    if (b.glass_delta) {
      delta = true;
      s.event = k_event_specular;
#if LUCERNA_GLASS_SPECULAR
      s.weight = b.glass / b.p_glass * (reflect_it ? f / max(f_choice, 1e-30) : b.tint * scale * (1.0 - f) / max(1.0 - f_choice, 1e-30));
#else
      s.weight = b.glass / b.p_glass * (reflect_it ? vec3(1.0) : b.tint * scale);
#endif
    }
  }
  at -= b.p_glass;
  bool in_complement = at >= 0.0 && b.p_glass_ms > 0.0;
  if (in_complement) {
    float share = glass_choice(b.ms_reflected) / max(glass_choice(b.ms_reflected + b.ms_transmitted), 1e-30);
    s.wi = complement_sample(b, u);
    if (at / b.p_glass_ms >= share) s.wi.z = -s.wi.z;
  }
#endif
  s.transmitted = s.wi.z < 0.0;
#if LUCERNA_LAYERS
  if (delta && !in_coat) s.weight *= min(b.below, layers_below(b, s.wi));
#endif
#if LUCERNA_SPECULAR || LUCERNA_GLASS
  if (!delta) {
#endif
    BsdfValue v = bsdf_eval(b, wo, s.wi);
    float yd = luminance(v.diffuse), yg = luminance(v.glossy);
    float p_d = yd + yg > 0.0 ? yd / (yd + yg) : 1.0;
    bool is_d = lobe.y < p_d;
    s.event = is_d ? k_event_diffuse : k_event_glossy;
    float p = (is_d ? p_d : 1.0 - p_d) * v.pdf;
#if LUCERNA_SPECULAR || LUCERNA_GLASS
    p = lost ? 0.0 : p;
#endif
    s.weight = p > 0.0 ? (is_d ? v.diffuse : v.glossy) / p : vec3(0.0);
    s.pdf = v.pdf;
#if LUCERNA_SPECULAR || LUCERNA_GLASS
  }
#endif
#if LUCERNA_GLASS
  if (b.solid && s.transmitted && s.event != k_event_diffuse) s.eta2 = 1.0 / (b.eta * b.eta);
#endif
  return s;
}
BsdfSample bsdf_sample(Bsdf b, vec3 wo, vec2 u, vec2 lobe) { return bsdf_sample(b, wo, u, sample_cosine(u), lobe); }

#endif
