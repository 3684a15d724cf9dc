// links: session
// Light tracing through the whole renderer: its light compared with closed forms and with path tracing, each
// component counted once whichever solver computes the rest, and a picture that depends on settings and seed
// only.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/caustics.h"

namespace light_tracing_tests {

using namespace lucerna;

using test::mean_of, test::MeanOf, test::turned_sun, test::with;

namespace {

constexpr int k_caustic = 3;

const test::Settings k_light{{"components.caustic", "light"}};

/// A room with an emissive panel, a glass ball, a mirror on the wall that shows the ball's caustic, a pane in
/// front of a part of the floor and a mat of coverage one half.
scene::Scene glass_room() {
  scene::Scene s;
  s.name = "glass room", s.file = "glass.gltf";
  s.materials = {test::diffuse({0.7f, 0.6f, 0.5f}), test::diffuse(vec3(0), vec3(30)), {}, {}, {},
                 test::diffuse({0.2f, 0.5f, 0.8f})};
  s.materials[2].metallic = 0, s.materials[2].roughness = 0, s.materials[2].transmission = 1;
  s.materials[2].thickness = 1;
  s.materials[3].metallic = 1, s.materials[3].roughness = 0, s.materials[3].base_color = vec4(0.9f);
  s.materials[4].metallic = 0, s.materials[4].roughness = 0, s.materials[4].transmission = 1;
  s.materials[4].double_sided = true;
  s.materials[5].alpha_mode = scene::AlphaMode::blend, s.materials[5].base_color.w = 0.5f;
  s.materials[5].double_sided = true;
  test::add_box(s, {-2, 0, -2}, {2, 2.5f, 2});
  test::add_quad(s, {-0.4f, 2.45f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, 1);
  test::add_ball(s, {0.3f, 0.7f, 0}, 0.5f, 2);
  test::add_quad(s, {-1.9f, 0.1f, -1}, {0, 2, 0}, {0, 0, 2}, 3);
  test::add_quad(s, {0.9f, 0, 1}, {0, 0, -2}, {0, 0.8f, 0}, 4);
  test::add_quad(s, {-0.6f, 0.05f, 0.9f}, {1.6f, 0, 0}, {0, 0, -0.9f}, 5);
  // A mat whose shading normals deviate from its plane.
  test::add_quad(s, {-1.2f, 0.01f, 0.6f}, {1.2f, 0, 0}, {0, 0, -1.2f}, 0);
  s.meshes.back().primitives[0].normals.assign(4, glm::normalize(vec3(0.5f, 0.8f, -0.3f)));
  scene::Camera front;
  front.yfov = 1.1f, front.to_world[3] = vec4(0, 1.2f, 1.95f, 1);
  s.cameras = {front};
  s.environment.given = true;
  return s;
}

}  // namespace

TEST_CASE("a beam of even light on a plane has the expected radiance") {
  const vec3 radiance = vec3(0.8f, 0.5f, 0.2f) * vec3(3, 4, 5) * vec3(0.9f, 0.8f, 0.7f) / k_pi;
  scene::Scene s = turned_sun();
  for (const bool parallel : {false, true}) {
    INFO("parallel rays " << parallel);
    s.cameras[0].orthographic = parallel, s.cameras[0].xmag = s.cameras[0].ymag = 0.4f;
    const test::Result r = test::render(s, with(k_light, {{"light.per_round", "200000"}}), 16, 32);
    // Blocks in the picture's corner and centre alike.
    for (uint32_t block = 0; block < 16; ++block) {
      const uint32_t x = block % 4 * 8, y = block / 4 * 8;
      const MeanOf m = mean_of(r.image, k_caustic, x, y, x + 8, y + 8);
      for (int c = 0; c < 3; ++c) CHECK(m.value[c] == Approx(double(radiance[c])).epsilon(0.04));
    }
    const MeanOf all = mean_of(r.image, k_caustic);
    for (int c = 0; c < 3; ++c) CHECK(all.value[c] == Approx(double(radiance[c])).epsilon(0.006));
    CHECK(r.stats.dropped == 0);
  }
  // Camera paths never hit this light.
  CHECK(test::mean(test::render(turned_sun(), {}, 4, 16).image.components[3]) == 0);
}

TEST_CASE("light scales with its lamp through 16 decades, and adds up bit for bit") {
  scene::Scene s = turned_sun();
  const test::Settings settings = with(k_light, {{"light.per_round", "20000"}});
  const test::Result one = test::render(s, settings, 4, 16);
  for (const float power : {0x1p-27f, 0x1p27f}) {
    s.lights[0].intensity = power * vec3(3, 4, 5);
    const test::Result r = test::render(s, settings, 4, 16);
    for (size_t i = 0; i < one.image.components[3].size(); ++i)
      REQUIRE(r.image.components[3][i] == power * one.image.components[3][i]);
  }
}

TEST_CASE("light refracted into water has the radiance of the transmitted light") {
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
  const test::Settings settings = with(k_light, {{"light.per_round", "100000"}});
  const double through = 1 - std::pow(0.33 / 2.33, 2);
  const MeanOf flat = mean_of(test::render(s, settings, 8, 32).image, k_caustic);
  const vec3 leaning = glm::normalize(vec3(0.5f, 0.8f, -0.3f));
  s.meshes[0].primitives[0].normals.assign(4, leaning);
  const MeanOf leant = mean_of(test::render(s, settings, 8, 32).image, k_caustic);
  for (int c = 0; c < 3; ++c) {
    const double radiance =
        double(s.materials[0].base_color[c] * s.lights[0].intensity[c]) * through / double(k_pi);
    CHECK(flat.value[c] == Approx(radiance).epsilon(0.01));
    CHECK(leant.value[c] == Approx(radiance * double(leaning.y)).epsilon(0.01));
  }
}

TEST_CASE("partly covered surfaces, seen directly or as a veil, show light in proportion to coverage") {
  // A floor of coverage a third; above it a veil that transmits three quarters, in front of the camera but
  // not of the light.
  scene::Scene s = turned_sun();
  s.materials[0].alpha_mode = scene::AlphaMode::blend, s.materials[0].base_color.w = 1.0f / 3;
  const double floor = 0.5 * 4 * 0.8 / double(k_pi) / 3;
  const test::Settings settings = with(k_light, {{"light.per_round", "100000"}});
  CHECK(mean_of(test::render(s, settings, 8, 16).image, k_caustic).value.y == Approx(floor).epsilon(0.01));
  // The same by photons, which lie on all of it but are seen by a third.
  const test::Settings photons{
      {"components.caustic", "photons"}, {"photons.efficiency", "false"}, {"photons.per_round", "100000"}};
  CHECK(mean_of(test::render(s, photons, 20, 16).image, k_caustic).value.y == Approx(floor).epsilon(0.03));
  scene::Scene veiled = s;
  veiled.materials.push_back(test::diffuse(vec3(0)));
  veiled.materials[2].alpha_mode = scene::AlphaMode::blend, veiled.materials[2].base_color.w = 0.25f;
  veiled.materials[2].double_sided = true;
  test::add_quad(veiled, {-0.6f, 0.8f, 0.6f}, {1.2f, 0, 0}, {0, 0, -1.2f}, 2);
  // The beam passes the veil too.
  CHECK(mean_of(test::render(veiled, settings, 8, 16).image, k_caustic).value.y ==
        Approx(floor * 0.75 * 0.75).epsilon(0.01));
}

namespace {

constexpr uint32_t k_side = 40, k_reference_samples = 768;

const test::Result& by_paths() {
  static const test::Result path = [] {
    const scene::Scene room = glass_room();
    return test::render(
        {.width = k_side, .height = k_side, .samples = k_reference_samples, .settings = {{"seed", "5"}}},
        &room);
  }();
  return path;
}

/// Z of blocks of 8 x 8 pixels and of the whole picture: the largest, and their mean square. Camera paths
/// rarely hit this light, and few hits underestimate their noise: with no more than `k_most` per hit the
/// variance is at most k_most times the mean.
void check_against_paths(const film::Image& image, double allowed) {
  constexpr double k_most = 20;  // the lamp's radiance times the brightest albedo
  const film::Image& truth = by_paths().image;
  const auto z_of = [&](const MeanOf& a, const MeanOf& b, double pixels) {
    const double rare = std::sqrt(k_most * a.value.y / (pixels * k_reference_samples));
    INFO(a.value.y << " +- " << a.noise.y << ", path " << b.value.y << " +- " << b.noise.y << ", " << rare);
    const double z = std::max(0.0, std::abs(a.value.y - b.value.y) - allowed * b.value.y) /
                     std::max(std::hypot(a.noise.y, std::max(b.noise.y, rare)), 1e-9);
    CHECK(z < 5);
    return z;
  };
  double squares = 0;
  for (uint32_t block = 0; block < 25; ++block) {
    const uint32_t x = block % 5 * 8, y = block / 5 * 8;
    squares += std::pow(z_of(mean_of(image, k_caustic, x, y, x + 8, y + 8),
                             mean_of(truth, k_caustic, x, y, x + 8, y + 8), 64),
                        2);
  }
  CHECK(squares / 25 < 2);
  z_of(mean_of(image, k_caustic), mean_of(truth, k_caustic), 1600);
}

}  // namespace

TEST_CASE(
    "light tracing with path tracing gives the picture of path tracing and leaves other light unchanged") {
  const scene::Scene room = glass_room();
  const test::Result r =
      test::render({.width = k_side,
                    .height = k_side,
                    .samples = 64,
                    .settings = with(k_light, {{"seed", "9"}, {"light.per_round", "32000"}})},
                   &room);
  CHECK(r.stats.dropped == 0);
  CHECK(r.bias_known[3]);
  check_against_paths(r.image, 0);
  // All other light uses the same random numbers.
  const test::Result path =
      test::render({.width = k_side, .height = k_side, .samples = 64, .settings = {{"seed", "9"}}}, &room);
  for (const size_t c : {0u, 1u, 2u}) CHECK(test::identical(path.image.components[c], r.image.components[c]));
}

TEST_CASE("light tracing with photons for the rest gives the picture of path tracing") {
  const scene::Scene room = glass_room();
  const test::Settings settings{{"components.caustic", "light+photons"},
                                {"seed", "9"},
                                {"light.per_round", "24000"},
                                {"photons.per_round", "24000"},
                                {"photons.radius", "0.8"}};
  const test::Result r =
      test::render({.width = k_side, .height = k_side, .samples = 22, .settings = settings}, &room);
  CHECK_FALSE(r.bias_known[3]);
  check_against_paths(r.image, 0.04);
  // Also with records.
  const test::Result cached = test::render(
      {.width = k_side,
       .height = k_side,
       .samples = 18,
       .settings = with(settings, {{"components.secondary", "cache"}, {"components.tertiary", "cache"}})},
      &room);
  check_against_paths(cached.image, 0.04);
}

TEST_CASE("aiming does not change the mean of light tracing") {
  const scene::Scene room = glass_room();
  const auto render = [&](const char* aim) {
    return test::render({.width = k_side,
                         .height = k_side,
                         .samples = 64,
                         .settings = with(k_light, {{"light.aim", aim},
                                                    {"light.per_round", "4000"},
                                                    {"components.primary", "off"},
                                                    {"components.secondary", "off"},
                                                    {"components.tertiary", "off"}})},
                        &room);
  };
  const MeanOf aimed = mean_of(render("true").image, k_caustic),
               plain = mean_of(render("false").image, k_caustic);
  CHECK(std::abs(aimed.value.y - plain.value.y) < 4 * std::hypot(aimed.noise.y, plain.noise.y));
}

TEST_CASE("the picture of light tracing does not depend on batches or adaptive sampling") {
  const scene::Scene room = glass_room();
  const test::Render base{
      .width = 40, .height = 36, .samples = 6, .settings = with(k_light, {{"light.per_round", "5000"}})};
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

TEST_CASE("without surfaces that focus light no light paths are traced, and nothing is spent") {
  const scene::Scene room = test::block_room();
  const test::Result path = test::render(room, {}, 8, 32);
  session::Renderer r(test::renderer_options());
  r.set_size(32, 32);
  r.set_scene(std::make_shared<scene::Scene>(room));
  test::set(r, with(k_light, {{"samples", "8"}}));
  const film::Image image = test::finish(r);
  for (const size_t c : {0u, 1u, 2u, 3u})
    CHECK(test::identical(path.image.components[c], image.components[c]));
  CHECK(r.solvers().figure("light paths") == 0);
  CHECK(r.stats().rays == path.stats.rays);
}

TEST_CASE("light tracing follows camera, lamp, size and choice of solver") {
  const scene::Scene room = glass_room();
  session::Renderer r(test::renderer_options());
  r.set_size(24, 24);
  r.set_scene(std::make_shared<scene::Scene>(room));
  test::set(r, with(k_light, {{"samples", "3"}, {"light.per_round", "3000"}}));
  const film::Image first = test::finish(r);
  const auto fresh = [&](const scene::Scene& s, const test::Settings& settings, uint32_t side) {
    test::Settings all = with(k_light, {{"light.per_round", "3000"}});
    return test::render(
        {.width = side, .height = side, .samples = 3, .settings = with(all, settings), .validated = false},
        &s);
  };
  CHECK(test::identical(first, fresh(room, {}, 24).image));
  scene::Scene moved = room;
  moved.cameras[0].to_world[3] = vec4(0.5f, 1.5f, 1.9f, 1);
  r.set_camera(moved.cameras[0]);
  CHECK(test::identical(test::finish(r), fresh(moved, {}, 24).image));
  r.set_size(32, 32);
  CHECK(test::identical(test::finish(r), fresh(moved, {}, 32).image));
  test::set(r, {{"components.caustic", "light+photons"}});
  CHECK(test::identical(test::finish(r), fresh(moved, {{"components.caustic", "light+photons"}}, 32).image));
  test::set(r, {{"components.caustic", "light"}});
  CHECK(test::identical(test::finish(r), fresh(moved, {}, 32).image));
  const auto reports = r.solvers().reports();
  REQUIRE(reports.size() == 1);
  CHECK(reports[0]->solver == "light");
  CHECK(reports[0]->figure("rounds") == 3);
  CHECK(reports[0]->figure("joined") > 100);
  CHECK(r.solvers().statistics().at("light").at("rounds") == 3);
}

TEST_CASE("light tracing with no lamp, an enclosed lamp or one path per pass gives defined results") {
  scene::Scene dark = glass_room();
  dark.materials[1].emission = vec3(0);
  scene::Scene shut = dark;  // its lamp is outside the room
  shut.lights = {{.name = "lamp", .intensity = vec3(5), .position = {5, 1, 0}}};
  for (const scene::Scene& scene : {dark, shut}) {
    const test::Result r = test::render(scene, k_light, 2, 16);
    for (const vec3& v : r.image.components[3]) REQUIRE(v == vec3(0));
  }
  const test::Result one = test::render(glass_room(), with(k_light, {{"light.per_round", "1"}}), 4, 16);
  for (const vec3& v : one.image.components[3])
    REQUIRE((std::isfinite(v.x + v.y + v.z) && std::min({v.x, v.y, v.z}) >= 0));
}

TEST_CASE("drawing light paths and aim targets does not change the picture") {
  session::Renderer r(test::renderer_options());
  r.set_size(48, 40);
  r.set_scene(std::make_shared<scene::Scene>(glass_room()));
  test::set(r, with(k_light, {{"samples", "2"}, {"light.per_round", "2000"}}));
  const film::Image image = test::finish(r);
  const std::vector<uint8_t> plain = r.output().picture(false);
  for (const char* view : {"overlay.light_paths", "overlay.light_aim"}) {
    INFO(view);
    test::set(r, {{view, "true"}});
    CHECK(r.output().picture(false) != plain);
    CHECK(r.solvers().reports()[0]->legends.size() == 1);
    test::set(r, {{view, "false"}});
    CHECK(r.output().picture(false) == plain);
  }
  CHECK(test::identical(r.image(), image));
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("light paths are drawn of all lights, or of one lamp") {
  scene::Scene s = glass_room();
  s.lights = {{.name = "left", .intensity = vec3(5), .position = {-1, 2, 1}},
              {.name = "right", .intensity = vec3(5), .position = {1, 2, 1}}};
  session::Renderer r(test::renderer_options());
  r.set_size(48, 40);
  r.set_scene(std::make_shared<scene::Scene>(s));
  test::set(r,
            with(k_light, {{"samples", "1"}, {"light.per_round", "2000"}, {"overlay.light_paths", "true"}}));
  test::finish(r);
  std::vector<std::vector<uint8_t>> shown;
  for (const char* lamp : {"0", "1", "2"}) {
    test::set(r, {{"overlay.light_paths_of", lamp}});
    shown.push_back(r.output().picture(false));
  }
  CHECK(shown[0] != shown[1]);
  CHECK(shown[0] != shown[2]);
  CHECK(shown[1] != shown[2]);
}

}  // namespace light_tracing_tests
