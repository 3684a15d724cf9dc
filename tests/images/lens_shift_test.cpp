// links: commands
// Lens shift: vertical lines of a tilted view become vertical, the middle of the picture stays, and the
// preview of a moved camera finds its surfaces through a shifted lens.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "commands/camera_control.h"
#include "support/render.h"
#include "support/rooms.h"

namespace lens_shift_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_width = 64, k_height = 48;

/// Mean column of the light in each row that has some, and the whole light's place.
struct Columns {
  std::vector<double> of_row;
  glm::dvec2 middle{0};
};
Columns columns_of(const film::Image& image) {
  Columns c;
  double all = 0;
  for (uint32_t y = 0; y < image.height; ++y) {
    double sum = 0, at = 0;
    for (uint32_t x = 0; x < image.width; ++x) {
      const double light = double(test::sum_at(image, size_t{y} * image.width + x).y);
      sum += light, at += light * (x + 0.5);
      c.middle += light * glm::dvec2(x + 0.5, y + 0.5), all += light;
    }
    if (sum > 0) c.of_row.push_back(at / sum);
  }
  c.middle /= all;
  return c;
}
double spread_of(const std::vector<double>& values) {
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  return *hi - *lo;
}

film::Image rendered(const scene::Scene& s) {
  return test::render({.width = k_width, .height = k_height, .samples = 64, .validated = false}, &s).image;
}

}  // namespace

TEST_CASE("vertical lines of a tilted view are vertical through a shifted lens, and the middle stays") {
  // A glowing pole beside the middle, and a lamp in the middle, 4 m away.
  scene::Scene pole;
  pole.name = "pole";
  pole.materials = {test::diffuse(vec3(0), vec3(100))};
  pole.materials[0].double_sided = true;
  const vec3 eye(1, 1.7f, 6), target(1.5f, 4, 2);
  test::add_quad(pole, {0.2f, -20, 2}, {0.03f, 0, 0}, {0, 60, 0}, 0);
  scene::Camera tilted;
  tilted.yfov = 0.9f;
  tilted.to_world = glm::inverse(glm::lookAt(eye, target, glm::normalize(vec3(0.2f, 1, 0))));
  pole.cameras = {tilted};
  pole.environment.given = true;
  scene::Scene lamp = pole;
  lamp.meshes.clear(), lamp.instances.clear();
  test::add_quad(lamp, target - vec3(0.05f, 0.05f, 0), {0.1f, 0, 0}, {0, 0.1f, 0}, 0);
  const Columns pole_before = columns_of(rendered(pole)), lamp_before = columns_of(rendered(lamp));
  CHECK(spread_of(pole_before.of_row) > 2.5);
  commands::Viewpoint view{.camera = tilted};
  REQUIRE(commands::upright(view, float(k_width) / float(k_height)));
  CHECK(view.camera.shift.y > 0.2f);
  pole.cameras = lamp.cameras = {view.camera};
  const Columns pole_after = columns_of(rendered(pole)), lamp_after = columns_of(rendered(lamp));
  CHECK(pole_after.of_row.size() == k_height);
  CHECK(spread_of(pole_after.of_row) < 0.05);
  CHECK(lamp_before.middle.x == Approx(k_width / 2).margin(0.1));
  CHECK(lamp_after.middle.x == Approx(lamp_before.middle.x).margin(0.1));
  CHECK(lamp_after.middle.y == Approx(lamp_before.middle.y).margin(0.1));
  // Again: nothing changes.
  const scene::Camera once = view.camera;
  REQUIRE(commands::upright(view, float(k_width) / float(k_height)));
  CHECK(view.camera.shift.x == Approx(once.shift.x).margin(1e-5));
  CHECK(view.camera.shift.y == Approx(once.shift.y).margin(1e-5));
  CHECK(view.camera.yfov == Approx(once.yfov));
}

TEST_CASE("a shift moves the picture by whole pixels, of perspective and parallel cameras") {
  scene::Scene s = test::block_room();
  s.cameras = {s.cameras[0]};
  for (const bool parallel : {false, true}) {
    s.cameras[0].orthographic = parallel, s.cameras[0].xmag = s.cameras[0].ymag = 1.5f;
    s.cameras[0].shift = vec2(0);
    const film::Image plain = rendered(s);
    s.cameras[0].shift = vec2(8.0f / k_width, 4.0f / k_height);
    const film::Image shifted = rendered(s);
    // Pixels have other random numbers: compare what has no noise.
    double off = 0;
    uint32_t count = 0;
    for (uint32_t y = 4; y < k_height; ++y)
      for (uint32_t x = 0; x + 8 < k_width; ++x, ++count)
        off += double(glm::length(shifted.normal[size_t{y} * k_width + x] -
                                  plain.normal[size_t{y - 4} * k_width + x + 8]));
    CHECK(off / count < 0.01);
  }
}

TEST_CASE("the preview of a moved camera finds its surfaces through a shifted lens") {
  // A wall, dark on the left and bright on the right; the camera moves along it.
  scene::Scene s;
  s.name = "wall";
  s.materials = {test::diffuse(vec3(0.1f)), test::diffuse(vec3(0.8f))};
  for (scene::Material& m : s.materials) m.unlit = true;
  test::add_quad(s, {-20, -20, -4}, {20, 0, 0}, {0, 40, 0}, 0);
  test::add_quad(s, {0, -20, -4}, {20, 0, 0}, {0, 40, 0}, 1);
  scene::Camera camera;
  camera.yfov = 0.8f, camera.shift = {0.7f, -0.9f};
  const float pixel = 2 * std::tan(0.4f) * 4 / float(k_height);  // on the wall
  // The border in the middle of the picture.
  camera.to_world[3] = vec4(-camera.shift.x * pixel * float(k_width), 0, 0, 1);
  s.cameras = {camera};
  s.environment.given = true;
  session::RendererOptions options = test::renderer_options();
  options.interactive = true;
  session::Renderer r(options);
  r.set_size(k_width, k_height);
  r.set_scene(std::make_shared<scene::Scene>(s));
  test::set(r, {{"samples", "16"}, {"path.batch", "8192"}, {"film.tone_curve", "linear"}, {"film.ev", "0"}});
  const auto border = [&] {
    const std::vector<uint8_t> shown = r.output().shown_picture(false);
    REQUIRE(shown.size() == size_t{4} * k_width * k_height);
    double mean = 0;
    for (uint32_t y = 8; y < k_height - 8; ++y)
      for (uint32_t x = 0; x < k_width; ++x)
        mean += shown[4 * (size_t{y} * k_width + x)] < 150 ? 1.0 / (k_height - 16) : 0;
    return mean;
  };
  for (int i = 0; i < 16; ++i) r.previews().draw();
  while (r.samples() < 4) r.step();
  CHECK(border() == Approx(k_width / 2).margin(0.6));
  camera.to_world[3].x += 8 * pixel;
  r.set_camera(camera);
  CHECK(border() == Approx(k_width / 2 - 8).margin(1));
}

}  // namespace lens_shift_tests
