// links: session
// Pictures with the irradiance cache against path-traced ones: each component for itself.
#include <catch2/catch.hpp>
#include <cstring>

#include "support/render.h"

using namespace lucerna;

namespace {

using Settings = std::map<std::string, std::string>;

const Settings k_both{{"components.secondary", "cache"}, {"components.tertiary", "cache"}};

bool identical(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(vec3)) == 0;
}

double mean(const std::vector<vec3>& layer) {
  double sum = 0;
  for (const vec3& v : layer) sum += luminance(v);
  return sum / double(layer.size());
}

/// Root mean square of the differences of 8x8 blocks' means, over the mean.
double block_error(const test::Result& a, const test::Result& b, int component, uint32_t width) {
  const auto& x = a.image.components[component];
  const auto& y = b.image.components[component];
  const uint32_t across = width / 8, down = static_cast<uint32_t>(x.size()) / width / 8;
  double squares = 0;
  for (uint32_t v = 0; v < down; ++v)
    for (uint32_t u = 0; u < across; ++u) {
      double difference = 0;
      for (uint32_t i = 0; i < 64; ++i) {
        const size_t at = size_t{v * 8 + i / 8} * width + u * 8 + i % 8;
        difference += (luminance(x[at]) - luminance(y[at])) / 64;
      }
      squares += difference * difference;
    }
  return std::sqrt(squares / (across * down)) / mean(y);
}

}  // namespace

TEST_CASE("the cache brings the light of its components, and no other changes") {
  test::Render r{.scene = "cornell", .width = 64, .height = 64, .samples = 512, .settings = {{"seed", "3"}}};
  const test::Result path = test::render(r);
  r.samples = 16;
  const test::Result few = test::render(r);
  r.settings.insert(k_both.begin(), k_both.end());
  const test::Result cached = test::render(r);
  CHECK(cached.validation_messages == 0);
  CHECK(cached.stats.dropped == 0);
  CHECK(identical(few.image.components[0], cached.image.components[0]));
  CHECK(identical(few.image.components[3], cached.image.components[3]));
  for (const int c : {1, 2}) {
    INFO("component " << c << ": " << mean(cached.image.components[c]) << " of "
                      << mean(path.image.components[c]) << ", blocks " << block_error(cached, path, c, 64)
                      << ", path traced with as many samples " << block_error(few, path, c, 64));
    CHECK(mean(cached.image.components[c]) == Approx(mean(path.image.components[c])).epsilon(0.03));
    CHECK(block_error(cached, path, c, 64) < 0.08);
  }
}

TEST_CASE(
    "tertiary light alone is looked up at the second diffuse vertex, behind path-traced secondary light") {
  test::Render r{.scene = "glass", .width = 32, .height = 32, .samples = 128, .settings = {}};
  const test::Result path = test::render(r);
  r.settings["components.tertiary"] = "cache";
  // One level of rays: more for those that are still noisy would leave out some of the caustics that few rays find.
  r.settings["cache.rays"] = "4096";
  const test::Result cached = test::render(r);
  for (const int c : {0, 1, 3}) {
    INFO("component " << c);
    CHECK(identical(path.image.components[c], cached.image.components[c]));
  }
  INFO(mean(cached.image.components[2]) << " of " << mean(path.image.components[2]));
  CHECK(mean(cached.image.components[2]) == Approx(mean(path.image.components[2])).epsilon(0.05));
}

TEST_CASE("switched-off light stays off, and a scene without diffuse light costs nothing") {
  test::Render r{.scene = "cornell", .width = 32, .height = 32, .samples = 4, .settings = k_both};
  r.settings["components.tertiary"] = "off";
  const test::Result no_tertiary = test::render(r);
  CHECK(mean(no_tertiary.image.components[1]) > 0);
  CHECK(mean(no_tertiary.image.components[2]) == 0);
  r.settings["components.tertiary"] = "cache";
  r.settings["components.primary"] = "off";
  const test::Result no_primary = test::render(r);
  CHECK(mean(no_primary.image.components[0]) == 0);
  CHECK(mean(no_primary.image.components[2]) > 0);
}

TEST_CASE("a cached picture does not depend on how its work was cut") {
  test::Render r{.scene = "cornell", .width = 40, .height = 40, .samples = 4, .settings = k_both};
  const test::Result whole = test::render(r);
  r.settings["path.batch"] = "2048";
  const test::Result cut = test::render(r);
  for (int c = 0; c < 4; ++c) CHECK(identical(whole.image.components[c], cut.image.components[c]));
  r.settings["seed"] = "9";
  const test::Result other = test::render(r);
  CHECK_FALSE(identical(whole.image.components[1], other.image.components[1]));
}
