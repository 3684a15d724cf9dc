// links: transport
// Lights drawn from learned rows: the density of a light sample equals the density used to weight a scattered
// ray that hits the same light.
#include <array>
#include <cmath>

#include "kernels/light_support.h"
#include "transport/light_learning.h"

namespace learned_lights_tests {

using namespace lucerna;
using namespace lucerna::test;

TEST_CASE("densities of light samples and of rays that hit the same light agree in every row") {
  for (const auto& [constant, portals] :
       {std::pair(false, false), {true, false}, {false, true}, {true, true}}) {
    scene::Scene scene = constant ? scene::Scene{} : sky(64, 32, 40);
    if (constant) scene.environment.radiance = vec3(2), scene.environment.given = true;
    if (portals) {
      scene.portals.push_back({"over each other", {0, 3, 0}, {1, 0, 0}, {0, 0, 1}});
      scene.portals.push_back({"over each other", {0.5f, 3.5f, 0}, {1, 0, 0}, {0, 0, 1}});
      scene.portals.push_back({"turned away", {0, 2, 0}, {0, 0, 1}, {1, 0, 0}});
    }
    add_triangle(scene, {0, 4, 0}, {3, 4, 0}, {0.5f, 4, 1}, {10, 20, 30});
    for (int i = 0; i < 200; ++i)
      add_triangle(scene, {5, 0.1f * float(i), 1}, {5, 0.1f * float(i), 1.2f}, {5, 0.1f * float(i) + 0.1f, 1},
                   vec3(3));
    const upload::FlatScene flat = upload::flatten(scene);
    transport::LightLearning learning(device(), upload::make_light_clusters(flat), 64);
    // Different rows, from synthetic records.
    std::mt19937 random(4);
    std::vector<shared::LightRecord> records(6000);
    for (shared::LightRecord& r : records) {
      r.position = vec3(float(random() % 100), float(random() % 100), float(random() % 100));
      r.cell = random() % learning.clusters().count();
      r.value = float(random() % 50), r.full = 1, r.arrived = float(random() % 2);
    }
    learning.learn(records);
    REQUIRE(learning.rows() > 10);
    const upload::DeviceScene on_device(device(), flat, {});
    shared::Frame frame{};
    frame.light_count = uint32_t(flat.lights.size() / shared::k_light_texels);
    frame.environment_radiance = flat.environment_radiance;
    frame.environment_width = flat.environment_width, frame.environment_height = flat.environment_height;
    frame.environment_rotation = flat.environment_rotation;
    frame.environment_light_pmf = flat.environment_light_pmf;
    learning.describe(frame);
    gpu::Buffer frame_buffer(device(), {"frame", sizeof frame});
    frame_buffer.write(&frame, sizeof frame);
    gpu::Defines defines = on_device.defines();
    for (const auto& [name, value] : upload::learned_defines(flat)) defines[name] = value;
    static gpu::ShaderCompiler compiler;
    const gpu::Kernel kernel(device(), compiler,
                             std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/learned_probe.comp",
                             defines);
    struct Pair {
      float drawn, met;
      uint32_t cluster, kind;
    };
    constexpr uint32_t k_draws = 1 << 17;
    const gpu::Buffer pairs(device(), {"pairs", k_draws * sizeof(Pair)});
    gpu::Resources resources;
    on_device.bind(resources);
    learning.bind(resources);
    resources.set("FrameBlock", frame_buffer);
    resources.set("Pairs", pairs);
    struct Push {
      uint32_t count, rows;
    };
    gpu::Stream stream(device());
    stream.dispatch(kernel, resources, Push{k_draws, learning.rows()}, gpu::groups_for(k_draws, 64));
    stream.run();
    std::array<size_t, 3> drawn{}, apart{};
    for (const Pair& p : pairs.read_all<Pair>()) {
      // From behind a portal nothing is seen through it.
      if (portals && p.cluster + 1 == learning.clusters().sky) {
        CHECK(p.drawn == 0);
        continue;
      }
      ++drawn[p.kind];
      apart[p.kind] += !(p.drawn > 0) || std::abs(p.met / p.drawn - 1) > 1e-4;
    }
    INFO("sky " << apart[0] << " of " << drawn[0] << ", triangles " << apart[1] << " of " << drawn[1]);
    CHECK(drawn[0] > 1000);
    CHECK(drawn[1] > 1000);
    // At borders of texels and squares rounding can give the neighbour.
    CHECK(apart[0] <= drawn[0] / 2000);
    CHECK(apart[1] <= drawn[1] / 2000);
  }
}

}  // namespace learned_lights_tests
