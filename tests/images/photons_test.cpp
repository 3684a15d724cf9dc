// links: session
// Photons through the whole renderer: their light compared with closed forms and with path tracing, surfaces
// they must not reach, dependence on settings and seed only, and edge cases with little light.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "solvers/registry.h"
#include "support/caustics.h"

namespace photons_tests {

using namespace lucerna;

using test::mean_of, test::MeanOf, test::turned_sun, test::with;

namespace {

const test::Settings k_all{{"components.secondary", "photons"},
                           {"components.tertiary", "photons"},
                           {"components.caustic", "photons"},
                           {"photons.efficiency", "false"}};

/// The inside of an emissive box of a single albedo without gloss.
scene::Scene closed_room(const vec3& albedo) {
  scene::Scene s;
  s.name = "closed room";
  s.materials = {test::diffuse(albedo, vec3(1))};
  test::add_box(s, vec3(-1), vec3(1));
  s.cameras = {test::looking_down({0, 0.5f, 0}, 1)};
  return s;
}

/// A room of four metres with a lamp under its ceiling and a glass ball on its floor.
scene::Scene glass_room(float lamp = 0.5f) {
  scene::Scene s;
  s.name = "glass room", s.file = "glass.gltf";
  s.materials = {test::diffuse({0.7f, 0.6f, 0.5f}), test::diffuse(vec3(0), vec3(6 / (lamp * lamp))), {}};
  s.materials[2].metallic = 0, s.materials[2].roughness = 0, s.materials[2].transmission = 1;
  s.materials[2].thickness = 1;
  test::add_box(s, {-2, 0, -2}, {2, 2.5f, 2});
  test::add_quad(s, {-lamp, 2.45f, -lamp}, {2 * lamp, 0, 0}, {0, 0, 2 * lamp}, 1);
  test::add_ball(s, {0.3f, 0.6f, 0}, 0.55f, 2);
  // A mat whose shading normals deviate from its plane.
  test::add_quad(s, {-1.9f, 0.01f, 1.9f}, {3.8f, 0, 0}, {0, 0, -3.8f}, 0);
  s.meshes.back().primitives[0].normals.assign(4, glm::normalize(vec3(0.5f, 0.8f, -0.3f)));
  scene::Camera front;
  front.yfov = 1.1f, front.to_world[3] = vec4(0, 1.2f, 1.95f, 1);
  s.cameras = {front};
  s.environment.given = true;
  return s;
}

}  // namespace

TEST_CASE("a beam of even light on a plane has the expected irradiance") {
  const test::Result r = test::render(
      turned_sun(),
      {{"components.caustic", "photons"}, {"photons.efficiency", "false"}, {"photons.per_round", "200000"}},
      16, 32);
  const vec3 radiance = vec3(0.8f, 0.5f, 0.2f) * vec3(3, 4, 5) * vec3(0.9f, 0.8f, 0.7f) / k_pi;
  for (uint32_t block = 0; block < 16; ++block) {
    glm::dvec3 sum(0);
    for (uint32_t k = 0; k < 64; ++k)
      sum += glm::dvec3(r.image.components[3][size_t(block / 4 * 8 + k / 8) * 32 + block % 4 * 8 + k % 8]);
    for (int c = 0; c < 3; ++c) CHECK(sum[c] / 64 == Approx(radiance[c]).epsilon(0.05));
  }
  const MeanOf all = mean_of(r.image, 3);
  for (int c = 0; c < 3; ++c) CHECK(all.value[c] == Approx(radiance[c]).epsilon(0.01));
  // Camera paths never hit this light.
  const test::Result path = test::render(turned_sun(), {}, 16, 32);
  CHECK(test::mean(path.image.components[3]) == 0);
}

TEST_CASE("light refracted into water has the irradiance of the transmitted light") {
  // The sun is overhead, the camera under water: scaling flux like radiance would be off by 1.77.
  scene::Scene s;
  s.name = "pool";
  s.materials = {test::diffuse({0.8f, 0.5f, 0.2f}), {}};
  s.materials[1].metallic = 0, s.materials[1].roughness = 0, s.materials[1].transmission = 1;
  s.materials[1].thickness = 1, s.materials[1].ior = 1.33f;
  test::add_quad(s, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 0);
  test::add_quad(s, {-2, 1, 2}, {4, 0, 0}, {0, 0, -4}, 1);
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = {3, 4, 5}}};
  s.lights[0].direction = {0, -1, 0};
  s.cameras = {test::looking_down({0, 0.9f, 0}, 0.8f)};
  s.environment.given = true;
  const test::Settings settings{
      {"components.caustic", "photons"}, {"photons.efficiency", "false"}, {"photons.per_round", "100000"}};
  const double through = 1 - std::pow(0.33 / 2.33, 2);
  const MeanOf flat = mean_of(test::render(s, settings, 8, 32).image, 3);
  // Shading normals weight photons like paths.
  const vec3 leaning = glm::normalize(vec3(0.5f, 0.8f, -0.3f));
  s.meshes[0].primitives[0].normals.assign(4, leaning);
  const MeanOf leant = mean_of(test::render(s, settings, 8, 32).image, 3);
  for (int c = 0; c < 3; ++c) {
    const double radiance =
        double(s.materials[0].base_color[c] * s.lights[0].intensity[c]) * through / double(k_pi);
    CHECK(flat.value[c] == Approx(radiance).epsilon(0.015));
    CHECK(leant.value[c] == Approx(radiance * double(leaning.y)).epsilon(0.015));
  }
}

TEST_CASE("flux is conserved in a closed room of one albedo") {
  const vec3 albedo(0.5f, 0.25f, 0.75f);
  for (const std::string way : {"looked up", "gathered", "gathered from a map"}) {
    const bool final_gather = way != "looked up";
    test::Settings settings = k_all;
    if (final_gather) settings["components.secondary"] = "path";
    if (way == "gathered from a map")
      settings["photons.irradiance_map"] = "all", settings["components.caustic"] = "off";
    const test::Result r = test::render(closed_room(albedo), settings, 32, 32);
    const MeanOf secondary = mean_of(r.image, 1), tertiary = mean_of(r.image, 2);
    for (int c = 0; c < 3; ++c) {
      INFO("channel " << c << ", " << way);
      const double a = double(albedo[c]);
      CHECK(secondary.value[c] == Approx(a * a).epsilon(0.01));
      // Final gathering sees the dark borders of the map: a share of radius over room width.
      CHECK(tertiary.value[c] == Approx(a * a * a / (1 - a)).epsilon(final_gather ? 0.03 : 0.01));
    }
    for (const vec3& v : r.image.components[3]) CHECK(v == vec3(0));
  }
}

namespace {

/// The glass room by path tracing.
const test::Result& by_paths() {
  static const test::Result path = [] {
    const scene::Scene room = glass_room();
    return test::render({.width = 40, .height = 40, .samples = 256, .settings = {{"seed", "5"}}}, &room);
  }();
  return path;
}

/// Checks that a choice of solvers gives the picture of path tracing.
void check_choice(const test::Settings& choice) {
  const test::Result& path = by_paths();
  const scene::Scene room = glass_room();
  const test::Result r = test::render({.width = 40,
                                       .height = 40,
                                       .samples = 24,
                                       .settings = with(choice, {{"seed", "9"}, {"photons.radius", "1"}})},
                                      &room);
  CHECK(r.stats.dropped == 0);
  for (int c = 0; c < 4; ++c) {
    const std::string name = std::string("components.") + paths::k_component_names[size_t(c)];
    const bool own = choice.contains(name);
    const MeanOf truth = mean_of(path.image, c), here = mean_of(r.image, c);
    REQUIRE(truth.value.y > 1e-3);
    INFO(name << ": " << here.value.y << " +- " << here.noise.y << ", path " << truth.value.y << " +- "
              << truth.noise.y);
    // Blur moves light across edges, and loses some there: 3 % in this small picture.
    CHECK(std::abs(here.value.y - truth.value.y) <
          4.5 * std::hypot(here.noise.y, truth.noise.y) + (own ? 0.03 : 0.0) * truth.value.y);
    CHECK(r.bias_known[size_t(c)] == !own);
  }
}

}  // namespace

TEST_CASE("caustics of photons with path tracing give the picture of path tracing") {
  check_choice({{"components.caustic", "photons"}, {"photons.efficiency", "false"}});
}
TEST_CASE("photons for every component they can compute give the picture of path tracing") {
  check_choice(k_all);
}
TEST_CASE("final gathering from photons gives the picture of path tracing") {
  check_choice({{"components.tertiary", "photons"}, {"photons.efficiency", "false"}});
}
TEST_CASE("secondary light of photons with tertiary light of paths gives the picture of path tracing") {
  check_choice({{"components.secondary", "photons"}, {"photons.efficiency", "false"}});
}
TEST_CASE("caustics of photons with cached light give the picture of path tracing") {
  check_choice({{"components.secondary", "cache"},
                {"components.tertiary", "cache"},
                {"components.caustic", "photons"},
                {"photons.efficiency", "false"}});
}
TEST_CASE("photons at the first surface and records at the second give the picture of path tracing") {
  check_choice({{"components.secondary", "photons"},
                {"components.tertiary", "cache"},
                {"photons.efficiency", "false"}});
}

TEST_CASE("records whose rays end in photons give the picture of path tracing") {
  check_choice({{"components.secondary", "cache"}, {"components.tertiary", "photons"}});
  check_choice({{"components.secondary", "cache"},
                {"components.tertiary", "photons"},
                {"photons.irradiance_map", "off"}});
}
TEST_CASE("records whose rays end in photons, with caustics of photons, give the picture of path tracing") {
  check_choice({{"components.secondary", "cache"},
                {"components.tertiary", "photons"},
                {"components.caustic", "photons"},
                {"photons.efficiency", "false"}});
}

TEST_CASE("tertiary light from an irradiance map gives the picture of path tracing") {
  const test::Settings settings{
      {"components.tertiary", "photons"}, {"photons.irradiance_map", "all"}, {"photons.efficiency", "false"}};
  check_choice(settings);
  check_choice(with(settings, {{"components.secondary", "cache"}}));
  // With caustics, which are looked up in the pass's photons at the first surface.
  check_choice(with(settings, {{"components.caustic", "photons"}}));
}

TEST_CASE("an irradiance map is read where requested, is reproducible bit for bit, and follows the lamp") {
  scene::Scene room = glass_room();
  const test::Settings settings{
      {"components.tertiary", "photons"}, {"photons.irradiance_map", "all"}, {"photons.efficiency", "false"}};
  test::Render base{.width = 32, .height = 32, .samples = 4, .settings = settings, .validated = false};
  const test::Result a = test::render(base, &room);
  base.settings["path.batch"] = "1024";
  CHECK(test::identical(a.image, test::render(base, &room).image));
  base.settings["photons.irradiance_map"] = "off";
  CHECK_FALSE(test::identical(a.image.components[2], test::render(base, &room).image.components[2]));
  // Lookups at the first surface need no map in advance.
  base.settings["components.secondary"] = "photons";
  const test::Result looked_up = test::render(base, &room);
  base.settings["photons.irradiance_map"] = "all";
  CHECK(test::identical(looked_up.image, test::render(base, &room).image));

  session::Renderer r(test::renderer_options());
  r.set_size(32, 32);
  r.set_scene(std::make_shared<scene::Scene>(room));
  test::set(r, with(settings, {{"samples", "4"}, {"path.batch", "4096"}}));
  const film::Image first = test::finish(r);
  scene::Material lamp = room.materials[1];
  lamp.emission *= 2.0f;
  r.set_material(1, lamp);
  const film::Image bright = test::finish(r);
  CHECK(test::mean(bright.components[2]) == Approx(2 * test::mean(first.components[2])).epsilon(0.02));
}

TEST_CASE("records whose rays end in photons follow the lamp") {
  scene::Scene room = glass_room();
  const test::Settings settings{{"components.secondary", "cache"}, {"components.tertiary", "photons"}};
  session::Renderer r(test::renderer_options());
  r.set_size(24, 24);
  r.set_scene(std::make_shared<scene::Scene>(room));
  test::set(r, with(settings, {{"samples", "4"}}));
  const film::Image first = test::finish(r);
  const auto tertiary = [](const film::Image& image) { return test::mean(image.components[2]); };
  // A lamp of twice the power, as a separate scene and as an edit of this one.
  room.materials[1].emission *= 2.0f;
  r.set_scene(std::make_shared<scene::Scene>(room));
  const film::Image bright = test::finish(r);
  CHECK(tertiary(bright) == Approx(2 * tertiary(first)).epsilon(0.1));
  const test::Render from_scratch{
      .width = 24, .height = 24, .samples = 4, .settings = settings, .validated = false};
  const test::Result fresh = test::render(from_scratch, &room);
  CHECK(tertiary(bright) == Approx(tertiary(fresh.image)).epsilon(0.1));
  // A second run is identical bit for bit.
  CHECK(test::identical(fresh.image, test::render(from_scratch, &room).image));
}

TEST_CASE("solvers without photons give the same picture bit for bit") {
  const scene::Scene room = glass_room();
  const test::Result path = test::render({.samples = 8}, &room);
  const test::Result r = test::render(
      {.samples = 8, .settings = {{"components.caustic", "photons"}, {"photons.efficiency", "false"}}},
      &room);
  for (const size_t c : {0u, 1u, 2u}) CHECK(test::identical(path.image.components[c], r.image.components[c]));
  CHECK_FALSE(test::identical(path.image.components[3], r.image.components[3]));
}

TEST_CASE("photons behind a wall of a millimetre change nothing") {
  // Two rooms; the lamp is in the left one, the camera in the right one, which is larger, so only the
  // surfaces of the dividing wall are close to each other.
  scene::Scene s;
  s.name = "two rooms";
  s.materials = {test::diffuse(vec3(0.8f))};
  test::add_box(s, {-2, 0, -1}, {0, 2, 1});
  test::add_box(s, {0.001f, -1, -2}, {2, 3, 2});
  s.lights = {{.name = "lamp", .intensity = vec3(5), .position = {-0.3f, 1, 0}}};
  scene::Camera camera;
  camera.yfov = 1.2f;
  camera.to_world =
      mat4(vec4(0, 0, -1, 0), vec4(0, 1, 0, 0), vec4(1, 0, 0, 0), vec4(1.5f, 1, 0, 1));  // to -x
  s.cameras = {camera};
  s.environment.given = true;
  const test::Result r = test::render(s, k_all, 4, 32);
  for (const auto& component : r.image.components)
    for (const vec3& v : component) REQUIRE(v == vec3(0));
  // The lamp's side of the same wall is lit.
  s.cameras[0].to_world[3] = vec4(-0.5f, 1, 0, 1);
  const test::Result lit = test::render(s, k_all, 4, 32);
  CHECK(test::mean(lit.image.components[1]) > 0.01);
}

TEST_CASE("the picture does not depend on batches, a second run or adaptive sampling") {
  const scene::Scene room = glass_room();
  const test::Render base{
      .width = 40, .height = 36, .samples = 6, .settings = with(k_all, {{"photons.per_round", "5000"}})};
  const test::Result a = test::render(base, &room);
  test::Render again = base;
  again.validated = false;
  CHECK(test::identical(a.image, test::render(again, &room).image));
  test::Render small = again;
  small.settings["path.batch"] = "1024";
  CHECK(test::identical(a.image, test::render(small, &room).image));
  test::Render adaptive = again;
  adaptive.settings =
      with(base.settings,
           {{"sampling.mode", "adaptive"}, {"sampling.min_samples", "6"}, {"sampling.max_samples", "6"}});
  CHECK(test::identical(a.image, test::render(adaptive, &room).image));
  test::Render other = again;
  other.settings["seed"] = "7";
  CHECK_FALSE(test::identical(a.image, test::render(other, &room).image));
}

TEST_CASE("adaptive sampling of separate tiles reads the photons of each sample's own pass") {
  const scene::Scene room = glass_room();
  session::Renderer r(test::renderer_options(false));
  r.set_size(48, 48);
  r.set_scene(std::make_shared<scene::Scene>(room));
  const test::Settings settings = with(k_all, {{"sampling.mode", "adaptive"},
                                               {"sampling.min_samples", "4"},
                                               {"sampling.max_samples", "12"},
                                               {"sampling.target_error", "0.4"}});
  test::set(r, settings);
  test::finish(r);
  // Another target: finished tiles continue, beside others that have more samples.
  test::set(r, {{"sampling.target_error", "0.0001"}});
  const film::Image image = test::finish(r);
  const test::Result whole =
      test::render({.width = 48, .height = 48, .samples = 12, .settings = k_all}, &room);
  CHECK(test::identical(image, whole.image));
}

TEST_CASE("without surfaces that focus light no photons are traced for caustics, and nothing is spent") {
  const scene::Scene room = test::block_room();
  const test::Result path = test::render(room, {}, 8, 32);
  session::Renderer r(test::renderer_options());
  r.set_size(32, 32);
  r.set_scene(std::make_shared<scene::Scene>(room));
  test::set(r, {{"components.caustic", "photons"}, {"photons.efficiency", "false"}, {"samples", "8"}});
  const film::Image image = test::finish(r);
  for (const size_t c : {0u, 1u, 2u, 3u})
    CHECK(test::identical(path.image.components[c], image.components[c]));
  CHECK(r.solvers().figure("light paths") == 0);
  CHECK(r.stats().rays <= path.stats.rays);
}

TEST_CASE("while no round finds what only photons can find, rounds are short; found light has full rounds") {
  const auto light_paths = [](const scene::Scene& scene) {
    session::Renderer r(test::renderer_options());
    r.set_size(32, 32);
    r.set_scene(std::make_shared<scene::Scene>(scene));
    test::set(r, {{"components.caustic", "photons"}, {"photons.per_round", "16384"}, {"samples", "16"}});
    test::finish(r);
    return r.solvers().figure("light paths");
  };
  scene::Scene scene = test::turned_sun();
  CHECK(light_paths(scene) == 16 * 16384);
  // The mirror turns the sun upwards, out of the scene.
  scene.meshes.pop_back(), scene.instances.pop_back();
  test::add_quad(scene, {-1, 3, -1}, {2, 2, 0}, {0, 0, 2}, 1);
  CHECK(light_paths(scene) == 16384 + 15 * 1024);
}

TEST_CASE("no lamp, an enclosed lamp, few photons and extreme radii give defined results") {
  scene::Scene dark = glass_room();
  dark.materials[1].emission = vec3(0);
  const test::Result none = test::render(dark, k_all, 2, 16);
  for (const auto& component : none.image.components)
    for (const vec3& v : component) REQUIRE(v == vec3(0));
  // Its lamp is outside the room.
  scene::Scene shut = dark;
  shut.lights = {{.name = "lamp", .intensity = vec3(5), .position = {5, 1, 0}}};
  const test::Result outside = test::render(shut, k_all, 2, 16);
  for (const auto& component : outside.image.components)
    for (const vec3& v : component) REQUIRE(v == vec3(0));
  const scene::Scene room = glass_room();
  for (const auto& [paths, radius, least] :
       {std::array{"1", "3", "0.75"}, {"100", "1000", "1000"}, {"0", "1000", "0"}, {"20000", "0.1", "0"}}) {
    const test::Result r = test::render(
        room,
        with(k_all, {{"photons.per_round", paths}, {"photons.radius", radius}, {"photons.floor", least}}), 4,
        16);
    INFO(paths << " paths, " << radius << " pixels");
    for (const auto& component : r.image.components)
      for (const vec3& v : component)
        REQUIRE((std::isfinite(v.x + v.y + v.z) && std::min({v.x, v.y, v.z}) >= 0));
  }
}

TEST_CASE("of very many photons in one place a part is read, and the light stays the same") {
  // All of a narrow beam falls on a few pixels.
  scene::Scene s = turned_sun();
  s.lights[0].kind = scene::LightKind::spot;
  s.lights[0].position = {-3, 2, 0}, s.lights[0].inner_cone = 0.01f, s.lights[0].outer_cone = 0.012f;
  s.lights[0].intensity = vec3(1000);
  const auto sum = [&](const char* paths) {
    const test::Result r = test::render(s,
                                        {{"components.caustic", "photons"},
                                         {"photons.efficiency", "false"},
                                         {"photons.per_round", paths},
                                         {"photons.radius", "8"}},
                                        4, 32);
    return test::mean(r.image.components[3]);
  };
  const double few = sum("8000"), many = sum("400000");
  CHECK(few > 0);
  CHECK(many == Approx(few).epsilon(0.01));
}

TEST_CASE("photons are drawn over the picture and reported") {
  session::Renderer r(test::renderer_options());
  r.set_size(32, 32);
  r.set_scene(std::make_shared<scene::Scene>(glass_room()));
  test::set(r, with(k_all, {{"samples", "2"}}));
  test::finish(r);
  const std::vector<uint8_t> plain = r.output().picture(false);
  std::set<std::vector<uint8_t>> all{plain};
  for (const char* by : {"flux", "map", "light", "round", "bounce"}) {
    test::set(r, {{"overlay.photons", by}});
    CAPTURE(by);
    CHECK(all.insert(r.output().picture(false)).second);
  }
  const auto reports = r.solvers().reports();
  REQUIRE(reports.size() == 1);
  CHECK(reports[0]->solver == "photons");
  CHECK(reports[0]->figure("rounds") == 2);
  CHECK(reports[0]->figure("photons") > 1000);
  double by_part = 0;
  for (const char* part : {"last secondary", "last tertiary", "last caustic"}) {
    CHECK(reports[0]->figure(part) > 0);
    by_part += reports[0]->figure(part);
  }
  CHECK(by_part == reports[0]->figure("last photons"));
  CHECK(reports[0]->figure("radius pixels") == Approx(1.5 * std::sqrt((1 + 0.6667) / 2)));
  CHECK(reports[0]->legends.size() == 1);
  CHECK(r.solvers().statistics().at("photons").at("rounds") == 2);
  CHECK(r.samples() == 2);
}

}  // namespace photons_tests
