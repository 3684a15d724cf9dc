// links: session
// Photons on a coarse mesh with the normals of a smooth shape: the density on a neighbouring facet is flux
// over that facet's area, so lookups divide by the cosine to that facet.
#include <catch2/catch.hpp>

#include "support/render.h"
#include "support/rooms.h"

namespace photons_shading_tests {

using namespace lucerna;

TEST_CASE("photons on a smooth-shaded coarse ball are as bright as path tracing") {
  test::PanelRoom room;
  scene::Scene& s = room.s;
  test::add_ball(s, {0.1f, 0.5f, 0}, 0.3f, 0, 8);
  s.cameras[0].to_world = mat4(1), s.cameras[0].to_world[3] = vec4(0.1f, 0.5f, 0.9f, 1);
  s.cameras[0].yfov = 0.6f;
  constexpr uint32_t k_size = 32;
  test::Settings settings{
      {"components.primary", "off"}, {"components.tertiary", "off"}, {"photons.efficiency", "false"}};
  const test::Result paths = test::render(s, settings, 1024, k_size, false);
  for (const char* radius : {"1.5", "4"}) {
    settings["components.secondary"] = "photons";
    settings["photons.radius"] = settings["photons.floor"] = radius;
    settings["photons.per_round"] = "250000";
    const test::Result r = test::render(s, settings, 16, k_size);
    double truth = 0, seen = 0, most = 0;
    for (uint32_t y = 0; y < k_size; ++y)
      for (uint32_t x = 0; x < k_size; ++x) {
        const double across = x + 0.5 - k_size / 2.0, down = y + 0.5 - k_size / 2.0;
        if (across * across + down * down > 14 * 14) continue;  // without the outline
        const size_t i = size_t{y} * k_size + x;
        const double a = luminance(paths.image.components[1][i]), b = luminance(r.image.components[1][i]);
        truth += a, seen += b, most = std::max(most, b / a);
      }
    INFO(radius << " pixels: " << seen / truth << " of the light, a pixel at most " << most);
    CHECK(seen == Approx(truth).epsilon(0.015));
    CHECK(most < 1.8);
  }
}

}  // namespace photons_shading_tests
