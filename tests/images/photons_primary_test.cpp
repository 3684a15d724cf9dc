// links: session
// Direct light from photons (components.primary=photons): compared with a closed form and with path tracing,
// together with other solvers; other components do not change.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/caustics.h"

namespace photons_primary_tests {

using namespace lucerna;
using test::identical, test::mean_of, test::MeanOf, test::with;

namespace {

const test::Settings k_primary{{"components.primary", "photons"}};

/// An open room with a lamp, an uneven sky, an emissive block, a mirror and a coat on the floor: direct light
/// of every kind, which the camera also sees in the mirror.
scene::Scene lit_room() {
  scene::Scene s = test::block_room(true);
  s.materials[1].emission = {0.6f, 0.3f, 0.1f};
  scene::Material mirror, coated = test::diffuse({0.4f, 0.5f, 0.6f});
  mirror.metallic = 1, mirror.roughness = 0, mirror.base_color = vec4(0.9f, 0.9f, 0.9f, 1);
  coated.specular = 1, coated.ior = 2, coated.roughness = 0.4f;
  s.materials.insert(s.materials.end(), {mirror, coated});
  test::add_quad(s, {-1.4f, 0.2f, -1.98f}, {2.8f, 0, 0}, {0, 1.8f, 0}, 2);
  test::add_quad(s, {-1.9f, 0.01f, 1.9f}, {3.8f, 0, 0}, {0, 0, -3.8f}, 3);
  return s;
}

/// Blocks of 8x8 pixels agree: two-sided at 1e-5 for each (4.4 standard errors of both pictures, from the
/// halves) plus 8 % for the blur at shadows' edges, and the whole within 1.5 %.
void agree(const film::Image& path, const film::Image& photons) {
  for (uint32_t y = 0; y + 8 <= path.height; y += 8)
    for (uint32_t x = 0; x + 8 <= path.width; x += 8) {
      const MeanOf a = mean_of(path, 0, x, y, x + 8, y + 8), b = mean_of(photons, 0, x, y, x + 8, y + 8);
      for (int c = 0; c < 3; ++c) {
        INFO("block at " << x << ", " << y << ", channel " << c << ": " << b.value[c] << " of "
                         << a.value[c]);
        CHECK(std::abs(a.value[c] - b.value[c]) <=
              4.4 * std::hypot(a.noise[c], b.noise[c]) + 0.08 * a.value[c]);
      }
    }
  const MeanOf a = mean_of(path, 0), b = mean_of(photons, 0);
  for (int c = 0; c < 3; ++c)
    CHECK(std::abs(a.value[c] - b.value[c]) <= 4.4 * std::hypot(a.noise[c], b.noise[c]) + 0.015 * a.value[c]);
}

}  // namespace

TEST_CASE("a sun on a plane: photons give the irradiance of the closed form, up to the border") {
  scene::Scene s;
  s.name = "plane";
  s.materials = {test::diffuse({0.8f, 0.5f, 0.2f})};
  test::add_quad(s, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = {3, 4, 5}}};
  s.lights[0].direction = glm::normalize(vec3(0.6f, -0.8f, 0));
  s.cameras = {test::looking_down({0, 0.9f, 0}, 0.8f)};
  s.environment.given = true;
  const test::Result r = test::render(s, with(k_primary, {{"photons.per_round", "100000"}}), 16, 32);
  const MeanOf all = mean_of(r.image, 0);
  for (int c = 0; c < 3; ++c)
    CHECK(all.value[c] ==
          Approx(double(s.materials[0].base_color[c] * s.lights[0].intensity[c]) * 0.8 / double(k_pi))
              .epsilon(0.01));
  // No shadow ray is necessary, and the error is known not to be noise alone.
  CHECK(r.stats.shadow_rays == 0);
  CHECK_FALSE(r.bias_known[0]);
  CHECK(r.bias_known[1]);
}

TEST_CASE("direct light of lamps, sky and emitters agrees with path tracing, also in a mirror") {
  const scene::Scene room = lit_room();
  const test::Result path = test::render(room, {}, 128, 32);
  const test::Result photons = test::render(room, with(k_primary, {{"photons.per_round", "32768"}}), 64, 32);
  agree(path.image, photons.image);
  // The other components are traced as before. Samples of a pixel are summed in other groups.
  const test::Result same = test::render(room, {}, 64, 32);
  for (int c = 1; c < 4; ++c) {
    float most = 0;
    for (size_t i = 0; i < same.image.components[c].size(); ++i)
      most = std::max(most, glm::length(same.image.components[c][i] - photons.image.components[c][i]));
    CHECK(most < 1e-6f * float(test::mean(same.image.components[c])) + 1e-7f);
  }
}

TEST_CASE("direct light from photons together with other solvers") {
  const scene::Scene room = lit_room();
  const test::Settings all = with(k_primary, {{"photons.per_round", "32768"}});
  const test::Result path = test::render(room, {}, 128, 32);
  const test::Settings few{{"cache.max_rays", "256"}, {"cache.passes", "4"}};
  for (const test::Settings& others :
       {with(few, {{"components.secondary", "cache"}, {"components.tertiary", "photons"}}),
        test::Settings{{"components.secondary", "photons"},
                       {"components.tertiary", "photons"},
                       {"components.caustic", "photons"}},
        test::Settings{{"components.secondary", "off"},
                       {"components.tertiary", "off"},
                       {"components.caustic", "off"}}}) {
    std::string names;
    for (const auto& [key, value] : others) names += key + "=" + value + " ";
    INFO(names);
    const test::Result mixed = test::render(room, with(all, others), 48, 32);
    agree(path.image, mixed.image);
    if (others.contains("components.caustic")) continue;  // photons find more than paths
    for (int c = 1; c < 4; ++c)
      CHECK(test::mean(mixed.image.components[c]) ==
            Approx(test::mean(path.image.components[c])).epsilon(0.1).margin(2e-3));
  }
}

TEST_CASE("paths compute primary light while records cannot serve it, and when nothing of it is stored") {
  const scene::Scene room = lit_room();
  const test::Settings cached{{"components.primary", "cache"}};
  // Secondary light is path traced: no records.
  const test::Result plain = test::render(room, {}, 4, 32), same = test::render(room, cached, 4, 32);
  for (int c = 0; c < 4; ++c) CHECK(identical(plain.image.components[c], same.image.components[c]));
  CHECK(same.bias_known[0]);
  // Only primary light: the records store the sky alone.
  const test::Settings off{
      {"components.secondary", "off"}, {"components.tertiary", "off"}, {"components.caustic", "off"}};
  const test::Result truth = test::render(room, off, 128, 32);
  agree(truth.image, test::render(room, with(cached, off), 32, 32).image);
  // There is no sky.
  scene::Scene closed = test::block_room();
  const test::Result dark = test::render(closed, with(cached, off), 4, 32);
  CHECK(identical(dark.image.components[0], test::render(closed, off, 4, 32).image.components[0]));
  CHECK(dark.bias_known[0]);
}

}  // namespace photons_primary_tests
