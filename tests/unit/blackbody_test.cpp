// links: base
// The colour of black bodies compared with published chromaticities, and the inverse.
#include <catch2/catch.hpp>

#include "base/blackbody.h"

namespace blackbody_tests {

using namespace lucerna;

namespace {

/// CIE 1931 x, y of a linear Rec.709 colour.
vec2 chromaticity(const vec3& c) {
  const float x = 0.4124564f * c.x + 0.3575761f * c.y + 0.1804375f * c.z;
  const float y = 0.2126729f * c.x + 0.7151522f * c.y + 0.0721750f * c.z;
  const float z = 0.0193339f * c.x + 0.1191920f * c.y + 0.9503041f * c.z;
  return vec2(x, y) / (x + y + z);
}

}  // namespace

TEST_CASE("black bodies have the chromaticities of the tables") {
  // Wyszecki and Stiles, 'Color Science', table 1(3.11); CIE illuminant A is that of 2856 K.
  const std::pair<float, vec2> known[] = {{2000, {0.5267f, 0.4133f}},
                                          {2856, {0.4476f, 0.4074f}},
                                          {4000, {0.3805f, 0.3768f}},
                                          {6500, {0.3135f, 0.3237f}},
                                          {10000, {0.2807f, 0.2884f}}};
  for (const auto& [kelvin, xy] : known) {
    INFO(kelvin);
    CHECK(glm::length(chromaticity(blackbody_color(kelvin)) - xy) < 0.004f);
  }
  CHECK(blackbody_color(1000).x == 1);
  CHECK(blackbody_color(1000).z == 0);
  CHECK(blackbody_color(40000).z == 1);
  CHECK(blackbody_color(0) == blackbody_color(1000));
}

TEST_CASE("the temperature of a colour is recovered, with its distance from a black body") {
  for (const float kelvin : {1200.0f, 1900.0f, 2700.0f, 5000.0f, 6500.0f, 15000.0f, 39000.0f}) {
    const NearestKelvin found = nearest_kelvin(7.0f * blackbody_color(kelvin));
    INFO(kelvin);
    if (kelvin > 1900) CHECK(found.kelvin == Approx(kelvin).epsilon(2e-3));  // blue is zero below
    CHECK(found.off < (kelvin > 1900 ? 1e-3f : 0.3f));
  }
  CHECK(nearest_kelvin(vec3(0, 1, 0)).off > 0.3f);
  CHECK(nearest_kelvin(vec3(0)).kelvin == Approx(6500).margin(700));
}

}  // namespace blackbody_tests
