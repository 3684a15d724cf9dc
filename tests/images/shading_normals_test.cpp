// links: session
// Light scattered by tilted shading normals is the same by paths from the camera and from the lights.
#include <catch2/catch.hpp>

#include "support/caustics.h"
#include "support/rooms.h"

namespace shading_normals_tests {

using namespace lucerna;

namespace {

/// A wall of rough metal, whose normals are tilted by up to `degrees`, lights the floor in front of it.
scene::Scene metal_wall(float degrees) {
  scene::Scene s = test::mapped_room(degrees);
  s.materials[2].metallic = 1, s.materials[2].roughness = 0.4f,
  s.materials[2].base_color = vec4(0.9f, 0.9f, 0.9f, 1);
  s.cameras = {test::looking_down(vec3(0, 0.98f, -0.5f), 1.4f)};
  return s;
}

double light_of(const scene::Scene& s, const test::Settings& settings, int component, uint32_t samples) {
  return double(
      luminance(test::mean_of(test::render(s, settings, samples, 32, false).image, component).value));
}

}  // namespace

TEST_CASE("caustics of rough metal with tilted normals, from the lights and from the camera") {
  for (const float degrees : {22.0f, 50.0f}) {
    const scene::Scene s = metal_wall(degrees);
    test::Settings settings{
        {"components.primary", "off"}, {"components.secondary", "off"}, {"components.tertiary", "off"}};
    const double paths = light_of(s, settings, 3, 2048);
    settings["components.caustic"] = "light", settings["light.per_round"] = "200000";
    const double light = light_of(s, settings, 3, 32);
    // Discs so small that blur removes less than a hundredth of the light at the foot of the wall.
    settings["components.caustic"] = "photons", settings["photons.efficiency"] = "false";
    settings["photons.per_round"] = "200000", settings["photons.radius"] = "0.3";
    const double photons = light_of(s, settings, 3, 32);
    INFO(degrees << " degrees: light tracing " << light / paths << ", photons " << photons / paths);
    CHECK(light == Approx(paths).epsilon(0.03));  // its noise alone is a hundredth
    CHECK(photons == Approx(paths).epsilon(0.02));
  }
}

}  // namespace shading_normals_tests
