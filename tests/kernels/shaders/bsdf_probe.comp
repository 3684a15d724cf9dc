// shaders/lib/bsdf.glsl and the samplers below it, one query per invocation.
// TEST_DRAW 0: value and density in a direction; 1: draws a direction.
// TEST_SUBJECT 0: the whole BSDF; 1: GGX visible normals; 2: cosine lobe. alpha = roughness^2.
#include "shaders/lib/invocation.glsl"
#include "shaders/lib/math.glsl"
#include "shaders/lib/bsdf.glsl"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push {
  uint count;
  uint material;  // draws: the same for all
  uint seed;
  vec3 wo;
} push;

struct Material {
  vec3 base;
  float metallic, roughness, ior, specular;
  vec3 specular_color;
  float transmission, diffuse_transmission;
  vec3 diffuse_transmission_color;
  uint solid, inside;
  int glass_row;
  float clearcoat, clearcoat_roughness;
  vec3 clearcoat_normal;
  vec3 sheen;
  float sheen_roughness;
  float anisotropy;
  vec2 grain;
  float film, film_ior, film_thickness;
  float diffuse_roughness;
};
struct Question {
  uint material;
  vec3 wo, wi;
};
struct Value {
  vec3 diffuse, glossy;
  float pdf;
};
struct Draw {
  vec3 wi;
  float pdf;
  vec3 weight;
  float eta2;
  uint event, transmitted;
};

layout(scalar) readonly buffer Materials { Material materials[]; };
layout(scalar) readonly buffer Questions { Question questions[]; };
layout(scalar) writeonly buffer Values { Value values[]; };
layout(scalar) writeonly buffer Draws { Draw draws[]; };

SurfaceParameters parameters(Material m) {
  SurfaceParameters s;
  s.base = m.base;
  s.metallic = m.metallic;
  s.roughness = m.roughness;
  s.ior = m.ior;
  s.specular = m.specular;
  s.specular_color = m.specular_color;
  s.transmission = m.transmission;
  s.diffuse_transmission = m.diffuse_transmission;
  s.diffuse_transmission_color = m.diffuse_transmission_color;
  s.solid = m.solid != 0u;
  s.inside = m.inside != 0u;
  s.glass_row = m.glass_row;
#if LUCERNA_CLEARCOAT
  s.clearcoat = m.clearcoat;
  s.clearcoat_roughness = m.clearcoat_roughness;
  s.clearcoat_normal = m.clearcoat_normal;
#endif
#if LUCERNA_SHEEN
  s.sheen = m.sheen;
  s.sheen_roughness = m.sheen_roughness;
#endif
#if LUCERNA_ANISOTROPY
  s.anisotropy = m.anisotropy;
  s.grain = m.grain;
#endif
#if LUCERNA_IRIDESCENCE
  s.film = m.film;
  s.film_ior = m.film_ior;
  s.film_thickness = m.film_thickness;
#endif
#if LUCERNA_ROUGH_DIFFUSE
  s.diffuse_roughness = m.diffuse_roughness;
#endif
  return s;
}

// Five independent uniform numbers per invocation, from a separate generator: rounds of xorshift-multiply over a
// counter.
uint scramble(uint x) {
  x = (x ^ (x >> 17)) * 0xed5ad4bbu;
  x = (x ^ (x >> 11)) * 0xac4c1b51u;
  x = (x ^ (x >> 15)) * 0x31848babu;
  return x ^ (x >> 14);
}
float uniform_number(uint i, uint k) {
  uint x = scramble(scramble(scramble(4u * i + k % 4u) + push.seed) + 0x9e3779b9u * (k + 1u));
  return float(x >> 8) * (1.0 / 16777216.0);
}

void main() {
  uint i = global_index();
  if (i >= push.count) return;
#if TEST_DRAW
  Material m = materials[push.material];
  vec4 u = vec4(uniform_number(i, 0u), uniform_number(i, 1u), uniform_number(i, 2u), uniform_number(i, 3u));
  Draw d;
  d.weight = vec3(1.0);
  d.eta2 = 1.0;
  d.event = k_event_diffuse;
#if TEST_SUBJECT == 0
  Bsdf bsdf = make_bsdf(parameters(m), push.wo);
  BsdfSample s = bsdf_sample(bsdf, push.wo, u.xy, u.zw);
  float p_undeflected = bsdf_undeflected_probability(bsdf, push.wo.z);
  if (uniform_number(i, 4u) < p_undeflected) {
    s.wi = -push.wo;
    s.weight = bsdf_undeflected(bsdf, push.wo.z) / p_undeflected;
    s.pdf = 0.0;
    s.event = k_event_null;
    s.eta2 = 1.0;
    s.transmitted = true;
  }
  d.wi = s.wi;
  d.pdf = s.pdf;
  d.weight = s.weight;
  d.eta2 = s.eta2;
  d.event = s.event;
  d.transmitted = s.transmitted ? 1u : 0u;
#elif TEST_SUBJECT == 1
  d.wi = ggx_sample_visible(push.wo, m.roughness * m.roughness, u.xy);
  d.pdf = ggx_visible_pdf(push.wo, d.wi, m.roughness * m.roughness);
  d.transmitted = 0u;
#else
  d.wi = sample_cosine(u.xy);
  d.pdf = d.wi.z * k_inv_pi;
  d.transmitted = 0u;
#endif
  draws[i] = d;
#else
  Question q = questions[i];
  Material m = materials[q.material];
  Value v;
  v.diffuse = vec3(0.0);
  v.glossy = vec3(0.0);
#if TEST_SUBJECT == 0
  BsdfValue f = bsdf_eval(make_bsdf(parameters(m), q.wo), q.wo, q.wi);
  v.diffuse = f.diffuse;
  v.glossy = f.glossy;
  v.pdf = f.pdf;
#elif TEST_SUBJECT == 1
  v.pdf = ggx_visible_pdf(q.wo, q.wi, m.roughness * m.roughness);
#else
  v.pdf = max(q.wi.z, 0.0) * k_inv_pi;
#endif
  values[i] = v;
#endif
}
