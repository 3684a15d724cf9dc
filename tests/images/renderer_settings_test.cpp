// links: session
// What a person sets stays while the scene stays, and goes with it.
#include <catch2/catch.hpp>

#include "session/renderer.h"

using namespace lucerna;

TEST_CASE("another tracer keeps edits and camera; another scene starts with its own settings") {
  const auto file = [](const std::string& name) {
    return std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".gltf";
  };
  session::Renderer r({.device = "cpu", .validation = true, .shaders = {}, .defines = {}});
  r.settings().set("path.batch", "1024");
  r.set_size(16, 16);
  r.load(file("glass"));
  CHECK(r.tracer_name() == "host");
  CHECK(r.settings().integer("path.batch") == 1024);
  const double own = r.settings().real("film.ev");
  r.settings().set("film.ev", "-3");
  r.settings().set("components.caustic", "off");
  r.apply_settings();
  scene::Camera moved = r.camera();
  moved.to_world[3][0] += 0.25f;
  r.set_camera(moved);

  r.settings().set("tracer", "compute-bvh");
  r.apply_settings();
  CHECK(r.tracer_name() == "compute-bvh");
  CHECK(r.settings().real("film.ev") == -3);
  CHECK(r.enabled_components() == 7);
  CHECK(r.camera().to_world == moved.to_world);
  CHECK(r.step());

  r.load(file("cornell"));
  CHECK(r.settings().real("film.ev") == own);  // both scenes ask for the same exposure
  CHECK(r.enabled_components() == 15);
  CHECK(r.tracer_name() == "compute-bvh");
  CHECK(r.step());

  // What cannot be opened changes nothing.
  r.settings().set("film.ev", "-2");
  CHECK_THROWS_AS(r.load("/no/such.gltf"), Error);
  CHECK(r.settings().real("film.ev") == -2);
  CHECK(r.scene()->name == "cornell");
  CHECK(r.step());
  CHECK(r.device().validation_messages() == 0);
}
