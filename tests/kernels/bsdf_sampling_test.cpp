// links: upload
// bsdf_sample() compared with bsdf_eval(), through the real shader: every lobe and mixture, from above to
// grazing, glass from both sides.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "kernels/bsdf_support.h"
#include "kernels/statistics_support.h"
#include "shaders/shared/bsdf_table.h"

namespace bsdf_sampling_tests {

using namespace lucerna;
using namespace lucerna::test;
using namespace lucerna::test::bsdf;

namespace {

constexpr float k_cosines[] = {0.98f, 0.6f, 0.2f, 0.03f};
constexpr uint32_t k_draws = 1 << 16;
constexpr double k_bin = 1.0 / 128;  ///< maximum probability of a bin of the histogram

struct Named {
  std::string name;
  Material material;
};

std::vector<Named> materials() {
  std::vector<Named> list;
  const auto add = [&](const char* name, float roughness, void (*change)(Material&)) {
    Material m;
    m.roughness = roughness;
    change(m);
    list.push_back({fmt::format("{}, roughness {}", name, roughness), m});
  };
  add("Lambertian", 1, [](Material& m) { m.specular = 0; });
  for (const float r : {0.f, 0.15f, 0.5f, 1.f}) add("coat", r, [](Material&) {});
  add("coloured coat", 0.3f, [](Material& m) { m.specular_color = vec3(1, 0.2f, 0.5f), m.ior = 2; });
  for (const float r : {0.f, 0.05f, 0.1f, 0.4f, 1.f}) add("metal", r, [](Material& m) { m.metallic = 1; });
  add("half metal", 0.3f, [](Material& m) { m.metallic = 0.5f; });
  for (const float r : {0.f, 0.15f, 0.5f, 1.f}) add("thin glass", r, [](Material& m) { m.transmission = 1; });
  add("diffuse transmission", 1, [](Material& m) { m.specular = 0, m.diffuse_transmission = 0.6f; });
  for (const float r : {0.f, 0.4f})
    add("coated diffuse transmission", r, [](Material& m) { m.diffuse_transmission = 0.6f; });
  for (const float r : {0.f, 0.35f})
    add("thin mixture", r,
        [](Material& m) { m.metallic = 0.3f, m.transmission = 0.5f, m.diffuse_transmission = 0.5f; });
  for (const float r : {0.1f, 0.5f, 1.f}) {
    add("rough diffuse", r, [](Material& m) { m.specular = 0; });
    list.back().material.diffuse_roughness = r;
    add("rough diffuse below a coat, translucent", r, [](Material& m) { m.diffuse_transmission = 0.3f; });
    list.back().material.diffuse_roughness = r;
  }
  const vec3 tilted = glm::normalize(vec3(0.2f, -0.1f, 1));
  add("clear coat over paint", 0.5f, [](Material& m) { m.clearcoat = 1; });
  add("clear coat over metal", 0.1f,
      [](Material& m) { m.metallic = 1, m.clearcoat = 0.7f, m.clearcoat_roughness = 0.15f; });
  add("clear coat over thin glass", 0.2f, [](Material& m) { m.transmission = 1, m.clearcoat = 1; });
  add("sheen", 1, [](Material& m) { m.specular = 0, m.sheen = vec3(0.9f, 0.5f, 0.2f); });
  add("sheen of short fibres under a clear coat", 0.6f,
      [](Material& m) { m.sheen = vec3(1), m.sheen_roughness = 0.15f, m.clearcoat = 0.5f; });
  for (const float r : {0.15f, 0.3f, 0.6f})
    add("brushed metal", r, [](Material& m) { m.metallic = 1, m.anisotropy = 0.7f; });
  add("thin film on metal", 0.3f, [](Material& m) { m.metallic = 1, m.film = 1; });
  add("thin film on paint", 0.2f, [](Material& m) { m.film = 0.8f, m.film_thickness = 250; });
  add("clear coat with a normal of its own", 0.5f, [](Material& m) { m.clearcoat = 1; });
  list.back().material.clearcoat_normal = tilted;
  const size_t solids = list.size();
  for (const float r : {0.f, 0.05f, 0.15f, 0.5f, 1.f})
    add("glass", r, [](Material& m) { m.transmission = 1, m.solid = 1, m.glass_row = 0; });
  add("dense glass", 0.3f,
      [](Material& m) { m.transmission = 1, m.solid = 1, m.glass_row = 1, m.ior = 2.4f; });
  for (const float r : {0.f, 0.4f})
    add("glass mixture", r, [](Material& m) {
      m.transmission = 0.6f, m.solid = 1, m.glass_row = 0, m.metallic = 0.2f, m.diffuse_transmission = 0.5f;
    });
  for (size_t i = solids, n = list.size(); i < n; ++i) {
    list.push_back({list[i].name + " from inside", list[i].material});
    list.back().material.inside = 1;
  }
  return list;
}

bool is_smooth(const Material& m) { return m.alpha() < shared::k_delta_alpha && m.anisotropy == 0; }

/// The outcome of a draw: label, side.
enum Way : size_t { k_ways = 8 };
size_t way(uint32_t event, bool transmitted) { return 2 * event + transmitted; }

struct Outcome {
  std::string name;
  uint32_t index;  ///< of the material, in the probe
  Material material;
  vec3 wo;
  Sphere sphere;
  ChiSquare histogram;
  double lost = 0;   ///< share of draws with weight 0
  double delta = 0;  ///< share of deltas
  std::array<std::array<Mean, 3>, k_ways> weights;
  std::vector<Draw> draws;  ///< the first few
};

Probe& probe() {
  static Probe instance = [] {
    std::vector<Material> list;
    for (const Named& n : materials()) list.push_back(n.material);
    return Probe(list);
  }();
  return instance;
}

const std::vector<Outcome>& outcomes() {
  static const std::vector<Outcome> all = [] {
    std::vector<View> views;
    const std::vector<Named> named = materials();
    for (uint32_t i = 0; i < named.size(); ++i)
      for (const float c : k_cosines) views.push_back({i, direction(c, 0.7)});
    std::vector<Sphere> spheres = integrate(probe(), views, 4e-6, k_bin);
    std::vector<Outcome> result;
    for (size_t i = 0; i < views.size(); ++i) {
      Outcome o;
      o.name = fmt::format("{}, cosine {}", named[views[i].material].name, views[i].wo.z);
      o.index = views[i].material;
      o.material = named[o.index].material;
      o.wo = views[i].wo;
      o.sphere = std::move(spheres[i]);
      const int bins = o.sphere.number_bins(k_bin);
      o.draws = probe().draw(o.index, o.wo, k_draws, static_cast<uint32_t>(i));
      // One more bin for outcomes without a density.
      std::vector<double> observed(bins + 1, 0.0), expected;
      for (const double p : o.sphere.probabilities()) expected.push_back(p * k_draws);
      expected.push_back((1 - o.sphere.pdf()) * k_draws);
      for (const Draw& d : o.draws) {
        const bool delta = d.event >= k_specular, lost = d.weight == vec3(0);
        o.delta += double(delta) / k_draws, o.lost += double(lost) / k_draws;
        observed[delta || lost ? bins : o.sphere.bin_of(d.wi)] += 1;
        for (int c = 0; c < 3; ++c) o.weights[way(d.event, d.transmitted)][c].add(d.weight[c]);
      }
      // For every other outcome the draw contributes 0.
      for (auto& rgb : o.weights)
        for (Mean& mean : rgb) mean.count = k_draws;
      o.histogram = chi_square(observed, expected);
      o.draws.resize(1 << 12);
      result.push_back(std::move(o));
    }
    return result;
  }();
  return all;
}

/// Reflectance between two media by the angles on both sides (Fresnel's textbook equations).
double fresnel(double cosine, double eta) {
  const double i = std::acos(cosine), sine = std::sin(i) / eta;
  if (sine >= 1) return 1;
  const double t = std::asin(sine);
  if (i < 1e-4) return (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1));
  const double s = std::sin(i - t) / std::sin(i + t), p = std::tan(i - t) / std::tan(i + t);
  return 0.5 * (s * s + p * p);
}

/// Mean weight of a smooth surface's deltas, by outcome and channel.
std::array<std::array<double, 3>, k_ways> smooth_weights(const Material& m, double cosine) {
  std::array<std::array<double, 3>, k_ways> w{};
  const double dielectric = (1.0 - m.metallic) * (1.0 - m.transmission),
               glass = (1.0 - m.metallic) * m.transmission;
  const double grazing = std::pow(1 - cosine, 5), f0 = std::pow((m.ior - 1) / (m.ior + 1), 2) * m.specular;
  double r = fresnel(cosine, m.eta());
  if (!m.solid) r = 2 * r / (1 + r);
  for (int c = 0; c < 3; ++c) {
    const double coat = std::min(1.0, f0 * m.specular_color[c]);
    w[way(k_specular, false)][c] = m.metallic * (m.base[c] + (1 - m.base[c]) * grazing) +
                                   dielectric * (coat + (m.specular - coat) * grazing) + glass * r;
    const double through = glass * (1 - r) * m.base[c];
    if (m.solid)
      w[way(k_specular, true)][c] = through / (m.eta() * m.eta());
    else
      w[way(k_null, true)][c] = through;
  }
  return w;
}

}  // namespace

TEST_CASE("draws follow the density: chi^2, with lost draws and deltas as a separate bin") {
  Jury jury;
  for (const Outcome& o : outcomes()) jury.add(o.name, o.histogram.p);
  CHECK(jury.verdict() == "");
}

TEST_CASE("the density integrates to 1 minus lost draws and deltas") {
  Jury jury;
  for (const Outcome& o : outcomes()) {
    INFO(o.name << ": density " << o.sphere.pdf() << ", lost " << o.lost << ", deltas " << o.delta);
    CHECK(o.sphere.pdf() < 1 + 1e-4);
    if (o.lost == 0 && o.delta == 0) CHECK(o.sphere.pdf() == Approx(1).margin(2e-4));
    const double q = o.lost + o.delta, error = std::sqrt(q * (1 - q) / k_draws);
    const double off = std::max(0.0, std::abs(1 - o.sphere.pdf() - q) - 1e-4);
    jury.add(o.name, off == 0 ? 1 : error == 0 ? 0 : normal_tail(off / error));
  }
  CHECK(jury.verdict() == "");
}

TEST_CASE("the mean weight of each label, side and channel is the integral of that label's lobes") {
  Jury jury;
  for (const Outcome& o : outcomes()) {
    const bool smooth = is_smooth(o.material);
    std::array<std::array<double, 3>, k_ways> expected{};
    if (smooth) expected = smooth_weights(o.material, o.wo.z);
    for (const bool below : {false, true}) {
      const Integrals f = o.sphere.over(!below);
      for (int c = 0; c < 3; ++c)
        expected[way(k_diffuse, below)][c] = f[1 + c], expected[way(k_glossy, below)][c] = f[4 + c];
    }
    for (size_t w = 0; w < k_ways; ++w)
      for (int c = 0; c < 3; ++c)
        jury.add(fmt::format("{}: event {}, transmitted {}, channel {}: {} +- {}, integral {}", o.name, w / 2,
                             w % 2, c, o.weights[w][c].value(), o.weights[w][c].error(), expected[w][c]),
                 mean_tail(o.weights[w][c], expected[w][c], 1e-4));
  }
  CHECK(jury.verdict() == "");
}

TEST_CASE("a draw's label, side and density are correct") {
  for (const Outcome& o : outcomes()) {
    INFO(o.name);
    const Material& m = o.material;
    const bool smooth = is_smooth(m);
    const float eta = m.eta();
    const vec3 mirrored(-o.wo.x, -o.wo.y, o.wo.z);
    const float bent = std::sqrt(std::max(0.f, 1 - (1 - o.wo.z * o.wo.z) / (eta * eta)));
    const vec3 refracted(-o.wo.x / eta, -o.wo.y / eta, -bent);
    // The densities again, evaluated in the drawn directions.
    std::vector<Question> questions;
    for (const Draw& d : o.draws) questions.push_back({o.index, o.wo, d.wi});
    const std::vector<Value> values = probe().evaluate(questions);
    size_t bad_length = 0, bad_side = 0, bad_scale = 0, bad_pdf = 0, bad_delta = 0, bad_weight = 0;
    for (size_t i = 0; i < o.draws.size(); ++i) {
      const Draw& d = o.draws[i];
      const bool delta = d.event >= k_specular;
      for (int c = 0; c < 3; ++c) bad_weight += !(d.weight[c] >= 0 && d.weight[c] < 1e6f);
      bad_length += !(std::abs(glm::length(d.wi) - 1) < 1e-5f);
      bad_side += (d.wi.z < 0) != (d.transmitted != 0);
      const bool refraction = m.solid && d.transmitted && d.event != k_diffuse;
      bad_scale += !(std::abs(d.eta2 - (refraction ? 1 / (eta * eta) : 1.f)) < 1e-5f);
      if (delta) {
        const vec3 expected = d.event == k_null ? -o.wo : d.transmitted ? refracted : mirrored;
        bad_delta += !smooth || d.pdf != 0 || !(glm::length(d.wi - expected) < 1e-5f) ||
                     (d.event == k_null && (m.solid || !d.transmitted));
      } else if (d.weight != vec3(0)) {
        bad_pdf += !(d.pdf > 0 && std::abs(d.pdf / values[i].pdf - 1) < 1e-4f);
      }
    }
    CHECK(bad_length == 0);
    CHECK(bad_side == 0);
    CHECK(bad_scale == 0);
    CHECK(bad_pdf == 0);
    CHECK(bad_delta == 0);
    CHECK(bad_weight == 0);
  }
}

TEST_CASE("there were no validation messages: bsdf sampling") { CHECK(device().validation_messages() == 0); }

}  // namespace bsdf_sampling_tests
