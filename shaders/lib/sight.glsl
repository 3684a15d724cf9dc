// Continuation of rays that find the surfaces visible through glass and in mirrors: they follow the strongest lobe.
#ifndef LUCERNA_LIB_SIGHT
#define LUCERNA_LIB_SIGHT
#include "lib/surface.glsl"

struct SightStep {
  bool undeflected;   // continues undeflected: the surface is cut out there, or is a thin smooth glass wall
  bool cut_out;    // ... the former
  bool turned;     // mirrored or refracted. Neither: the hit surface is the visible one, or it is rough and shows none
  bool mirrored;   // if turned
  bool diffuse;    // the surface scatters light diffusely
  float mirrors;   // share of its reflection that depends on the direction of view: of smooth lobes, 0..1
  vec3 direction;  // of the continued ray
};

SightStep sight_step(Surface surface, vec3 direction) {
  SightStep s = SightStep(false, false, false, false, false, 0.0, direction);
#if LUCERNA_ALPHA
  s.undeflected = s.cut_out = surface_coverage(surface) < 0.5;
  if (s.cut_out) return s;
#endif
  mat3 to_world = shading_frame(surface, -direction);
  vec3 wo = -direction * to_world;  // transposed
  Bsdf bsdf = surface_bsdf(surface, to_world, -direction);
#if LUCERNA_THIN_GLASS
  s.undeflected = bsdf_undeflected_probability(bsdf, wo.z) > 0.5;
  if (s.undeflected) return s;
#endif
  s.mirrors = clamp(1.0 - bsdf.p_diffuse - bsdf.p_transmitted, 0.0, 1.0) * (1.0 - sqrt(bsdf.alpha));
  s.diffuse = max3(bsdf.diffuse_albedo + bsdf.transmitted_albedo) > 0.0;
  if (s.diffuse) return s;
  BsdfSample b = bsdf_sample(bsdf, wo, vec2(0.0, 0.5), vec2(0.5));
  s.direction = normalize(to_world * b.wi);
  s.mirrored = !b.transmitted;
  vec3 side = surface.front ? surface.normal_g : -surface.normal_g;
  s.turned = b.event == k_event_specular && (dot(s.direction, side) > 0.0) == s.mirrored && max3(b.weight) > 0.0;
  return s;
}

#endif
