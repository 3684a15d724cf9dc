// links: session
// The window's preview of a mirror, and through glass, with few samples: objects seen there have sharp
// borders.
#include <catch2/catch.hpp>

#include "support/render.h"
#include "support/rooms.h"

namespace preview_mirror_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_size = 64;

/// In front of the camera a mirror or glass that shows a wall, dark on the left and bright on the right, lit
/// by a wide panel outside the view.
scene::Scene room(const scene::Material& before, bool mirror) {
  scene::Scene s;
  s.name = "room";
  s.materials = {before, test::diffuse(vec3(0.1f)), test::diffuse(vec3(0.7f)),
                 test::diffuse(vec3(0), vec3(12))};
  const vec3 across(mirror ? -4 : 4, 0, 0);
  const float wall = mirror ? 4 : -7;
  test::add_quad(s, vec3(-3, -3, -3), vec3(6, 0, 0), vec3(0, 6, 0), 0);
  if (before.thickness > 0) test::add_quad(s, vec3(3, -3, -3.02f), vec3(-6, 0, 0), vec3(0, 6, 0), 0);
  test::add_quad(s, vec3(mirror ? 0 : -4, -4, wall), across, vec3(0, 8, 0), 1);
  test::add_quad(s, vec3(mirror ? 4 : 0, -4, wall), across, vec3(0, 8, 0), 2);
  test::add_quad(s, vec3(-3, 5, mirror ? 0 : -6), vec3(6, 0, 0), vec3(0, 0, 3), 3);
  scene::Camera camera;
  camera.yfov = 0.6f;
  s.cameras = {camera};
  return s;
}

/// The picture with two samples: columns next to the wall's border and far from it, from 0 to 255.
struct Columns {
  double dark, before, behind, bright;
};
Columns columns(const scene::Scene& s) {
  session::RendererOptions options = test::renderer_options(true);
  options.interactive = true;
  session::Renderer r(options);
  r.set_size(k_size, k_size);
  r.set_scene(std::make_shared<scene::Scene>(s));
  test::set(r, {{"samples", "64"}, {"path.batch", "8192"}, {"film.tone_curve", "linear"}, {"film.ev", "0"}});
  for (int i = 0; i < 16; ++i) r.previews().draw();
  while (r.samples() < 2) r.step();
  const std::vector<uint8_t> shown = r.output().shown_picture(false);
  REQUIRE(shown.size() == size_t{4} * k_size * k_size);
  CHECK(r.output().preview_shares().filtered > 0.5);
  const auto column = [&](uint32_t x) {
    double sum = 0;
    for (uint32_t y = 16; y < 48; ++y) sum += shown[4 * (y * k_size + x)];
    return sum / 32;
  };
  return {column(26), column(30), column(33), column(37)};
}

void check_sharp(const Columns& c) {
  INFO("columns " << c.dark << " " << c.before << " | " << c.behind << " " << c.bright);
  CHECK(c.bright > 2 * c.dark);
  CHECK(c.before < c.dark + 0.15 * (c.bright - c.dark));
  CHECK(c.behind > c.bright - 0.15 * (c.bright - c.dark));
}

}  // namespace

TEST_CASE("objects in a mirror have sharp borders from the first samples on") {
  scene::Material mirror = test::diffuse(vec3(0.9f));
  mirror.metallic = 1, mirror.roughness = 0;
  check_sharp(columns(room(mirror, true)));
}

TEST_CASE("objects behind glass have sharp borders from the first samples on") {
  scene::Material glass = test::diffuse(vec3(0.95f));
  glass.roughness = 0, glass.specular = 1, glass.transmission = 1;
  for (const float thickness : {0.0f, 0.02f}) {
    glass.thickness = thickness;
    INFO("thickness " << thickness);
    check_sharp(columns(room(glass, false)));
  }
}

}  // namespace preview_mirror_tests
