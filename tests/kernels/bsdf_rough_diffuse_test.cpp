// links: upload
// shaders/lib/rough_diffuse.glsl: its equations in double precision, energy, and what its sampling gains.
// Draws are compared with densities in bsdf_sampling_test.cpp, reciprocity is tested in bsdf_layers_test.cpp.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "kernels/bsdf_support.h"
#include "kernels/statistics_support.h"

namespace rough_diffuse_tests {

using namespace lucerna;
using namespace lucerna::test;
using namespace lucerna::test::bsdf;

namespace {

constexpr double k_pi_d = 3.14159265358979323846;
constexpr float k_cosines[] = {1, 0.7f, 0.35f, 0.08f, 0.02f};

/// As the paper writes it: albedo of a white surface with one bounce, by its closed form.
double albedo_of_one_bounce(double mu, double r) {
  const double s = std::sqrt(1 - mu * mu), a = 1 / (1 + (0.5 - 2 / (3 * k_pi_d)) * r);
  const double g = s * (std::acos(mu) - s * mu) + 2.0 / 3 * (s / mu * (1 - s * s * s) - s);
  return a + r * a / k_pi_d * g;
}

/// The model's value times pi, of one channel.
double eon(double color, double r, const vec3& wo, const vec3& wi) {
  const double mu_o = double(wo.z), mu_i = double(wi.z), s = double(glm::dot(wo, wi)) - mu_o * mu_i;
  const double t = s > 0 ? std::max(mu_o, mu_i) : 1, a = 1 / (1 + (0.5 - 2 / (3 * k_pi_d)) * r);
  const double mean = a * (1 + (2.0 / 3 - 28 / (15 * k_pi_d)) * r);
  const double of_many = color * color * mean / (1 - color * (1 - mean));
  return color * a * (1 + r * s / t) +
         of_many * (1 - albedo_of_one_bounce(mu_o, r)) * (1 - albedo_of_one_bounce(mu_i, r)) / (1 - mean);
}

Material rough(float roughness, vec3 color = vec3(1)) {
  Material m;
  m.base = color, m.specular = 0, m.diffuse_roughness = roughness;
  return m;
}

gpu::Defines diffuse_only() { return surface_effects(false, {"LUCERNA_ROUGH_DIFFUSE"}); }

}  // namespace

TEST_CASE("rough diffuse surfaces have the values of the paper's equations") {
  const vec3 color(0.9f, 0.5f, 0.1f);
  for (const gpu::Defines& defines : {diffuse_only(), surface_effects(true)})
    for (const float r : {0.05f, 0.4f, 1.f}) {
      Probe probe({rough(r, color)}, defines);
      std::vector<Question> questions;
      for (const float o : k_cosines)
        for (const float i : k_cosines)
          for (const double phi : {0.0, 1.0, 3.0})
            questions.push_back({0, direction(o, 0.4), direction(i, 0.4 + phi)});
      const auto values = probe.evaluate(questions);
      for (size_t k = 0; k < values.size(); ++k) {
        const Question& q = questions[k];
        INFO(fmt::format("roughness {}, cosines {} and {}", r, q.wo.z, q.wi.z));
        for (int c = 0; c < 3; ++c)
          CHECK(double(values[k].diffuse[c]) ==
                Approx(eon(double(color[c]), double(r), q.wo, q.wi) * double(q.wi.z) / k_pi_d).epsilon(5e-4));
      }
    }
}

TEST_CASE("a white rough surface reflects all light at every angle") {
  for (const float r : {0.2f, 0.6f, 1.f}) {
    Probe probe({rough(r)}, diffuse_only());
    std::vector<View> views;
    for (const float c : k_cosines) views.push_back({0, direction(c, 0.4)});
    for (const Sphere& sphere : integrate(probe, views, 1e-5))
      CHECK(sphere.over(true)[1] == Approx(1).margin(5e-4));
  }
}

TEST_CASE("below a dielectric's reflection a rough surface gains no light, and loses little") {
  for (const float gloss : {0.f, 0.4f, 1.f})
    for (const float r : {0.3f, 1.f}) {
      Material m = rough(r);
      m.specular = 1, m.roughness = gloss;
      Probe probe({m});
      std::vector<View> views;
      for (const float c : k_cosines) views.push_back({0, direction(c, 0.4)});
      const auto spheres = integrate(probe, views, 1e-5);
      // The mirror's light is a delta: it is known.
      for (size_t i = 0; i < spheres.size(); ++i) {
        const Integrals up = spheres[i].over(true);
        const double w = std::pow(1 - double(k_cosines[i]), 5),
                     mirrored = gloss == 0 ? 0.04 + 0.96 * w : up[4];
        INFO(fmt::format("gloss {}, roughness {}, cosine {}", gloss, r, k_cosines[i]));
        CHECK(up[1] + mirrored < 1 + 5e-3);
        CHECK(up[1] + mirrored > 0.96);
      }
    }
}

TEST_CASE("roughness 0 is Lambert's model, bit for bit") {
  Material m = rough(0, vec3(0.7f, 0.2f, 0.4f));
  m.specular = 0.8f;
  Probe with({m}, surface_effects(false, {"LUCERNA_SPECULAR", "LUCERNA_ROUGH_DIFFUSE"})),
      without({m}, surface_effects(false, {"LUCERNA_SPECULAR"}));
  std::vector<Question> questions;
  for (const float o : k_cosines)
    for (const float i : k_cosines) questions.push_back({0, direction(o, 0.4), direction(i, 2)});
  const auto a = with.evaluate(questions), b = without.evaluate(questions);
  size_t other = 0;
  for (size_t i = 0; i < a.size(); ++i) other += a[i].diffuse != b[i].diffuse || a[i].pdf != b[i].pdf;
  CHECK(other == 0);
  const auto drawn = with.draw(0, direction(0.5, 1), 1024, 7),
             drawn_without = without.draw(0, direction(0.5, 1), 1024, 7);
  for (size_t i = 0; i < drawn.size(); ++i)
    other += drawn[i].wi != drawn_without[i].wi || drawn[i].weight != drawn_without[i].weight;
  CHECK(other == 0);
}

// Relative variance of a draw's weight. By quadrature a cosine's draws have 1.2 and .38 here, these .06 and
// .045.
TEST_CASE("draws follow the rough lobe") {
  Probe probe({rough(1)}, diffuse_only());
  for (const auto& [cosine, most] : {std::pair{0.02, 0.08}, std::pair{0.3, 0.06}}) {
    double sum = 0, squares = 0;
    constexpr uint32_t k_draws = 1 << 15;
    for (const Draw& d : probe.draw(0, direction(cosine, 0.4), k_draws, 11))
      sum += double(d.weight.x) / k_draws, squares += double(d.weight.x) * double(d.weight.x) / k_draws;
    INFO("cosine " << cosine);
    CHECK(sum == Approx(1).margin(0.01));
    CHECK(squares - sum * sum < most);
  }
}

TEST_CASE("there were no validation messages: rough diffuse") { CHECK(device().validation_messages() == 0); }

}  // namespace rough_diffuse_tests
