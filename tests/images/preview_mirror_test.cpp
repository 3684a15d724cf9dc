// links: session
// The window's picture of a mirror while there are few samples: what it shows has sharp borders.
#include <catch2/catch.hpp>

#include "support/render.h"
#include "support/rooms.h"

using namespace lucerna;

namespace {

constexpr uint32_t k_size = 64;

/// A mirror before the camera; behind the camera a wall that is dark on the left and bright on the right, in
/// the light of a wide panel that is seen by neither.
scene::Scene mirror_room() {
  scene::Scene s;
  s.name = "mirror";
  scene::Material mirror = test::diffuse(vec3(0.9f));
  mirror.metallic = 1, mirror.roughness = 0;
  s.materials = {mirror, test::diffuse(vec3(0.1f)), test::diffuse(vec3(0.7f)),
                 test::diffuse(vec3(0), vec3(12))};
  test::add_quad(s, vec3(-3, -3, -3), vec3(6, 0, 0), vec3(0, 6, 0), 0);
  test::add_quad(s, vec3(0, -4, 4), vec3(-4, 0, 0), vec3(0, 8, 0), 1);
  test::add_quad(s, vec3(4, -4, 4), vec3(-4, 0, 0), vec3(0, 8, 0), 2);
  test::add_quad(s, vec3(-3, 5, 0), vec3(6, 0, 0), vec3(0, 0, 3), 3);
  scene::Camera camera;
  camera.yfov = 0.6f;
  s.cameras = {camera};
  return s;
}

}  // namespace

TEST_CASE("a mirror's picture has the borders of what it shows from the first samples on") {
  session::RendererOptions options = test::renderer_options(true);
  options.interactive = true;
  session::Renderer r(options);
  r.set_size(k_size, k_size);
  r.set_scene(std::make_shared<scene::Scene>(mirror_room()));
  test::set(r, {{"samples", "64"}, {"path.batch", "8192"}, {"film.tone_curve", "linear"}, {"film.ev", "0"}});
  for (int i = 0; i < 16; ++i) r.draw_draft();
  while (r.samples() < 2) r.step();
  const std::vector<uint8_t> shown = r.shown_picture(false);
  REQUIRE(shown.size() == size_t{4} * k_size * k_size);
  CHECK(r.preview_shares().filtered > 0.5);
  // Columns beside the border, in the mirror's middle; what is to the right behind one is to the right in it.
  const auto column = [&](uint32_t x) {
    double sum = 0;
    for (uint32_t y = 16; y < 48; ++y) sum += shown[4 * (y * k_size + x)];
    return sum / 32;
  };
  const double dark = column(26), bright = column(37), before = column(30), behind = column(33);
  INFO("columns " << dark << " " << before << " | " << behind << " " << bright);
  CHECK(bright > 2 * dark);
  CHECK(before < dark + 0.15 * (bright - dark));
  CHECK(behind > bright - 0.15 * (bright - dark));
}
