// links: session
// Light paths aimed at surfaces that mirror and refract, and at openings through which distant light enters:
// they find light that unaimed paths almost never hit, and do not change the mean.
#include <catch2/catch.hpp>

#include "support/render.h"
#include "support/rooms.h"

namespace photons_aim_tests {

using namespace lucerna;

namespace {

const test::Settings k_aimed{{"components.caustic", "photons"},
                             {"photons.efficiency", "false"},
                             {"components.secondary", "off"},
                             {"components.tertiary", "off"},
                             {"photons.per_round", "20000"}};

test::Settings unaimed(test::Settings settings) {
  settings["photons.aim"] = "false";
  return settings;
}

struct Rendered {
  film::Image image;
  double casters = 0, entrances = 0, unaimed = 1, photons = 0;
};
Rendered render(const scene::Scene& scene, const test::Settings& settings, uint32_t samples, uint32_t size) {
  session::Renderer r(test::renderer_options(samples <= test::k_validated_samples));
  r.set_size(size, size);
  r.set_scene(std::make_shared<scene::Scene>(scene));
  test::Settings all = settings;
  all["samples"] = std::to_string(samples);
  test::set(r, all);
  Rendered out;
  out.image = test::finish(r);
  CHECK(r.device().validation_messages() == 0);
  CHECK(r.stats().dropped == 0);
  for (const auto& report : r.solvers().reports())
    if (report->solver == "photons")
      out.casters = report->figure("casters"), out.entrances = report->figure("entrances"),
      out.unaimed = report->figure("unaimed"), out.photons = report->figure("photons");
  return out;
}

/// Mean of the caustics' luminance, with its standard error from the two halves of the passes: each half is a
/// mean of many independent passes.
test::Mean mean_of(const film::Image& image) {
  test::Mean m;
  double odd = 0;
  const auto n = double(image.samples.size());
  for (size_t i = 0; i < image.samples.size(); ++i) {
    m.value += double(luminance(image.components[3][i])) / n;
    odd += double(luminance(image.odd_half[3][i])) / n;
  }
  m.noise = std::abs(m.value - odd);
  return m;
}

/// A sun along +x that a square mirror reflects straight down onto a floor, a kilometre wide, that has no
/// other light; `lamps` more lamps send no light there but have most of the power.
scene::Scene far_and_small(float mirror, uint32_t lamps) {
  scene::Scene s;
  s.name = "far and small";
  s.materials = {test::diffuse(vec3(0.5f)), {}};
  s.materials[1].metallic = 1, s.materials[1].roughness = 0, s.materials[1].base_color = vec4(1);
  s.materials[1].double_sided = true;
  test::add_quad(s, {-500, 0, 500}, {1000, 0, 0}, {0, 0, -1000}, 0);
  test::add_quad(s, {-mirror / 2, 0.01f + mirror, -mirror / 2}, {mirror, -mirror, 0}, {0, 0, mirror}, 1);
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = vec3(3)}};
  s.lights[0].direction = {1, 0, 0};
  for (uint32_t i = 0; i < lamps; ++i)
    s.lights.push_back(
        {.name = "lamp", .intensity = vec3(100), .position = {-400.0f + 16 * float(i), 3, 200}});
  s.cameras = {test::looking_down({mirror, 5 * mirror, 0}, 0.8f)};
  s.cameras[0].to_world[3] = vec4(0, 4 * mirror, 3 * mirror, 1);
  const vec3 back = glm::normalize(vec3(0, 4, 3)), right(1, 0, 0), up = glm::cross(back, right);
  s.cameras[0].to_world[0] = vec4(right, 0), s.cameras[0].to_world[1] = vec4(up, 0),
  s.cameras[0].to_world[2] = vec4(back, 0);
  s.environment.given = true;
  return s;
}

/// Glass balls in a room, in front of a lamp outside that lights them.
scene::Scene ball_room() {
  scene::Scene s;
  s.name = "ball room";
  s.materials = {test::diffuse({0.7f, 0.6f, 0.5f}), test::diffuse(vec3(0), vec3(40)), {}, {}};
  s.materials[2].metallic = 0, s.materials[2].roughness = 0, s.materials[2].transmission = 1;
  s.materials[2].thickness = 1;
  s.materials[3].metallic = 1, s.materials[3].roughness = 0.2f;
  test::add_box(s, {-2, 0, -2}, {2, 2.5f, 2});
  test::add_quad(s, {-0.3f, 2.45f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, 1);
  test::add_ball(s, {0.6f, 0.4f, 0}, 0.35f, 2);
  test::add_ball(s, {-0.8f, 0.3f, 0.2f}, 0.25f, 3);
  s.lights = {{.name = "lamp", .intensity = vec3(3), .position = {-1.5f, 1.5f, 1}}};
  scene::Camera front;
  front.yfov = 1.1f, front.to_world[3] = vec4(0, 1.2f, 1.95f, 1);
  s.cameras = {front};
  s.environment.given = true;
  return s;
}

/// A room of 4 m under a sun and an environment, in a plain of 80 m; light enters only through a slot in its
/// ceiling.
scene::Scene slotted_room() {
  scene::Scene s;
  s.name = "slotted room";
  s.materials = {test::diffuse({0.7f, 0.65f, 0.6f}), test::diffuse(vec3(0.3f))};
  test::add_box(s, {-2, 0, -2}, {2, 2.5f, 2}, 0, true);
  test::add_quad(s, {-2, 2.5f, -2}, {1.6f, 0, 0}, {0, 0, 4}, 0);
  test::add_quad(s, {0, 2.5f, -2}, {2, 0, 0}, {0, 0, 4}, 0);
  test::add_quad(s, {-40, -0.01f, 40}, {80, 0, 0}, {0, 0, -80}, 1);
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = vec3(3)}};
  s.lights[0].direction = glm::normalize(vec3(0.2f, -1, 0.1f));
  scene::Camera front;
  front.yfov = 1.1f, front.to_world[3] = vec4(0, 1.2f, 1.95f, 1);
  s.cameras = {front};
  s.environment.given = true;
  s.environment.radiance = {0.1f, 0.15f, 0.25f};
  return s;
}

/// Mean square difference of a component's halves.
double noise_of(const film::Image& image, size_t component) {
  double sum = 0;
  for (size_t i = 0; i < image.samples.size(); ++i) {
    const auto d = double(luminance(image.components[component][i] - image.odd_half[component][i]));
    sum += d * d / double(image.samples.size());
  }
  return sum;
}

}  // namespace

TEST_CASE("light that enters through a slot is aimed at where it falls, and keeps its brightness") {
  const test::Settings photons{{"components.caustic", "off"},
                               {"components.secondary", "photons"},
                               {"components.tertiary", "photons"},
                               {"photons.efficiency", "false"},
                               {"photons.per_round", "20000"}};
  const scene::Scene room = slotted_room();
  const Rendered aimed = render(room, photons, 32, 40), plain = render(room, unaimed(photons), 32, 40);
  CHECK(aimed.entrances >= 1);
  CHECK(aimed.unaimed < 0.61);  // the minimum
  CHECK(plain.entrances == 0);
  CHECK(aimed.photons > 5 * plain.photons);
  // Small radii, because the blur of large ones moves light out of the slot's spot.
  test::Settings narrow = photons;
  narrow["photons.radius"] = narrow["photons.floor"] = "0.4";
  narrow["photons.per_round"] = "100000";
  const film::Image right = render(room, narrow, 64, 40).image,
                    path =
                        render(room, {{"components.caustic", "off"}, {"lights.sampling", "power"}}, 1024, 40)
                            .image;
  for (const size_t c : {1u, 2u}) {
    const double a = noise_of(aimed.image, c), b = noise_of(plain.image, c);
    INFO(c << ": " << a << ", without aim " << b);
    CHECK(a < 0.1 * b);
    const double mean = test::mean(path.components[c]);
    const double noise = std::hypot(mean - test::mean(path.odd_half[c]),
                                    test::mean(right.components[c]) - test::mean(right.odd_half[c]));
    INFO(test::mean(right.components[c]) << ", path traced " << mean << " +- " << noise);
    CHECK(noise < 0.04 * mean);
    CHECK(std::abs(test::mean(right.components[c]) - mean) < 0.005 * mean + 3 * noise);
  }
  // In a room that all light reaches no entrances are found.
  scene::Scene open = test::block_room();
  CHECK(render(open, photons, 1, 16).entrances == 0);
}

TEST_CASE("a wall far away adds no aim targets") {
  const test::Settings photons{{"components.caustic", "off"},
                               {"components.secondary", "photons"},
                               {"components.tertiary", "photons"},
                               {"photons.efficiency", "false"},
                               {"photons.per_round", "20000"}};
  scene::Scene room = slotted_room();
  const uint32_t alone = render(room, photons, 1, 24).entrances;
  CHECK(alone >= 1);
  test::add_quad(room, {1e5f, 0, 0}, {0, 10, 0}, {0, 0, 10}, 0);
  const uint32_t beside = render(room, photons, 1, 24).entrances;
  CHECK(beside == alone);
}

TEST_CASE("the ground beyond a window is aimed at, too, though the sun through it is found by chance") {
  scene::Scene s;
  s.name = "room on a wide ground";
  s.materials = {test::diffuse(vec3(0.1f)), test::diffuse(vec3(0.8f)), test::diffuse(vec3(0.8f))};
  for (auto& material : s.materials) material.double_sided = true;
  // A dark room with a bright ceiling, a window to the side of the sun.
  test::add_box(s, {-2.2f, 2.6f, -2.2f}, {2.2f, 2.8f, 2.2f}, 1);
  for (const auto& [lo, hi] :
       std::initializer_list<std::pair<vec3, vec3>>{{{-2.2f, -0.2f, -2.2f}, {2.2f, 0, 2.2f}},
                                                    {{-2.2f, 0, -2.2f}, {-2, 2.6f, 2.2f}},
                                                    {{-2.2f, 0, 2}, {2.2f, 2.6f, 2.2f}},
                                                    {{-2.2f, 0, -2.2f}, {2.2f, 2.6f, -2}},
                                                    {{2, 0, -2.2f}, {2.2f, 0.9f, 2.2f}},
                                                    {{2, 2.1f, -2.2f}, {2.2f, 2.6f, 2.2f}},
                                                    {{2, 0.9f, -2.2f}, {2.2f, 2.1f, -0.7f}},
                                                    {{2, 0.9f, 0.7f}, {2.2f, 2.1f, 2.2f}}})
    test::add_box(s, lo, hi);
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = vec3(10)}};
  s.lights[0].direction = normalize(vec3(-0.77f, -0.62f, 0.15f));
  // Looks up at the ceiling.
  scene::Camera up;
  up.yfov = 1.6f;
  up.to_world = mat4(vec4(1, 0, 0, 0), vec4(0, 0, 1, 0), vec4(0, -1, 0, 0), vec4(0, 0.5f, 0, 1));
  s.cameras = {up};
  s.environment.given = true;
  const test::Settings photons{{"components.secondary", "photons"},
                               {"components.tertiary", "photons"},
                               {"photons.efficiency", "false"},
                               {"photons.per_round", "65536"}};
  test::add_quad(s, {-300, -0.3f, 300}, {600, 0, 0}, {0, 0, -600}, 2);
  const Rendered path = render(s, {}, 1024, 16);
  const auto indirect = [](const Rendered& r) {
    return test::mean(r.image.components[1]) + test::mean(r.image.components[2]);
  };
  // The median, because rare large amounts of light hide that most pictures have too little.
  std::vector<double> found;
  test::Settings settings = photons;
  for (const char* seed : {"0", "1", "2"}) {
    settings["seed"] = seed;
    found.push_back(indirect(render(s, settings, 32, 16)));
  }
  std::sort(found.begin(), found.end());
  INFO(found[1] << " of " << indirect(path));
  CHECK(found[1] == Approx(indirect(path)).epsilon(0.15));
  CHECK(found[2] < 1.3 * found[0]);
}

TEST_CASE("behind records, too, entrances of light are found, with and without existing records") {
  const scene::Scene room = slotted_room();
  session::Renderer r(test::renderer_options());
  r.set_size(32, 32);
  r.set_scene(std::make_shared<scene::Scene>(room));
  test::set(r, {{"components.caustic", "off"},
                {"components.secondary", "cache"},
                {"components.tertiary", "photons"},
                {"samples", "8"}});
  const auto entrances = [&] {
    double n = -1;
    for (const auto& report : r.solvers().reports())
      if (report->solver == "photons") n = report->figure("entrances");
    return n;
  };
  const film::Image first = test::finish(r);
  CHECK(entrances() >= 1);
  scene::Light sun = room.lights[0];
  sun.intensity *= 2.0f;
  sun.direction = glm::normalize(vec3(0.1f, -1, 0.2f));
  r.set_light(0, sun);
  const film::Image after = test::finish(r);
  CHECK(entrances() >= 1);
  CHECK(test::mean(after.components[2]) > 1.3 * test::mean(first.components[2]));
}

TEST_CASE("aiming does not change the mean") {
  const scene::Scene room = ball_room();
  const Rendered aimed = render(room, k_aimed, 64, 40), plain = render(room, unaimed(k_aimed), 64, 40);
  CHECK(aimed.casters == 2);
  CHECK(aimed.unaimed < 0.7);
  CHECK(plain.casters == 0);
  CHECK(aimed.photons > 2 * plain.photons);
  const test::Mean a = mean_of(aimed.image), b = mean_of(plain.image);
  INFO(a.value << " +- " << a.noise << ", without aim " << b.value << " +- " << b.noise);
  CHECK(std::abs(a.value - b.value) < 0.01 * b.value + 3 * std::hypot(a.noise, b.noise));
  // With all other light.
  test::Settings all = k_aimed;
  all["components.secondary"] = all["components.tertiary"] = "photons";
  const film::Image with = render(room, all, 32, 40).image,
                    without = render(room, unaimed(all), 32, 40).image;
  for (const size_t c : {1u, 2u})
    CHECK(test::mean(with.components[c]) == Approx(test::mean(without.components[c])).epsilon(0.01));
}

TEST_CASE("a caster of five millimetres in a scene of a kilometre with a sun and fifty lamps is found") {
  const scene::Scene s = far_and_small(0.005f, 50);
  const Rendered aimed = render(s, k_aimed, 32, 32);
  CHECK(aimed.casters == 1);
  // In the mirror's beam on the floor the radiance is irradiance times albedo over pi.
  const double radiance = 3 * 0.5 / double(k_pi);
  double most = 0, sum = 0;
  for (uint32_t y = 0; y < 32; ++y)
    for (uint32_t x = 0; x < 32; ++x) {
      const auto l = double(luminance(aimed.image.components[3][y * 32 + x]));
      most = std::max(most, l), sum += l;
    }
  CHECK(sum > 0);
  CHECK(most == Approx(radiance).epsilon(0.15));
  const Rendered plain = render(s, unaimed(k_aimed), 4, 32);
  CHECK(plain.photons == 0);
}

TEST_CASE("of lamps with powers of one and a million the weak one's caustic is as bright as alone") {
  // The strong lamp's light is focused too, but outside the view.
  scene::Scene s = far_and_small(0.1f, 0);
  test::add_quad(s, {300, 1, 300}, {10, -10, 0}, {0, 0, 10}, 1);
  s.lights[0].kind = scene::LightKind::spot;
  s.lights[0].position = {-2, 0.06f, 0}, s.lights[0].intensity = vec3(1);
  s.lights[0].inner_cone = 0.1f, s.lights[0].outer_cone = 0.2f;
  const Rendered alone = render(s, k_aimed, 32, 32);
  s.lights.push_back({.name = "strong", .intensity = vec3(1e6f), .position = {295, 3, 305}});
  const Rendered both = render(s, k_aimed, 32, 32);
  CHECK(both.casters == 2);
  const test::Mean a = mean_of(alone.image), b = mean_of(both.image);
  INFO(b.value << " +- " << b.noise << ", alone " << a.value << " +- " << a.noise);
  CHECK(a.value > 5e-4);
  CHECK(b.value == Approx(a.value).epsilon(0.03));
  CHECK(both.photons > 1000);
}

TEST_CASE("where no smooth surface focuses light no path is aimed") {
  scene::Scene s = test::block_room();
  s.materials[0].specular = 1, s.materials[0].roughness = 0.4f;  // varnish
  const Rendered r = render(s, k_aimed, 4, 32);
  CHECK(r.casters == 0);
  CHECK(r.unaimed == 1);
  CHECK(r.photons > 0);
}

TEST_CASE("a weak lamp in a room has light paths beside a strong lamp elsewhere") {
  // Two closed rooms; the camera is in the one with the weak lamp.
  scene::Scene s;
  s.name = "two rooms";
  s.materials = {test::diffuse(vec3(0.6f))};
  test::add_box(s, {-1, -1, -1}, {1, 1, 1}, 0);
  test::add_box(s, {9, -1, -1}, {11, 1, 1}, 0);
  s.lights = {{.name = "weak", .intensity = vec3(1), .position = {0, 0.9f, 0}},
              {.name = "strong", .intensity = vec3(1e6f), .position = {10, 0.9f, 0}}};
  s.cameras = {test::looking_down({0, 0.8f, 0}, 1.4f)};
  s.environment.given = true;
  const test::Settings photons{{"components.caustic", "off"},
                               {"components.secondary", "photons"},
                               {"components.tertiary", "off"},
                               {"photons.efficiency", "false"},
                               {"photons.per_round", "16384"}};
  const film::Image aimed = render(s, photons, 32, 24).image,
                    by_power = render(s, unaimed(photons), 32, 24).image;
  // Light samples of paths are chosen by power too: the reference uses a scene without the strong lamp.
  s.lights.pop_back();
  const film::Image path =
      render(s, {{"components.caustic", "off"}, {"components.tertiary", "off"}}, 512, 24).image;
  double a = 0, b = 0, blind = 0, noise = 0;
  for (size_t i = 0; i < aimed.samples.size(); ++i) {
    a += double(luminance(aimed.components[1][i])), b += double(luminance(path.components[1][i]));
    blind += double(luminance(by_power.components[1][i]));
    noise += std::pow(double(luminance(aimed.components[1][i] - aimed.odd_half[1][i])), 2);
  }
  CAPTURE(a, b, blind, noise);
  CHECK(a == Approx(b).epsilon(0.02));
  CHECK(noise < 0.01 * a * a / double(aimed.samples.size()));
  // Without aiming one path in a million starts at the weak lamp.
  CHECK(blind < 0.5 * b);
}

TEST_CASE("the pilot depends on neither batches nor earlier renders") {
  const scene::Scene room = ball_room();
  const film::Image once = render(room, k_aimed, 4, 40).image;
  test::Settings small = k_aimed;
  small["path.batch"] = "1024";
  CHECK(test::identical(once, render(room, small, 4, 40).image));
  session::Renderer r(test::renderer_options());
  r.set_size(24, 24);
  r.set_scene(std::make_shared<scene::Scene>(room));
  test::Settings settings = k_aimed;
  settings["samples"] = "4";
  test::set(r, settings);
  test::finish(r);
  r.set_size(40, 40);
  CHECK(test::identical(once, test::finish(r)));
  // Aiming is off in between.
  test::set(r, {{"photons.aim", "false"}});
  CHECK_FALSE(test::identical(once, test::finish(r)));
  test::set(r, {{"photons.aim", "true"}});
  CHECK(test::identical(once, test::finish(r)));
}

}  // namespace photons_aim_tests
