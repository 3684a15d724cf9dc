// links: upload
// The parts of the surface model: the cosine lobe and the visible normals of GGX compared with their
// densities; variants without unused features give the same results.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "kernels/bsdf_support.h"
#include "kernels/statistics_support.h"

namespace bsdf_lobes_tests {

using namespace lucerna;
using namespace lucerna::test;
using namespace lucerna::test::bsdf;

namespace {

constexpr uint32_t k_draws = 1 << 16;

/// Compares draws of a subject, none of which is lost, with its density.
void judge(Subject subject, const std::vector<Material>& materials, const std::vector<float>& cosines) {
  Probe probe(materials, surface_effects(false), subject);
  std::vector<View> views;
  for (uint32_t m = 0; m < materials.size(); ++m)
    for (const float c : cosines) views.push_back({m, direction(c, 2.1)});
  std::vector<Sphere> spheres = integrate(probe, views, 2e-6, 1.0 / 256);
  Jury jury;
  for (size_t i = 0; i < views.size(); ++i) {
    Sphere& sphere = spheres[i];
    const std::string name =
        fmt::format("roughness {}, cosine {}", materials[views[i].material].roughness, views[i].wo.z);
    INFO(name);
    CHECK(sphere.pdf() == Approx(1).margin(2e-4));
    CHECK(sphere.over(false)[0] == 0);
    std::vector<double> observed(sphere.number_bins(1.0 / 256), 0.0), expected;
    for (const double p : sphere.probabilities()) expected.push_back(p * k_draws);
    size_t bad = 0;
    for (const Draw& d :
         probe.draw(views[i].material, views[i].wo, k_draws, 100 + static_cast<uint32_t>(i))) {
      bad += !(d.pdf > 0 && d.wi.z >= 0 && std::abs(glm::length(d.wi) - 1) < 1e-5f);
      observed[sphere.bin_of(d.wi)] += 1;
    }
    CHECK(bad == 0);
    jury.add(name, chi_square(observed, expected).p);
  }
  CHECK(jury.verdict() == "");
}

}  // namespace

TEST_CASE("the cosine lobe, and the disk that it is projected from: chi^2") {
  judge(Subject::cosine, {{}}, {1, 0.5f});
}

TEST_CASE("visible normals from nearly smooth to fully rough, from above to grazing: chi^2") {
  std::vector<Material> materials;
  for (const float r : {0.05f, 0.2f, 0.45f, 0.75f, 1.f}) materials.emplace_back().roughness = r;
  judge(Subject::visible_normals, materials, {1, 0.7f, 0.3f, 0.05f, 0.01f});
}

TEST_CASE("a smaller variant of the shader gives the results of the full one") {
  struct Variant {
    const char* name;
    gpu::Defines defines;
    void (*change)(Material&);
  };
  const Variant variants[] = {
      {"nothing", surface_effects(false), [](Material& m) { m.specular = 0; }},
      {"diffuse transmission", surface_effects(false, {"LUCERNA_DIFFUSE_TRANSMISSION"}),
       [](Material& m) { m.specular = 0, m.diffuse_transmission = 0.4f; }},
      {"specular", surface_effects(false, {"LUCERNA_SPECULAR"}), [](Material& m) { m.metallic = 0.4f; }},
      {"thin glass", surface_effects(false, {"LUCERNA_THIN_GLASS", "LUCERNA_GLASS_SPECULAR"}),
       [](Material& m) { m.specular = 0, m.transmission = 0.7f; }},
      {"solid glass", surface_effects(false, {"LUCERNA_SOLID_GLASS", "LUCERNA_GLASS_SPECULAR"}),
       [](Material& m) { m.specular = 0, m.transmission = 0.7f, m.solid = 1, m.glass_row = 0; }},
      {"specular and thin glass", surface_effects(false, {"LUCERNA_SPECULAR", "LUCERNA_THIN_GLASS"}),
       [](Material& m) { m.metallic = 0.2f, m.transmission = 0.7f; }},
      {"specular and solid glass", surface_effects(false, {"LUCERNA_SPECULAR", "LUCERNA_SOLID_GLASS"}),
       [](Material& m) {
         m.metallic = 0.2f, m.transmission = 0.7f, m.solid = m.inside = 1, m.glass_row = 0;
       }}};
  for (const Variant& variant : variants)
    for (const float roughness : {0.f, 0.3f}) {
      INFO(variant.name << ", roughness " << roughness);
      Material m;
      m.roughness = roughness;
      variant.change(m);
      Probe full({m}), lean({m}, variant.defines);
      const vec3 wo = direction(0.4, 1);
      const auto a = full.draw(0, wo, 4096, 9), b = lean.draw(0, wo, 4096, 9);
      std::vector<Question> questions;
      for (const Draw& d : a) questions.push_back({0, wo, d.wi});
      const auto va = full.evaluate(questions), vb = lean.evaluate(questions);
      size_t draws = 0, values = 0;
      const auto differ = [](const vec3& x, const vec3& y) {
        return !(glm::length(x - y) <= 1e-4f * (glm::length(x) + 1e-3f));
      };
      for (size_t i = 0; i < a.size(); ++i) {
        draws += a[i].event != b[i].event || differ(a[i].wi, b[i].wi) || differ(a[i].weight, b[i].weight) ||
                 a[i].eta2 != b[i].eta2 || differ(vec3(a[i].pdf), vec3(b[i].pdf));
        values += differ(va[i].diffuse, vb[i].diffuse) || differ(va[i].glossy, vb[i].glossy) ||
                  differ(vec3(va[i].pdf), vec3(vb[i].pdf));
      }
      CHECK(values == 0);
      CHECK(draws <= 4);  // a choice between lobes may change by rounding
    }
}

TEST_CASE("there were no validation messages: bsdf lobes") { CHECK(device().validation_messages() == 0); }

}  // namespace bsdf_lobes_tests
