// links: upload
// Clear coat, sheen, brushed surfaces and thin films: reciprocity, energy, and limits that are known in
// closed form. Draws are compared with densities in bsdf_sampling_test.cpp.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "kernels/bsdf_support.h"
#include "kernels/statistics_support.h"

namespace bsdf_layers_tests {

using namespace lucerna;
using namespace lucerna::test;
using namespace lucerna::test::bsdf;

namespace {

constexpr float k_cosines[] = {1, 0.7f, 0.35f, 0.08f};
/// The tables of albedos are interpolated.
constexpr double k_table_error = 5e-3;

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }
vec3 color(std::mt19937& random) { return {uniform(random), uniform(random), uniform(random)}; }
float factor(std::mt19937& random) { return std::clamp(1.6f * uniform(random) - 0.3f, 0.f, 1.f); }

Material any_layered(std::mt19937& random) {
  Material m;
  m.base = color(random);
  m.metallic = factor(random);
  m.roughness = 0.1f + 0.9f * uniform(random);
  m.specular = factor(random);
  m.transmission = random() % 3 == 0 ? factor(random) : 0;
  m.clearcoat = factor(random);
  m.clearcoat_roughness = 0.1f + 0.9f * uniform(random);
  m.sheen = random() % 2 ? color(random) : vec3(0);
  m.sheen_roughness = uniform(random);
  m.anisotropy = random() % 2 ? uniform(random) : 0;
  m.film = random() % 2 ? factor(random) : 0;
  m.film_ior = 1 + uniform(random), m.film_thickness = 1200 * uniform(random);
  m.diffuse_roughness = random() % 2 ? uniform(random) : 0;
  return m;
}

/// What leaves towards directions of those cosines: total reflectance and transmittance of the first channel.
std::vector<double> albedos(const Material& material, double tolerance = 1e-5) {
  Probe probe({material});
  std::vector<View> views;
  for (const float c : k_cosines) views.push_back({0, direction(c, 0.4)});
  std::vector<double> result;
  for (const Sphere& sphere : integrate(probe, views, tolerance)) {
    const Integrals up = sphere.over(true), down = sphere.over(false);
    result.push_back(up[1] + up[4] + down[1] + down[4]);
  }
  return result;
}
/// The glossy part alone.
std::vector<double> glossy(const Material& material) {
  Probe probe({material});
  std::vector<View> views;
  for (const float c : k_cosines) views.push_back({0, direction(c, 0.4)});
  std::vector<double> result;
  for (const Sphere& sphere : integrate(probe, views, 1e-6)) result.push_back(sphere.over(true)[4]);
  return result;
}

Material white_paint() {
  Material m;
  m.base = vec3(1), m.specular = 0, m.roughness = 1;
  return m;
}

}  // namespace

TEST_CASE("layered surfaces are reciprocal") {
  std::mt19937 random(21);
  std::vector<Material> materials;
  std::vector<Question> there, back;
  for (uint32_t i = 0; i < 400; ++i) {
    materials.push_back(any_layered(random));
    for (int k = 0; k < 120; ++k) {
      const vec3 wo = direction(0.05 + 0.95 * uniform(random), 6.2831853 * uniform(random));
      vec3 wi = direction(0.05 + 0.95 * uniform(random), 6.2831853 * uniform(random));
      if (k % 2 == 0) wi = glm::normalize(vec3(-wo.x, -wo.y, wo.z) + 0.3f * (2.f * color(random) - 1.f));
      if (wi.z < 0.05f) continue;
      there.push_back({i, wo, wi}), back.push_back({i, wi, wo});
    }
  }
  Probe probe(materials);
  const auto a = probe.evaluate(there), b = probe.evaluate(back);
  size_t bad = 0, bright = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const vec3 fa = (a[i].glossy + a[i].diffuse) / there[i].wi.z,
               fb = (b[i].glossy + b[i].diffuse) / there[i].wo.z;
    bad += !(glm::length(fa - fb) <= 2e-3f * glm::length(fa + fb) + 1e-5f);
    for (int c = 0; c < 3; ++c) bad += !(fa[c] >= 0 && std::isfinite(fa[c]));
    bright += fa.x > 0.05f;
  }
  CHECK(bad == 0);
  CHECK(bright > a.size() / 2);
}

TEST_CASE("layers never reflect more than arrives") {
  std::mt19937 random(22);
  std::vector<Material> materials;
  std::vector<View> views;
  for (uint32_t i = 0; i < 120; ++i) {
    Material m = any_layered(random);
    m.base = vec3(1);
    if (i % 2) m.sheen = vec3(1), m.clearcoat = 1;
    // Their albedos are approximate: tests below.
    m.anisotropy = m.film = 0;
    materials.push_back(m);
    views.push_back({i, direction(0.03 + 0.97 * uniform(random), 1)});
  }
  Probe probe(materials);
  const auto spheres = integrate(probe, views, 1e-5);
  for (size_t i = 0; i < views.size(); ++i) {
    const Integrals up = spheres[i].over(true), down = spheres[i].over(false);
    INFO(fmt::format("material {}, cosine {}", i, views[i].wo.z));
    for (int c = 0; c < 3; ++c) {
      const double sum = up[1 + c] + up[4 + c] + down[1 + c] + down[4 + c];
      CHECK(sum < 1 + k_table_error);
      // White sheen and a white base: what is missing is lost between layers. Coloured sheen dims all
      // channels.
      if (i % 2) CHECK(sum > 0.75);
    }
  }
}

TEST_CASE("a white diffuse surface stays white below a coat, sheen, and both") {
  Material coat = white_paint(), rough_coat = coat, sheen = coat, both = coat;
  coat.clearcoat = 1, coat.clearcoat_roughness = 0.1f;
  rough_coat.clearcoat = 0.6f, rough_coat.clearcoat_roughness = 0.8f;
  sheen.sheen = vec3(1);
  both.sheen = vec3(1), both.sheen_roughness = 0.9f, both.clearcoat = 1, both.specular = 1;
  for (const Material& m : {coat, rough_coat, sheen})
    for (const double albedo : albedos(m)) CHECK(albedo == Approx(1).margin(k_table_error));
  // Light that sheen or dielectric reflect is seen through the coat by the lower of two transmittances.
  for (const double albedo : albedos(both)) {
    CHECK(albedo < 1 + k_table_error);
    CHECK(albedo > 0.85);
  }
}

TEST_CASE("a coat reflects the share that Fresnel's equations say, and dims what is below it") {
  Material black = white_paint();
  black.base = vec3(0), black.clearcoat = 1, black.clearcoat_roughness = 0.1f;
  const auto reflected = glossy(black);
  for (size_t i = 0; i < reflected.size(); ++i) {
    const double w = std::pow(1 - double(k_cosines[i]), 5);
    INFO("cosine " << k_cosines[i]);
    // The roughness blurs the grazing rise.
    if (k_cosines[i] >= 0.3f) CHECK(reflected[i] == Approx(0.04 + 0.96 * w).margin(0.004));
  }
  // A black and a white base differ by what passes the coat.
  Material white = black;
  white.base = vec3(1);
  const auto all = albedos(white);
  for (size_t i = 0; i < all.size(); ++i)
    CHECK(all[i] - reflected[i] == Approx(1 - reflected[i]).margin(k_table_error));
}

TEST_CASE("a smooth coat mirrors about its own normal, with Fresnel's share") {
  Material m = white_paint();
  m.base = vec3(0), m.clearcoat = 0.8f, m.clearcoat_roughness = 0;
  m.clearcoat_normal = glm::normalize(vec3(0.3f, 0, 1));
  Probe probe({m});
  const vec3 wo = direction(0.8, 0.3);
  const float cosine = glm::dot(wo, m.clearcoat_normal);
  const vec3 mirrored = 2 * cosine * m.clearcoat_normal - wo;
  double sum = 0;
  size_t bad = 0;
  constexpr uint32_t k_draws = 4096;
  for (const Draw& d : probe.draw(0, wo, k_draws, 3)) {
    sum += double(d.weight.x) / k_draws;
    bad += d.weight != vec3(0) && (d.event != k_specular || !(glm::length(d.wi - mirrored) < 1e-5f));
  }
  CHECK(bad == 0);
  CHECK(sum == Approx(0.8 * (0.04 + 0.96 * std::pow(1 - double(cosine), 5))).epsilon(1e-4));
}

TEST_CASE("anisotropy of 0 changes nothing, and brushed metal loses little") {
  Material m;
  m.metallic = 1, m.base = vec3(1), m.roughness = 0.4f;
  Material brushed = m;
  brushed.anisotropy = 1e-6f;
  Probe probe({m, brushed});
  for (const float phi : {0.1f, 1.3f}) {
    const vec3 wo = direction(0.6, 0.4), wi = direction(0.7, 3.5 + double(phi));
    const auto v = probe.evaluate({{0, wo, wi}, {1, wo, wi}});
    CHECK(v[1].glossy.x == Approx(v[0].glossy.x).epsilon(1e-4));
    CHECK(v[1].pdf == Approx(v[0].pdf).epsilon(1e-4));
  }
  for (const float roughness : {0.2f, 0.5f})
    for (const float anisotropy : {0.4f, 0.9f}) {
      brushed.roughness = roughness, brushed.anisotropy = anisotropy;
      INFO("roughness " << roughness << ", anisotropy " << anisotropy);
      for (const double albedo : albedos(brushed)) CHECK(albedo == Approx(1).margin(0.1));
    }
}

TEST_CASE("brushed metal reflects more widely along the grain") {
  Material m;
  m.metallic = 1, m.roughness = 0.3f, m.anisotropy = 0.8f, m.grain = vec2(1, 0);
  Probe probe({m});
  const vec3 wo(0, 0, 1), along = direction(0.8, 0), across = direction(0.8, 1.5707963);
  const auto v = probe.evaluate({{0, wo, along}, {0, wo, across}});
  CHECK(v[0].glossy.x > 15 * v[1].glossy.x);
  // The ratio of D at both facets.
  const double along_x = 0.09 + (1 - 0.09) * 0.64, across_y = 0.09;
  const double c2 = 0.9, s2 = 0.1;  // of the half vector
  const auto d = [&](double a) { return 1 / std::pow(c2 + s2 / (a * a), 2); };
  const auto g = [&](double a) { return 1 / (1 + 0.5 * (std::sqrt(1 + a * a * 0.36 / 0.64) - 1)); };
  // The complement is the same in both.
  CHECK(double(v[0].glossy.x) / double(v[1].glossy.x) <
        d(along_x) * g(along_x) / (d(across_y) * g(across_y)));
}

TEST_CASE("a thin film: without thickness nothing, and thick ones have the mean of all phases") {
  Material m;
  m.metallic = 1, m.base = vec3(0.7f, 0.5f, 0.3f), m.roughness = 0.2f;
  Material none = m, thick = m;
  none.film = 1, none.film_thickness = 0;
  thick.film = 1, thick.film_ior = 1.4f, thick.film_thickness = 60000;
  Probe probe({m, none, thick});
  const vec3 wo = direction(0.9, 0.2), wi = direction(0.9, 3.3);
  const auto v = probe.evaluate({{0, wo, wi}, {1, wo, wi}, {2, wo, wi}});
  for (int c = 0; c < 3; ++c) {
    CHECK(v[1].glossy[c] == Approx(v[0].glossy[c]).epsilon(0.01));
    // Reflectances of the two faces, and light that goes to and fro between them without interference.
    const double r12 = std::pow(0.4 / 2.4, 2), root = std::sqrt(double(m.base[c])),
                 n = (1 + root) / (1 - root);
    const double r23 = std::pow((n - 1.4) / (n + 1.4), 2);
    const double expected = r12 + (1 - r12) * (1 - r12) * r23 / (1 - r12 * r23);
    CHECK(v[2].glossy[c] / v[0].glossy[c] == Approx(expected / double(m.base[c])).epsilon(0.03));
  }
}

TEST_CASE("a thin film's colours repeat with the wavelength") {
  // Normal incidence on glass: a film of intermediate index and a quarter of a wavelength is a reflection's
  // minimum. Green is darkest where the film is 550 nm / 4 thick, divided by its index.
  Material m;
  m.base = vec3(0), m.ior = 1.9f, m.roughness = 0.1f, m.film = 1, m.film_ior = 1.38f;
  std::vector<Material> list;
  for (int i = 0; i <= 40; ++i) {
    m.film_thickness = 40 + 4 * static_cast<float>(i);
    list.push_back(m);
  }
  Probe probe(list);
  std::vector<Question> questions;
  for (uint32_t i = 0; i < list.size(); ++i) questions.push_back({i, vec3(0, 0, 1), vec3(0, 0, 1)});
  const auto v = probe.evaluate(questions);
  size_t darkest = 0;
  for (size_t i = 0; i < v.size(); ++i)
    if (v[i].glossy.y < v[darkest].glossy.y) darkest = i;
  CHECK(double(list[darkest].film_thickness) == Approx(550 / 4.0 / 1.38).margin(8));
}

TEST_CASE("there were no validation messages: bsdf layers") { CHECK(device().validation_messages() == 0); }

}  // namespace bsdf_layers_tests
