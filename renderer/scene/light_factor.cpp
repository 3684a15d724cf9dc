#include "scene/light_factor.h"

#include <algorithm>
#include <cmath>

namespace lucerna::scene {
namespace {

bool emits(const Environment& e) { return e.scale > 0 && (e.image != k_none || e.radiance != vec3(0)); }

/// 0 for a lamp that is off.
vec3 strength(const Light& l) { return l.enabled ? l.intensity : vec3(0); }
vec3 strength(const Material& m) { return m.unlit ? vec3(m.base_color) : m.emission; }

bool same_but_strength(const Light& a, const Light& b) {
  return a.kind == b.kind && a.position == b.position && a.direction == b.direction &&
         a.inner_cone == b.inner_cone && a.outer_cone == b.outer_cone && a.right == b.right &&
         a.width == b.width && a.height == b.height && a.radius == b.radius && a.two_sided == b.two_sided &&
         a.visible == b.visible && a.profile == b.profile && a.picture == b.picture;
}

bool same_but_strength(const Material& a, Material b) {
  b.emission = a.emission;
  return a == b;
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

/// Factors of the groups, from the lights processed so far.
class GroupFactors {
 public:
  explicit GroupFactors(size_t groups) : factors_(groups) {}
  /// False if it contradicts another light of the group.
  bool add(size_t group, const std::optional<vec3>& factor) {
    if (!factor || group >= factors_.size() || (factors_[group] && *factors_[group] != *factor)) return false;
    factors_[group] = factor;
    return true;
  }
  std::optional<std::vector<vec3>> all() const {
    std::vector<vec3> factors;
    for (const auto& f : factors_) factors.push_back(f.value_or(vec3(1)));
    const bool any =
        std::any_of(factors_.begin(), factors_.end(), [](const auto& f) { return f.has_value(); });
    return any ? std::optional(factors) : std::nullopt;
  }

 private:
  std::vector<std::optional<vec3>> factors_;
};

bool add_lamps(const Scene& before, const Scene& after, const LightGroups* groups, GroupFactors& found) {
  for (size_t i = 0; i < before.lights.size(); ++i) {
    const Light &l0 = before.lights[i], &l1 = after.lights[i];
    if (strength(l0) == vec3(0) && strength(l1) == vec3(0)) continue;
    const std::optional<vec3> own = quotient(strength(l1), strength(l0));
    if (own && !same_but_strength(l0, l1) && *own != vec3(0)) return false;
    if (!found.add(groups ? groups->lamps[i] : 0, own)) return false;
  }
  return true;
}

bool add_surfaces(const Scene& before, const Scene& after, const LightGroups* groups, GroupFactors& found) {
  for (size_t i = 0; i < before.instances.size(); ++i) {
    const auto& primitives = before.meshes[before.instances[i].mesh].primitives;
    for (size_t p = 0; p < primitives.size(); ++p) {
      const Material &m0 = before.materials[primitives[p].material],
                     &m1 = after.materials[primitives[p].material];
      if (strength(m0) == vec3(0) && strength(m1) == vec3(0)) continue;
      if (!is_light(m0) && !is_light(m1)) continue;
      if (groups && groups->surfaces[i].empty()) return false;
      if (!found.add(groups ? groups->surfaces[i][p] : 0, quotient(strength(m1), strength(m0)))) return false;
    }
  }
  return true;
}

bool add_environment(const Environment& before, const Environment& after, const LightGroups* groups,
                     GroupFactors& found) {
  if (!emits(before) && !emits(after)) return true;
  const bool same =
      before.image == after.image && before.radiance == after.radiance && before.rotation == after.rotation;
  if (!same || before.scale <= 0) return false;
  const vec3 factor(after.scale / before.scale);
  return found.add(groups ? groups->sky : 0, factor) &&
         (!groups || !groups->has_sun || found.add(groups->sun, factor));
}

}  // namespace

std::optional<std::vector<vec3>> light_factors(const Scene& before, const Scene& after,
                                               const LightGroups* groups) {
  if (before.lights.size() != after.lights.size() || before.instances.size() != after.instances.size() ||
      !std::equal(before.materials.begin(), before.materials.end(), after.materials.begin(),
                  after.materials.end(),
                  [](const Material& a, const Material& b) { return same_but_strength(a, b); }))
    return std::nullopt;
  GroupFactors found(groups ? groups->groups.size() : 1);
  const bool known = add_lamps(before, after, groups, found) && add_surfaces(before, after, groups, found) &&
                     add_environment(before.environment, after.environment, groups, found);
  return known ? found.all() : std::nullopt;
}

bool is_multiplied(const Scene& before, const Scene& after, const LightGroups& groups,
                   const std::vector<vec3>& factors) {
  // A product, a quotient and a mix that was written as text: a few roundings each.
  constexpr float k_rounding = 1e-5f;
  const auto equals = [&](const vec3& strength, const vec3& was, size_t group) {
    for (int k = 0; k < 3; ++k) {
      const float expected = was[k] * factors[group][k];
      if (!(std::abs(strength[k] - expected) <= k_rounding * expected)) return false;
    }
    return true;
  };
  if (before.lights.size() != after.lights.size() || before.instances.size() != after.instances.size() ||
      !std::equal(before.materials.begin(), before.materials.end(), after.materials.begin(),
                  after.materials.end(),
                  [](const Material& a, const Material& b) { return same_but_strength(a, b); }))
    return false;
  for (size_t i = 0; i < before.lights.size(); ++i)
    if (!same_but_strength(before.lights[i], after.lights[i]) ||
        !equals(strength(after.lights[i]), strength(before.lights[i]), groups.lamps[i]))
      return false;
  for (size_t i = 0; i < before.instances.size(); ++i) {
    const auto& primitives = before.meshes[before.instances[i].mesh].primitives;
    for (size_t p = 0; p < primitives.size(); ++p) {
      const Material &m0 = before.materials[primitives[p].material],
                     &m1 = after.materials[primitives[p].material];
      if (m0.emission == m1.emission && groups.surfaces[i].empty()) continue;
      if (groups.surfaces[i].empty() || !equals(strength(m1), strength(m0), groups.surfaces[i][p]))
        return false;
    }
  }
  const Environment &e0 = before.environment, &e1 = after.environment;
  if (!emits(e0) && !emits(e1)) return true;
  return e0.image == e1.image && e0.radiance == e1.radiance && e0.rotation == e1.rotation &&
         equals(vec3(e1.scale), vec3(e0.scale), groups.sky) &&
         (!groups.has_sun || equals(vec3(e1.scale), vec3(e0.scale), groups.sun));
}

std::optional<vec3> common_factor(const std::vector<vec3>& factors) {
  const bool alike =
      std::all_of(factors.begin(), factors.end(), [&](const vec3& f) { return f == factors.front(); });
  return !factors.empty() && alike ? std::optional(factors.front()) : std::nullopt;
}

}  // namespace lucerna::scene
