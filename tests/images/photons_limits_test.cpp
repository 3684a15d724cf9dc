// links: session
// Photons that exceed the device's largest buffer: fewer light paths, the same light, and a message. Light
// tracing whose sums exceed it.
#include "support/caustics.h"
#include "support/device_name.h"

namespace photons_limits_tests {

using namespace lucerna;
using test::mean_of, test::MeanOf;

namespace {

constexpr uint64_t k_limit = 9 << 20;  // bytes of a buffer: more than the kernels themselves need

struct Rendered {
  film::Image image;
  uint64_t paths = 0, photons = 0;
  nlohmann::ordered_json statistics;
};

Rendered render(const test::Settings& settings, uint64_t most_storage_buffer) {
  session::RendererOptions options = test::renderer_options(false);
  if (most_storage_buffer > 0)
    options.on = std::make_shared<gpu::Device>(
        gpu::DeviceOptions{.selector = test::device_name(), .most_storage_buffer = most_storage_buffer});
  session::Renderer r(options);
  r.settings().set("path.batch", "16384");
  scene::Scene room = test::block_room();
  room.materials[0].base_color = vec4(vec3(0.85f), 1);
  r.set_size(24, 24);
  r.set_scene(std::make_shared<scene::Scene>(room));
  test::Settings all = settings;
  all.insert({{"samples", "4"}, {"cache.max_records", "2000"}, {"photons.efficiency", "false"}});
  test::set(r, all);
  Rendered made;
  made.image = test::finish(r);
  r.overlays().visit_solvers(
      [&](solvers::Solver& solver, const overlay::Canvas& canvas, const solvers::Picture& picture) {
        if (std::string(solver.info().name) == "photons")
          made.statistics = solvers::offered<solvers::Statistics>(solver)->statistics(canvas, picture);
      });
  return made;
}

}  // namespace

TEST_CASE("photons that do not fit into a buffer are reduced, and their light is the same") {
  for (const test::Settings& settings : {test::Settings{{"components.tertiary", "photons"}},
                                         test::Settings{{"components.tertiary", "photons"},
                                                        {"photons.irradiance_map", "off"},
                                                        {"photons.per_round", "300000"}},
                                         test::Settings{{"components.secondary", "photons"},
                                                        {"components.tertiary", "photons"},
                                                        {"photons.per_round", "300000"}}}) {
    const Rendered free = render(settings, 0), held = render(settings, k_limit);
    CHECK(held.statistics.at("last_round_photons") <= k_limit / 32);
    CHECK(free.statistics.at("last_round_photons") > k_limit / 32);
    for (const int component : {1, 2}) {
      const MeanOf a = mean_of(free.image, component), b = mean_of(held.image, component);
      INFO(component);
      CHECK(a.value.x > 0);
      CHECK(std::abs(a.value.x - b.value.x) < 4 * (a.noise.x + b.noise.x) + 0.01 * a.value.x);
    }
  }
}

TEST_CASE("light tracing of more pixels than a buffer holds gives the same picture") {
  // A pixel takes 12 bytes of sums per colour, and 16 of the pass's picture.
  constexpr uint32_t k_width = 900, k_height = 700;
  static_assert(16 * k_width * k_height > k_limit);
  film::Image images[2];
  for (const bool held : {false, true}) {
    session::RendererOptions options = test::renderer_options(false);
    options.on = std::make_shared<gpu::Device>(
        gpu::DeviceOptions{.selector = test::device_name(), .most_storage_buffer = held ? k_limit : 0});
    session::Renderer r(options);
    r.settings().set("path.batch", "16384");
    r.set_size(k_width, k_height);
    r.set_scene(std::make_shared<scene::Scene>(test::turned_sun()));
    test::set(r, {{"components.caustic", "light"},
                  {"components.primary", "off"},
                  {"components.secondary", "off"},
                  {"components.tertiary", "off"},
                  {"light.per_round", "20000"},
                  {"samples", "1"}});
    images[held] = test::finish(r);
  }
  // Rows of both bands have light.
  CHECK(mean_of(images[0], 3, 0, 0, k_width, 600).value.x > 0);
  CHECK(mean_of(images[0], 3, 0, 660, k_width, k_height).value.x > 0);
  CHECK(test::identical(images[0], images[1]));
}

}  // namespace photons_limits_tests
