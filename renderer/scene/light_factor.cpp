#include "scene/light_factor.h"

#include <algorithm>

namespace lucerna::scene {
namespace {

bool emits(const Environment& e) { return e.scale > 0 && (e.image != k_none || e.radiance != vec3(0)); }

/// Of a lamp that is off nothing.
vec3 strength(const Light& l) { return l.enabled ? l.intensity : vec3(0); }

bool same_but_strength(const Light& a, const Light& b) {
  return a.kind == b.kind && a.position == b.position && a.direction == b.direction &&
         a.inner_cone == b.inner_cone && a.outer_cone == b.outer_cone;
}

std::optional<vec3> quotient(const vec3& after, const vec3& before) {
  vec3 factor(1);
  for (int k = 0; k < 3; ++k) {
    if (before[k] > 0)
      factor[k] = after[k] / before[k];
    else if (after[k] > 0)
      return std::nullopt;
  }
  return factor;
}

}  // namespace

std::optional<vec3> light_factor(const Scene& before, const Scene& after) {
  const auto shines = [](const Material& m) {
    return m.emission != vec3(0) || (m.unlit && vec3(m.base_color) != vec3(0));
  };
  if (before.lights.size() != after.lights.size() ||
      std::any_of(after.materials.begin(), after.materials.end(), shines) ||
      std::any_of(before.materials.begin(), before.materials.end(), shines))
    return std::nullopt;
  const Environment &e0 = before.environment, &e1 = after.environment;
  const bool same_sky = e0.image == e1.image && e0.radiance == e1.radiance && e0.rotation == e1.rotation;
  std::optional<vec3> factor;
  if (emits(e0) || emits(e1)) {
    if (!same_sky || e0.scale <= 0) return std::nullopt;
    factor = vec3(e1.scale / e0.scale);
  }
  for (size_t i = 0; i < before.lights.size(); ++i) {
    const Light &l0 = before.lights[i], &l1 = after.lights[i];
    if (strength(l0) == vec3(0) && strength(l1) == vec3(0)) continue;
    const std::optional<vec3> own = quotient(strength(l1), strength(l0));
    if (!own || (!same_but_strength(l0, l1) && *own != vec3(0))) return std::nullopt;
    // All emitters alike are as good as one.
    if (factor && *factor != *own) return std::nullopt;
    factor = own;
  }
  return factor;
}

}  // namespace lucerna::scene
