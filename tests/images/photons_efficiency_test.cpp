// links: session
// Caustics by photons in the parts of the picture where they are more efficient, by path tracing elsewhere:
// the pilot's estimates of both methods' noise are correct, and the mean does not change.
#include <catch2/catch.hpp>

#include "solvers/photons/solver.h"
#include "support/caustics.h"

namespace photons_efficiency_tests {

using namespace lucerna;
using test::with;

namespace {

constexpr uint32_t k_size = 32;
constexpr float k_small_lamp = 2000;

/// A floor of 4 m x 2 m under a black environment, seen from above, with a black wall across its middle. At
/// either end is a mirror that reflects a lamp on the wall: on the left a wide panel, on the right a small
/// bright one.
scene::Scene two_lamps(float roughness = 0) {
  scene::Scene s;
  s.name = "two lamps";
  s.materials = {test::diffuse(vec3(0.6f)),
                 {},
                 test::diffuse(vec3(0), vec3(4)),
                 test::diffuse(vec3(0), vec3(k_small_lamp)),
                 test::diffuse(vec3(0))};
  s.materials[1].metallic = 1, s.materials[1].roughness = roughness, s.materials[1].base_color = vec4(1);
  s.materials[4].double_sided = true;
  test::add_quad(s, {-2, 0, 1}, {4, 0, 0}, {0, 0, -2}, 0);
  test::add_quad(s, {-1.9f, 0, 0.9f}, {0, 0, -1.8f}, {0, 1, 0}, 1);           // faces +x
  test::add_quad(s, {1.9f, 0, -0.9f}, {0, 0, 1.8f}, {0, 1, 0}, 1);            // faces -x
  test::add_quad(s, {-0.05f, 0.05f, -0.9f}, {0, 0, 1.8f}, {0, 0.9f, 0}, 2);   // emits to -x
  test::add_quad(s, {0.05f, 0.5f, 0.02f}, {0, 0, -0.04f}, {0, 0.04f, 0}, 3);  // emits to +x
  test::add_quad(s, {0, 0, -3}, {0, 0, 6}, {0, 3.5f, 0}, 4);
  s.cameras = {test::looking_down({0, 4, 0}, 0.9f)};
  s.environment.given = true;
  return s;
}

struct Rendered {
  film::Image image;
  double by_photons = 1;
  photons::Regions regions;
};
Rendered render(const scene::Scene& scene, test::Settings settings, uint32_t samples) {
  session::Renderer r(test::renderer_options(samples <= test::k_validated_samples));
  r.settings().set("path.batch", test::k_batch);
  r.set_size(k_size, k_size);
  r.set_scene(std::make_shared<scene::Scene>(scene));
  settings["samples"] = std::to_string(samples);
  test::set(r, settings);
  Rendered out;
  out.image = test::finish(r);
  CHECK(r.device().validation_messages() == 0);
  CHECK(r.stats().dropped == 0);
  if (auto* solver = dynamic_cast<photons::PhotonSolver*>(r.solver("photons")))
    out.by_photons = solver->regions().by_photons, out.regions = solver->regions();
  return out;
}

const test::Settings k_caustics{
    {"components.primary", "off"}, {"components.secondary", "off"}, {"components.tertiary", "off"}};
const test::Settings k_by_photons = with(k_caustics, {{"components.caustic", "photons"}});

}  // namespace

/// Few enough photons that the wide lamp's light has less noise by path tracing.
const test::Settings k_few{{"photons.per_round", "4"}};

TEST_CASE("in the scenes made for caustics, photons compute them by default", "[photons_efficiency]") {
  // Around the bright caustics is faint light that few photons of the pilot find and that has most of the
  // noise of paths.
  for (const std::string name : {"glass", "ring"}) {
    INFO(name);
    session::Renderer r(test::renderer_options(true));
    r.set_size(64, 48);
    r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".gltf");
    test::set(r, {{"components.caustic", "photons"}, {"samples", "1"}});
    test::finish(r);
    const auto& solver = dynamic_cast<photons::PhotonSolver&>(*r.solver("photons"));
    CHECK(solver.regions().by_photons == 1);
  }
}

TEST_CASE("each part of the picture uses the more efficient method, with the same light",
          "[photons_efficiency]") {
  const scene::Scene scene = two_lamps();
  const Rendered both = render(scene, with(k_by_photons, k_few), 2048);
  CHECK(both.by_photons > 0.2);
  CHECK(both.by_photons < 0.9);
  CHECK(both.regions.gain > 1);
  // Compared with many photons everywhere: blurred by less than 1 %.
  const Rendered photons = render(scene, with(k_by_photons, {{"photons.efficiency", "false"}}), 256);
  CHECK(photons.by_photons == 1);
  for (const auto& [first, end] : {std::pair{2u, 10u}, {10u, 22u}, {22u, 30u}}) {
    const test::MeanOf a = test::mean_of(both.image, 3, first, 0, end, k_size),
                       b = test::mean_of(photons.image, 3, first, 0, end, k_size);
    for (int c = 0; c < 3; ++c) {
      CAPTURE(first, c, a.value[c], a.noise[c], b.value[c], b.noise[c]);
      CHECK(std::abs(a.value[c] - b.value[c]) < 4 * std::hypot(a.noise[c], b.noise[c]) + 0.01 * b.value[c]);
    }
  }
  // The wide lamp's light has less noise than with this number of photons; the small lamp's has the same.
  const Rendered few =
      render(scene, with(with(k_by_photons, k_few), {{"photons.efficiency", "false"}}), 2048);
  const auto noise = [](const film::Image& image, uint32_t first, uint32_t end) {
    double sum = 0;
    for (uint32_t y = 4; y < k_size - 4; ++y)
      for (uint32_t x = first; x < end; ++x) {
        const size_t i = y * k_size + x;
        sum += std::pow(double(luminance(image.components[3][i] - image.odd_half[3][i])), 2);
      }
    return sum;
  };
  CHECK(noise(both.image, 22, 29) == Approx(noise(few.image, 22, 29)).epsilon(0.3));
  CHECK(noise(both.image, 4, 9) < 0.6 * noise(few.image, 4, 9));
}

TEST_CASE("where photons are nowhere more efficient none are traced, and the picture is path traced",
          "[photons_efficiency]") {
  scene::Scene scene = two_lamps();
  scene.materials[3].emission = vec3(0);  // the wide lamp alone
  const Rendered delegated = render(scene, with(k_by_photons, k_few), 8), path = render(scene, k_caustics, 8);
  CHECK(delegated.regions.nowhere);
  CHECK(delegated.by_photons == 0);
  CHECK(test::identical(delegated.image, path.image));
  CHECK(test::mean(delegated.image.components[3]) > 0);
}

TEST_CASE("regions are shown, and depend on scene, view and settings only", "[photons_efficiency]") {
  const scene::Scene scene = two_lamps();
  session::Renderer r(test::renderer_options());
  r.settings().set("path.batch", test::k_batch);
  r.set_size(k_size, k_size);
  r.set_scene(std::make_shared<scene::Scene>(scene));
  test::Settings settings = with(k_by_photons, k_few);
  settings["samples"] = "2";
  test::set(r, settings);
  const film::Image once = test::finish(r);
  const std::vector<uint8_t> plain = r.output().picture(false);
  test::set(r, {{"overlay.photon_density", "caustics"}});
  CHECK(r.output().picture(false) != plain);
  const auto& photons = dynamic_cast<photons::PhotonSolver&>(*r.solver("photons"));
  const std::vector<float> shown = photons.inspector().densities();
  const auto at = [&](uint32_t x) { return shown[(k_size / 2) * k_size + x]; };
  CHECK(at(26) == 1);
  CHECK(at(5) == 0);
  // In between: photons everywhere, another size, and paths in flight.
  test::set(r, {{"photons.efficiency", "false"}});
  CHECK_FALSE(test::identical(once, test::finish(r)));
  test::set(r, {{"photons.efficiency", "true"}});
  r.set_size(20, 24);
  test::finish(r);
  r.set_size(k_size, k_size);
  CHECK(test::identical(once, test::finish(r)));
  test::Settings batch = with(k_by_photons, k_few);
  batch["path.batch"] = "1024";
  const test::Result again =
      test::render({.width = k_size, .height = k_size, .samples = 2, .settings = batch}, &scene);
  CHECK(test::identical(once, again.image));
}

TEST_CASE("the pilot's noise estimates are correct for both methods", "[photons_efficiency]") {
  const test::Settings photons =
      with(k_by_photons, {{"photons.per_round", "64"}, {"photons.alpha", "1"}, {"photons.radius", "0.8"}});
  // Variance of one sample, over pixels of the middle rows from column `x`, from the halves of few samples:
  // the whole minus one half is half of the halves' difference, whose variance is that of the mean.
  constexpr uint32_t k_rows = 20, k_columns = 6, k_samples = 32;
  const auto measured = [&](const film::Image& image, uint32_t x) {
    double sum = 0;
    for (uint32_t v = 6; v < 6 + k_rows; ++v)
      for (uint32_t u = x; u < x + k_columns; ++u) {
        const size_t i = v * k_size + u;
        sum += std::pow(double(luminance(image.components[3][i] - image.odd_half[3][i])), 2);
      }
    return sum * k_samples / (k_rows * k_columns);
  };
  // Smooth mirrors, and rough ones on which paths sample the lamps.
  for (const float roughness : {0.0f, 0.3f}) {
    const scene::Scene scene = two_lamps(roughness);
    const Rendered reported = render(scene, photons, 1);
    const film::Image path = render(scene, k_caustics, k_samples).image,
                      counted =
                          render(scene, with(photons, {{"photons.efficiency", "false"}}), k_samples).image;
    for (const uint32_t x : {4u, 22u}) {
      photons::Region mean;
      double n = 0;
      for (uint32_t v = 3; v < 13; ++v)
        for (uint32_t u = x / 2; u < x / 2 + 3; ++u) {
          const photons::Region& r = reported.regions.all[v * reported.regions.width + u];
          mean.mean += r.mean, mean.photons += r.photons, mean.paths += r.paths, ++n;
        }
      mean.mean /= n, mean.photons /= n, mean.paths /= n;
      CAPTURE(roughness, x, mean.mean, mean.paths, measured(path, x), mean.photons, measured(counted, x));
      // Samples are stratified, so they have slightly less noise than independent ones.
      const double photon_ratio = measured(counted, x) / mean.photons;
      CHECK(photon_ratio > 0.4);
      CHECK(photon_ratio < 1.5);
      if (roughness == 0 && x == 22) {
        // Almost no path hits the small lamp: 0.6 times its radiance with a small probability.
        CHECK(mean.paths == Approx(0.6 * double(k_small_lamp) * mean.mean).epsilon(0.05));
      } else {
        // Light samples and light paths choose lamps by different probabilities, and the heuristics differ.
        const double path_ratio = measured(path, x) / mean.paths;
        CHECK(path_ratio > 0.3);
        CHECK(path_ratio < 4);
      }
    }
  }
}

}  // namespace photons_efficiency_tests
