// links: session
// Depth of field: the blur of a small emitter has the size, shape and light that a thin lens gives; light
// tracing sees through the same lens as paths; and without a lens nothing changes.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "support/caustics.h"

namespace thin_lens_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_side = 64;
constexpr float k_away = 2;  // of the emitter from the camera [m]

/// A camera at the origin that looks along -Z at a square emitter 8 cm wide, a little off the axis.
scene::Scene small_emitter(const scene::Lens& lens) {
  scene::Scene s;
  s.name = "small emitter";
  s.materials = {test::diffuse(vec3(0), vec3(100, 200, 300))};
  test::add_quad(s, {0.01f, -0.07f, -k_away}, {0.08f, 0, 0}, {0, 0.08f, 0}, 0);
  scene::Camera camera;
  camera.yfov = 0.5f, camera.lens = lens;
  s.cameras = {camera};
  s.environment.given = true;
  return s;
}

/// Sum of a picture's light, its middle and the second moments about that, in pixels.
struct Blur {
  double sum = 0;
  glm::dvec2 middle{0}, squares{0};
};
Blur blur_of(const film::Image& image) {
  Blur b;
  const auto each = [&](auto&& act) {
    for (uint32_t y = 0; y < image.height; ++y)
      for (uint32_t x = 0; x < image.width; ++x)
        act(glm::dvec2(x + 0.5, y + 0.5), double(test::sum_at(image, size_t{y} * image.width + x).y));
  };
  each([&](const glm::dvec2& at, double light) { b.sum += light, b.middle += light * at; });
  b.middle /= b.sum;
  each([&](const glm::dvec2& at, double light) {
    b.squares += light / b.sum * (at - b.middle) * (at - b.middle);
  });
  return b;
}

/// Radius [pixels] in the picture of the lens's circle from a point on the axis at that depth.
double blur_radius(const scene::Lens& lens, double depth) {
  const double half = std::tan(0.25), focal_length = 0.018 / half, radius = focal_length / lens.f_number / 2;
  return radius * std::abs(1 / depth - 1 / double(lens.focus_distance)) * (k_side / 2) / half;
}

film::Image rendered(const scene::Scene& s, uint32_t samples) {
  return test::render(s, {}, samples, k_side, false).image;
}

}  // namespace

TEST_CASE("the blur of a small emitter has the diameter of the circle of confusion and all its light") {
  const Blur sharp = blur_of(rendered(small_emitter({}), 256));
  const auto moments = [](uint32_t blades) {  // of a regular polygon over the square of its outer radius
    return blades == 0 ? 0.5 : (2 + std::cos(2 * 3.14159265358979 / blades)) / 6;
  };
  for (const scene::Lens& lens :
       {scene::Lens{.f_number = 0.25f, .focus_distance = 1},
        scene::Lens{.f_number = 0.2f, .focus_distance = 5},
        scene::Lens{.f_number = 0.2f, .focus_distance = 1.2f, .blades = 6, .rotation = 0.3f},
        scene::Lens{.f_number = 0.2f, .focus_distance = 1.2f, .blades = 3}}) {
    INFO("f/" << lens.f_number << " at " << lens.focus_distance << " m, blades " << lens.blades);
    const Blur blurred = blur_of(rendered(small_emitter(lens), 1024));
    const double radius = blur_radius(lens, double(k_away));
    CHECK(radius > 5);
    const double expected = moments(lens.blades) * radius * radius;
    const glm::dvec2 own = blurred.squares - sharp.squares;
    CHECK(own.x + own.y == Approx(expected).epsilon(0.02));
    // Rotational symmetry of the second moments holds for any regular polygon.
    CHECK(own.x == Approx(own.y).epsilon(0.04));
    CHECK(blurred.sum == Approx(sharp.sum).epsilon(0.01));
    CHECK(blurred.middle.x == Approx(sharp.middle.x).margin(0.1));
    CHECK(blurred.middle.y == Approx(sharp.middle.y).margin(0.1));
  }
}

TEST_CASE("the blur of a round aperture is an even disc, and in the plane of focus there is none") {
  const scene::Lens lens{.f_number = 0.15f, .focus_distance = 1.1f};
  const film::Image image = rendered(small_emitter(lens), 1024);
  const Blur blurred = blur_of(image);
  // The emitter is 5 pixels wide.
  const double radius = blur_radius(lens, double(k_away)),
               level = blurred.sum / (3.14159265 * radius * radius);
  double inside = 0, outside = 0, count = 0;
  for (uint32_t y = 0; y < k_side; ++y)
    for (uint32_t x = 0; x < k_side; ++x) {
      const double away = glm::distance(glm::dvec2(x + 0.5, y + 0.5), blurred.middle);
      const double light = double(test::sum_at(image, size_t{y} * k_side + x).y);
      if (away < radius - 4) inside += light, ++count;
      if (away > radius + 4) outside += light;
    }
  CHECK(inside / count == Approx(level).epsilon(0.03));
  CHECK(outside == 0);
  const Blur sharp = blur_of(rendered(small_emitter({}), 256)),
             focused = blur_of(rendered(small_emitter({.f_number = 0.2f, .focus_distance = k_away}), 256));
  CHECK(focused.squares.x == Approx(sharp.squares.x).margin(0.06));
  CHECK(focused.squares.y == Approx(sharp.squares.y).margin(0.06));
  CHECK(focused.sum == Approx(sharp.sum).epsilon(0.01));
}

TEST_CASE("light tracing and paths see the same picture through a lens, shifted or not") {
  // A floor of dark and light squares under a beam of the sun, straight or turned by a mirror.
  scene::Scene straight = test::turned_sun(vec3(1));
  straight.meshes.clear(), straight.instances.clear();
  straight.materials.push_back(test::diffuse(vec3(0.05f)));
  for (int x = 0; x < 5; ++x)
    for (int z = 0; z < 5; ++z)
      test::add_quad(straight, {0.4f * float(x) - 1, 0.01f * float(x), 1 - 0.4f * float(z)}, {0.4f, 0, 0},
                     {0, 0, -0.4f}, (x * z + x) % 2 == 0 ? 0 : 2);
  // Oblique, so that depths differ; a triangular aperture, so that a mirrored or turned one shows.
  scene::Camera& camera = straight.cameras[0];
  camera.to_world = glm::inverse(glm::lookAt(vec3(0.3f, 0.9f, 0.8f), vec3(0.1f, 0, 0), vec3(0, 1, 0)));
  camera.yfov = 0.8f;
  const scene::Lens lens{.f_number = 0.2f, .focus_distance = 0.6f, .blades = 3, .rotation = 0.4f};
  const auto [has_lens, shift] = GENERATE(std::pair(true, vec2(0)), std::pair(true, vec2(0.2f, -0.3f)),
                                          std::pair(false, vec2(-0.3f, 0.1f)));
  camera.lens = has_lens ? lens : scene::Lens{}, camera.shift = shift;
  scene::Scene mirrored = straight;
  test::add_quad(mirrored, {-1, 3, -1}, {2, -2, 0}, {0, 0, 2}, 1);
  straight.lights[0].direction = {0, -1, 0};
  const uint32_t side = 32;
  const test::Result by_light =
      test::render(mirrored, {{"components.caustic", "light"}, {"light.per_round", "60000"}}, 32, side);
  const test::Result by_paths = test::render(straight, {}, 512, side);
  double contrast = 0;
  for (uint32_t block = 0; block < 64; ++block) {
    const uint32_t x = block % 8 * 4, y = block / 8 * 4;
    const test::MeanOf light = test::mean_of(by_light.image, 3, x, y, x + 4, y + 4),
                       path = test::mean_of(by_paths.image, 0, x, y, x + 4, y + 4);
    INFO("block " << block << ": " << light.value.y << " +- " << light.noise.y << ", by paths "
                  << path.value.y << " +- " << path.noise.y);
    CHECK(std::abs(light.value.y - path.value.y) <=
          5 * std::hypot(light.noise.y, path.noise.y) + 0.004 * path.value.y);
    contrast = std::max(contrast, path.value.y / test::mean_of(by_paths.image, 0).value.y);
  }
  CHECK(contrast > 1.2);
}

TEST_CASE("a camera without an f-number is a pinhole, whatever its lens has, and so it is after a lens") {
  scene::Scene s = small_emitter({.focus_distance = 0.5f, .blades = 5, .rotation = 1});
  test::add_box(s, {-1, -1, -3}, {1, 1, 0.5f});
  s.materials.push_back(test::diffuse(vec3(0.5f)));
  for (size_t m = 1; m < s.meshes.size(); ++m)
    for (scene::Primitive& p : s.meshes[m].primitives) p.material = 1;
  scene::Scene plain = s;
  plain.cameras[0].lens = {};
  const film::Image expected = test::render(plain, {}, 4, 32).image;
  CHECK(test::identical(test::render(s, {}, 4, 32).image, expected));
  session::Renderer renderer(test::renderer_options());
  renderer.set_size(32, 32);
  renderer.set_scene(std::make_shared<scene::Scene>(plain));
  test::set(renderer, test::dense_records({{"samples", "4"}}));
  CHECK(test::identical(test::finish(renderer), expected));
  scene::Camera wide = plain.cameras[0];
  wide.lens = {.f_number = 0.5f, .focus_distance = 0.5f};
  renderer.set_camera(wide);
  CHECK_FALSE(test::identical(test::finish(renderer), expected));
  renderer.set_camera(plain.cameras[0]);
  CHECK(test::identical(test::finish(renderer), expected));
}

}  // namespace thin_lens_tests
