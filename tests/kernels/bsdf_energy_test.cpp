// links: upload
// Physical properties of the surface model: reciprocity, no energy gain, and no energy loss without
// absorption.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "kernels/bsdf_support.h"
#include "kernels/statistics_support.h"

namespace bsdf_energy_tests {

using namespace lucerna;
using namespace lucerna::test;
using namespace lucerna::test::bsdf;

namespace {

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }
vec3 color(std::mt19937& random) { return {uniform(random), uniform(random), uniform(random)}; }
/// Often exactly 0 or 1, where terms vanish.
float factor(std::mt19937& random) {
  const float u = 1.6f * uniform(random) - 0.3f;
  return std::clamp(u, 0.f, 1.f);
}

Material any_material(std::mt19937& random, float least_roughness) {
  Material m;
  m.base = color(random);
  m.metallic = factor(random);
  m.roughness = least_roughness + (1 - least_roughness) * uniform(random);
  m.specular = factor(random);
  m.specular_color = color(random);
  m.transmission = factor(random);
  m.diffuse_transmission = factor(random);
  m.diffuse_transmission_color = color(random);
  m.solid = random() % 2;
  m.inside = m.solid ? random() % 2 : 0;
  m.glass_row = m.solid ? static_cast<int>(random() % 2) : -1;
  m.ior = m.solid ? k_glasses[m.glass_row] : 1 + 1.5f * uniform(random);
  return m;
}

/// Reflectance under light of the same radiance over n^2 from everywhere: the share of each channel that
/// leaves towards wo. Roughness must not be that of a smooth surface.
std::array<double, 3> albedo(const Sphere& sphere, const Material& m) {
  const Integrals up = sphere.over(true), down = sphere.over(false);
  const double scale = m.solid ? double(m.eta()) * m.eta() : 1;
  std::array<double, 3> a{};
  for (int c = 0; c < 3; ++c) a[c] = up[1 + c] + up[4 + c] + down[1 + c] + scale * down[4 + c];
  return a;
}

/// Materials and views for a furnace: the first half pure metal or glass, then mixtures.
struct Furnace {
  std::vector<Material> materials;
  std::vector<View> views;
};
Furnace furnace(uint32_t seed, int count, float least_roughness) {
  std::mt19937 random(seed);
  Furnace f;
  for (int i = 0; i < count; ++i) {
    Material m = any_material(random, least_roughness);
    if (i % 2 == 0) m.metallic = i % 8 == 0, m.transmission = 1;
    if (i % 3 == 0) m.roughness = std::min(m.roughness, least_roughness + 0.2f);
    f.materials.push_back(m);
    const float cosine = i % 5 == 0 ? 0.03f : 0.03f + 0.97f * uniform(random);
    f.views.push_back({static_cast<uint32_t>(i), direction(cosine, 6.2831853 * uniform(random))});
  }
  return f;
}
void whiten(Furnace& f) {
  for (Material& m : f.materials) m.base = m.diffuse_transmission_color = vec3(1);
}
std::string describe(const Material& m, const vec3& wo) {
  return fmt::format(
      "metallic {}, roughness {}, ior {}, specular {}, transmission {} ({}{}), diffuse transmission {}, "
      "cosine {}",
      m.metallic, m.roughness, m.ior, m.specular, m.transmission, m.solid ? "solid" : "thin",
      m.inside ? ", from inside" : "", m.diffuse_transmission, wo.z);
}

/// The tables of missing energy are interpolated: this much may be missing or in excess.
constexpr double k_table_error = 5e-3;

}  // namespace

TEST_CASE("reciprocity: f is the same in both directions, over n^2 of the side that light goes to") {
  std::mt19937 random(7);
  std::vector<Material> materials;
  std::vector<Question> there, back;
  for (int i = 0; i < 700; ++i) {
    const Material m = any_material(random, 0.05f);
    Material other = m;  // seen from the other side
    other.inside = m.solid ? 1 - m.inside : 0;
    const auto at = static_cast<uint32_t>(materials.size());
    materials.push_back(m), materials.push_back(other);
    for (int k = 0; k < 160; ++k) {
      const vec3 wo = direction(0.02 + 0.98 * uniform(random), 6.2831853 * uniform(random));
      vec3 wi = direction(2 * uniform(random) - 1, 6.2831853 * uniform(random));
      // Half of the directions where the lobes are: around the reflected direction, the transmitted one of a
      // thin wall, the refracted one.
      if (k % 2 == 0) {
        const float eta = m.solid && k % 4 == 0 ? m.eta() : 1, cosine = wo.z;
        const float bent = std::sqrt(std::max(0.f, 1 - (1 - cosine * cosine) / (eta * eta)));
        const vec3 middle(-wo.x / eta, -wo.y / eta, k % 4 == 0 ? -bent : cosine);
        wi = glm::normalize(middle + m.alpha() * (2.f * color(random) - 1.f));
      }
      if (std::abs(wi.z) < 0.02f) continue;
      there.push_back({at, wo, wi});
      // The frame's z is on the side of the first direction.
      if (wi.z > 0)
        back.push_back({at, wi, wo});
      else
        back.push_back({at + 1, vec3(wi.x, wi.y, -wi.z), vec3(wo.x, wo.y, -wo.z)});
    }
  }
  Probe probe(materials);
  const auto a = probe.evaluate(there), b = probe.evaluate(back);
  size_t bad = 0, improper = 0, bright[2] = {0, 0};
  std::string worst;
  for (size_t i = 0; i < a.size(); ++i) {
    const Material& m = materials[there[i].material];
    const float ci = std::abs(there[i].wi.z), co = there[i].wo.z;
    const bool through = there[i].wi.z < 0;
    const float n2 = m.solid && through ? m.eta() * m.eta() : 1;  // of wi's side over wo's
    // Tolerance of single precision: larger at grazing angles, and where light grazes the facet that refracts
    // it (1 - sin^2 of Snell's law cancels). The complement divides the missing part of an albedo near 1 by a
    // mean of the same size, which adds an absolute error.
    float relative = 1e-4f + 2e-5f / std::min(ci, co);
    if (m.solid && through) {
      const vec3 h = glm::normalize(there[i].wo + m.eta() * there[i].wi);
      const float grazing = std::min(std::abs(glm::dot(h, there[i].wo)), std::abs(glm::dot(h, there[i].wi)));
      relative += 2e-6f / std::max(grazing * grazing, 1e-6f);
    }
    const auto differ = [&](const vec3& x, const vec3& y) {
      return !(glm::length(x - y) <= relative * glm::length(x + y) + 2e-6f + 1e-7f / m.alpha());
    };
    const vec3 fa = a[i].glossy / ci * std::min(n2, 1.f), fb = b[i].glossy / co / std::max(n2, 1.f);
    const bool wrong = differ(fa, fb) || differ(a[i].diffuse / ci, b[i].diffuse / co);
    if (wrong && bad++ == 0)
      worst = fmt::format("{}, wi.z {}: {} and {}", describe(m, there[i].wo), there[i].wi.z, fa.x, fb.x);
    for (const vec3& f : {a[i].diffuse, a[i].glossy})
      for (int c = 0; c < 3; ++c) improper += !(f[c] >= 0 && std::isfinite(f[c]));
    bright[through] += fa.x > 0.05f;
  }
  INFO(worst << " (the first of " << bad << " of " << a.size() << ")");
  CHECK(bad == 0);
  CHECK(improper == 0);
  // Enough values were compared.
  CHECK(bright[0] > 10000);
  CHECK(bright[1] > 10000);
}

TEST_CASE("white furnace: without absorption all incident light leaves") {
  Furnace f = furnace(8, 240, 0.08f);
  whiten(f);
  Probe probe(f.materials);
  const auto spheres = integrate(probe, f.views, 1e-5);
  for (size_t i = 0; i < f.views.size(); ++i) {
    const auto a = albedo(spheres[i], f.materials[i]);
    INFO(describe(f.materials[i], f.views[i].wo));
    for (const double channel : a) CHECK(channel == Approx(1).margin(k_table_error));
  }
}

TEST_CASE("white furnace by sampling, smooth and nearly smooth") {
  Furnace f = furnace(9, 96, 0);
  whiten(f);
  for (size_t i = 0; i < f.materials.size(); ++i)
    f.materials[i].roughness = std::array{0.f, 0.033f, 0.06f}[i % 3];
  Probe probe(f.materials);
  Jury jury;
  for (size_t i = 0; i < f.views.size(); ++i) {
    const Material& m = f.materials[i];
    Mean mean;
    for (const Draw& d : probe.draw(f.views[i].material, f.views[i].wo, 1 << 14, static_cast<uint32_t>(i)))
      mean.add(d.weight.y / d.eta2);
    jury.add(fmt::format("{}: {} +- {}", describe(m, f.views[i].wo), mean.value(), mean.error()),
             mean_tail(mean, 1, k_table_error));
  }
  CHECK(jury.verdict() == "");
}

TEST_CASE("glass reflects the share of F given by its specular factor and colour") {
  // Nearly smooth, so reflection and transmission are those of facets in the plane of the surface.
  std::vector<Material> materials;
  std::vector<View> views;
  for (const uint32_t solid : {0u, 1u})
    for (const float specular : {0.f, 0.5f, 1.f})
      for (const vec3& tint : {vec3(1), vec3(0.5f, 1, 4)})
        for (const float cosine : {1.f, 0.4f}) {
          Material m;
          m.base = vec3(1), m.roughness = 0.1f, m.transmission = 1;
          m.specular = specular, m.specular_color = tint;
          m.solid = solid, m.glass_row = solid ? 0 : -1;
          views.push_back({static_cast<uint32_t>(materials.size()), direction(cosine, 1)});
          materials.push_back(m);
        }
  Probe probe(materials);
  const auto spheres = integrate(probe, views, 1e-5);
  for (size_t i = 0; i < views.size(); ++i) {
    const Material& m = materials[i];
    const double c = double(views[i].wo.z), t = std::sqrt(1 - (1 - c * c) / 2.25);
    const double p = (1.5 * c - t) / (1.5 * c + t), s = (c - 1.5 * t) / (c + 1.5 * t),
                 f = (p * p + s * s) / 2;
    INFO(describe(m, views[i].wo));
    for (int k = 0; k < 3; ++k) {
      const double own = std::min(1.0, 0.04 * double(m.specular_color[k]));
      double expected = double(m.specular) * (own + (1 - own) * (f - 0.04) / 0.96);
      if (!m.solid) expected = 2 * expected / (1 + expected);
      CHECK(spheres[i].over(true)[4 + k] == Approx(expected).margin(0.003));
    }
  }
}

TEST_CASE("no material gains energy") {
  const Furnace f = furnace(10, 160, 0.08f);
  Probe probe(f.materials);
  const auto spheres = integrate(probe, f.views, 1e-5);
  double darkest = 1, brightest = 0;
  for (size_t i = 0; i < f.views.size(); ++i) {
    INFO(describe(f.materials[i], f.views[i].wo));
    for (const double channel : albedo(spheres[i], f.materials[i])) {
      CHECK(channel < 1 + k_table_error);
      darkest = std::min(darkest, channel), brightest = std::max(brightest, channel);
    }
  }
  CHECK(darkest < 0.1);
  CHECK(brightest > 0.9);
}

TEST_CASE("a black surface without specular absorbs everything") {
  Material m;
  m.base = m.diffuse_transmission_color = vec3(0), m.specular = 0;
  Probe probe({m});
  const vec3 wo = direction(0.5, 1);
  size_t bad = 0;
  for (const Draw& d : probe.draw(0, wo, 4096, 1)) bad += d.weight != vec3(0);
  for (const Value& v : probe.evaluate({{0, wo, direction(0.3, 2)}, {0, wo, direction(-0.3, 2)}}))
    bad += v.diffuse != vec3(0) || v.glossy != vec3(0);
  CHECK(bad == 0);
}

TEST_CASE("the complement has the energy of all further bounces") {
  // A reflector with the same F = s for all angles: single scattering gives s E, and the bounce of order n
  // gives s^n (1 - E)(1 - E_avg)^(n-2) E_avg, a geometric series. E itself is measured with a very dark
  // reflector.
  constexpr double k_dark = 1e-3;
  constexpr int k_cosines = 24;
  for (const float roughness : {0.4f, 1.f}) {
    std::vector<Material> materials;
    for (const double s : {k_dark, 0.3, 0.7, 0.95}) {
      Material& m = materials.emplace_back();
      m.base = vec3(0), m.ior = 0, m.roughness = roughness, m.specular = static_cast<float>(s);
    }
    std::vector<View> views;
    for (uint32_t m = 0; m < materials.size(); ++m)
      for (int i = 0; i < k_cosines; ++i)
        views.push_back({m, direction(std::sqrt((i + 0.5) / k_cosines), 0.5)});
    Probe probe(materials);
    const auto spheres = integrate(probe, views, 3e-8);
    double average = 0;  // cosine-weighted: the views are uniform in cosine^2
    for (int i = 0; i < k_cosines; ++i) average += spheres[i].over(true)[4] / k_dark / k_cosines;
    for (size_t i = k_cosines; i < views.size(); ++i) {
      const double s = materials[views[i].material].specular,
                   e = spheres[i % k_cosines].over(true)[4] / k_dark;
      const double expected = s * e + (1 - e) * s * s * average / (1 - s * (1 - average));
      INFO("roughness " << roughness << ", F " << s << ", cosine " << views[i].wo.z);
      CHECK(spheres[i].over(true)[4] == Approx(expected).margin(2e-3));
    }
  }
}

TEST_CASE("there were no validation messages: bsdf energy") { CHECK(device().validation_messages() == 0); }

}  // namespace bsdf_energy_tests
