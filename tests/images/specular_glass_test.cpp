// links: session
// KHR_materials_specular on transmitting surfaces: panes and solids show the scene behind them with the
// brightness that their faces transmit.
#include <catch2/catch.hpp>

#include "support/render.h"
#include "support/rooms.h"

namespace specular_glass_tests {

using namespace lucerna;

TEST_CASE("panes and solids reflect by their specular factor, and transmit the rest") {
  for (const bool solid : {false, true})
    for (const float factor : {0.0f, 0.5f, 1.0f})
      for (const float roughness : {0.0f, 0.2f}) {
        scene::Scene s;
        s.name = "pane", s.file = "pane.gltf";
        s.materials = {test::diffuse(vec3(0), vec3(1)), {}};
        scene::Material& glass = s.materials[1];
        glass.metallic = 0, glass.roughness = roughness, glass.transmission = 1, glass.specular = factor;
        glass.double_sided = true;
        glass.thickness = solid ? 1 : 0;
        test::add_quad(s, {-90, -90, -2}, {180, 0, 0}, {0, 180, 0}, 0);
        test::add_quad(s, {-90, -90, 0}, {180, 0, 0}, {0, 180, 0}, 1);
        if (solid) test::add_quad(s, {-90, -90, -1}, {0, 180, 0}, {180, 0, 0}, 1);
        scene::Camera c;
        c.orthographic = true, c.xmag = c.ymag = 0.2f;
        c.to_world[3] = vec4(0, 0, 6, 1);
        s.cameras = {c};
        s.environment.given = true;
        const test::Result r = test::render(s, {{"path.roulette_depth", "64"}}, 64, 16, false);
        double seen = 0;
        for (size_t i = 0; i < r.image.samples.size(); ++i)
          seen += double(luminance(test::sum_at(r.image, i))) / 256;
        // The light source reflects nothing back: for two faces of reflectance R the transmittance is (1 - R)
        // / (1 + R).
        const double face = 0.04 * double(factor);
        INFO((solid ? "solid" : "thin") << ", factor " << factor << ", roughness " << roughness);
        CHECK(seen == Approx((1 - face) / (1 + face)).margin(roughness > 0 ? 0.01 : 0.004));
      }
}

}  // namespace specular_glass_tests
