// links: session
// Effects that are switched off: the picture of a scene without them, bit for bit, and back.
#include <catch2/catch.hpp>

#include "session/renderer.h"
#include "support/render.h"
#include "support/rooms.h"

namespace effects_off_tests {

using namespace lucerna;

namespace {

film::Image picture(session::Renderer& r) {
  r.settings().set("samples", "4");
  r.apply_settings();
  return test::finish(r);
}

bool same(const film::Image& a, const film::Image& b) {
  for (const size_t c : k_components)
    if (!test::identical(a.components[c], b.components[c])) return false;
  return true;
}

film::Image picture_of(const scene::Scene& scene) {
  session::Renderer r(test::renderer_options());
  r.set_size(24, 24);
  r.set_scene(std::make_shared<scene::Scene>(scene));
  return picture(r);
}

}  // namespace

TEST_CASE("an effect that is off loses exactly its light, and comes back with all of it") {
  const scene::Scene room = test::room_under_moon();
  scene::Scene without = room;
  without.lights[0].enabled = false;
  session::Renderer r(test::renderer_options());
  r.set_size(24, 24);
  r.set_scene(std::make_shared<scene::Scene>(room));
  const film::Image whole = picture(r);
  r.settings().set("effects.off", "point");
  const film::Image less = picture(r);
  CHECK_FALSE(same(whole, less));
  CHECK(same(less, picture_of(without)));
  CHECK_FALSE(r.facts().has("point"));
  // An edit of the lamp changes nothing while it is off.
  scene::Light lamp = r.scene()->lights[0];
  lamp.intensity *= 2.0f;
  r.set_light(0, lamp);
  CHECK(same(less, picture(r)));
  lamp.intensity *= 0.5f;
  r.set_light(0, lamp);
  r.settings().set("effects.off", "");
  CHECK(same(whole, picture(r)));
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("with everything off there is a black picture; an unknown effect changes nothing") {
  session::Renderer r(test::renderer_options());
  r.set_size(24, 24);
  r.set_scene(std::make_shared<scene::Scene>(test::room_under_moon()));
  const film::Image whole = picture(r);
  r.settings().set("effects.off", "point, shine");
  CHECK_THROWS_WITH(r.apply_settings(), Catch::Contains("effects.off") && Catch::Contains("'shine'"));
  CHECK(r.settings().text("effects.off").empty());
  CHECK(same(whole, picture(r)));
  r.settings().set("effects.off", "point,spot,directional,emission,environment");
  const film::Image dark = picture(r);
  for (const auto& component : dark.components)
    for (const vec3& v : component) REQUIRE(v == vec3(0));
}

}  // namespace effects_off_tests
