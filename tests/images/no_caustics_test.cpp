// links: session
// Where all surfaces are diffuse no path has a caustic, and none is followed for one.
#include <catch2/catch.hpp>

#include "support/render.h"

namespace no_caustics_tests {

using namespace lucerna;

namespace {

struct Result {
  film::Image image;
  uint64_t rays = 0;
};

Result render(session::Renderer& r, const char* caustic) {
  test::set(r, {{"components.caustic", caustic}});
  r.restart();
  Result result{.image = test::finish(r)};
  result.rays = r.stats().rays;
  return result;
}

}  // namespace

TEST_CASE("caustics cost nothing where all surfaces are diffuse; an edit brings them back") {
  session::Renderer r(test::renderer_options(true));
  r.set_size(32, 18);
  // Its only light, the sun, is met by no ray: behind a lookup of other light paths go on for caustics alone.
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/hall/hall.gltf");
  test::set(r, {{"components.secondary", "cache"}, {"components.tertiary", "cache"}, {"samples", "4"}});
  const Result off = render(r, "off"), by_paths = render(r, "path");
  CHECK(by_paths.rays == off.rays);
  CHECK(test::identical(by_paths.image, off.image));
  CHECK(r.enabled_components() == 15);

  scene::Scene polished = *r.scene();
  for (scene::Material& m : polished.materials) m.specular = 1, m.roughness = 0.3f;
  r.set_scene(std::make_shared<scene::Scene>(polished));
  const Result edited = render(r, "path");
  double light = 0;
  for (const vec3& v : edited.image.components[paths::k_caustic]) light += double(luminance(v));
  CHECK(light > 0);
  CHECK(r.device().validation_messages() == 0);
}

}  // namespace no_caustics_tests
