// links: session
// What the noise comes from, by recorded paths: the component that makes it, as the film's halves estimate
// it, and a setting that is proposed.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/render.h"

namespace noise_tests {

using namespace lucerna;

namespace {

std::unique_ptr<session::Renderer> renderer_of(const std::string& scene, const test::Settings& settings,
                                               uint32_t samples) {
  auto renderer = std::make_unique<session::Renderer>(test::renderer_options(false));
  renderer->settings().set("path.batch", test::k_batch);
  renderer->set_size(64, 64);
  renderer->load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + scene + "/" + scene + ".gltf");
  test::Settings all = settings;
  all["samples"] = std::to_string(samples);
  all.try_emplace("cache.max_records", test::k_room);
  test::set(*renderer, all);
  return renderer;
}

double share(const std::vector<recording::NoiseShare>& shares, const std::string& name) {
  for (const recording::NoiseShare& s : shares)
    if (s.name == name) return s.noise;
  return 0;
}

}  // namespace

TEST_CASE("noise is explained by component and way of light, and a setting is proposed") {
  // Caustics alone.
  const auto renderer = renderer_of("glass",
                                    {{"components.caustic", "path"},
                                     {"components.primary", "off"},
                                     {"components.secondary", "off"},
                                     {"components.tertiary", "off"}},
                                    16);
  const film::Image before = test::finish(*renderer);
  const recording::NoiseReport report = renderer->paths().explain_noise({0, 0}, {1, 1});
  INFO(report.sentence);
  CHECK(report.pixels > 300);
  REQUIRE(!report.components.empty());
  CHECK(report.components[0].name == "caustic");
  CHECK(report.components[0].noise > 0.99);
  double sum = 0;
  for (const auto& s : report.components) sum += s.noise;
  CHECK(sum == Approx(1));
  CHECK(report.words[0].name.starts_with("ED"));
  REQUIRE(!report.cure.settings.empty());
  CHECK(report.cure.settings[0] == std::pair<std::string, std::string>("components.caustic", "photons"));
  // An own trial finds the same, and nothing has changed.
  const recording::NoiseReport again = renderer->paths().explain_noise({0, 0}, {1, 1});
  CHECK(again.sentence == report.sentence);
  CHECK(again.of_sample == report.of_sample);
  CHECK(test::identical(before, renderer->image()));
}

TEST_CASE("a rectangle has noise of its own; lights that are chosen by power are learned") {
  const auto renderer = renderer_of("cornell", {{"lights.sampling", "power"}}, 16);
  test::finish(*renderer);
  // The lamp itself, and the ceiling.
  const recording::NoiseReport part = renderer->paths().explain_noise({0.1f, 0.5f}, {0.3f, 0.9f});
  INFO(part.sentence);
  CHECK(part.pixels > 100);
  CHECK(part.of_sample > 0);
  CHECK(share(part.components, "caustic") < 0.5);
  CHECK(part.sentence.find("here") != std::string::npos);
  CHECK(!part.cure.reason.empty());
  const recording::NoiseReport pixel = renderer->paths().explain_noise({0.2f, 0.7f}, {0.2f, 0.7f});
  CHECK(pixel.pixels <= 1);
}

}  // namespace noise_tests
