// links: session
// path.max_depth has the same meaning for all solvers: the maximum number of scattering events between camera
// and light.
#include <catch2/catch.hpp>

#include "support/render.h"
#include "support/rooms.h"

namespace max_depth_tests {

using namespace lucerna;

namespace {

/// A room that is also seen in a mirror, so lookups occur at different depths, and a mirror that focuses
/// light.
scene::Scene mirror_room() {
  test::PanelRoom room;
  room.s.materials.push_back({});
  scene::Material& mirror = room.s.materials.back();
  mirror.metallic = 1, mirror.roughness = 0, mirror.base_color = vec4(0.9f, 0.9f, 0.9f, 1);
  room.quad({-0.9f, 0.02f, 0.8f}, {0.9f, 0, 0}, {0, 0.3f, -0.9f}, 2);
  return room.s;
}

}  // namespace

TEST_CASE("all solvers count the same scattering events for path.max_depth") {
  const scene::Scene s = mirror_room();
  for (const char* depth : {"2", "3"}) {
    test::Settings settings{{"path.max_depth", depth},
                            {"photons.efficiency", "false"},
                            {"photons.radius", "2"},
                            {"photons.floor", "2"}};
    const auto render = [&](const test::Settings& more, uint32_t samples) {
      test::Settings all = settings;
      for (const auto& [key, value] : more) all[key] = value;
      return test::render(s, all, samples, 24, false).image;
    };
    const film::Image paths = render({}, 256);
    const std::vector<test::Settings> ways = {
        {{"components.secondary", "photons"},
         {"components.tertiary", "photons"},
         {"components.caustic", "photons"}},
        {{"components.tertiary", "photons"}},
        {{"components.secondary", "cache"}, {"components.tertiary", "cache"}},
        {{"components.secondary", "cache"}, {"components.tertiary", "photons"}}};
    for (size_t w = 0; w < ways.size(); ++w) {
      const film::Image image = render(ways[w], 16);
      for (size_t c = 0; c < 4; ++c) {
        const double truth = test::mean(paths.components[c]), seen = test::mean(image.components[c]);
        INFO("max_depth " << depth << ", way " << w << ", component " << c << ": " << seen << ", paths "
                          << truth);
        // Path traced in both pictures.
        if (ways[w].count("components.caustic") == 0 && c == 3) continue;
        if (truth == 0)
          CHECK(seen == 0);
        else
          CHECK(seen == Approx(truth).epsilon(0.06));
      }
    }
  }
}

}  // namespace max_depth_tests
