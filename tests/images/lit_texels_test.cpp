// links: session
// Light paths start wherever an emitter's texture is bright, however small that part is.
#include "support/caustics.h"

namespace lit_texels_tests {

using namespace lucerna;
using test::mean_of, test::MeanOf;

namespace {

constexpr float k_side = 2.0f / 64 * 6;  // of the emissive part, in metres

/// A panel of two metres over a mirror that reflects its light up to a ceiling beside it. A square of 6 x 6
/// of its 64 x 64 texels is emissive: by texture, or as a separate quad.
scene::Scene panel(bool textured) {
  scene::Scene s;
  s.name = "panel";
  s.materials = {test::diffuse(vec3(0.8f)), test::diffuse(vec3(0), vec3(100)), {}};
  s.materials[2].metallic = 1, s.materials[2].roughness = 0, s.materials[2].base_color = vec4(0.9f);
  const vec3 corner(-1, 1, -1);
  if (textured) {
    scene::Image image;
    image.name = "square", image.width = image.height = 64;
    for (uint32_t y = 0; y < 64; ++y)
      for (uint32_t x = 0; x < 64; ++x) {
        const float lit = x >= 40 && x < 46 && y >= 9 && y < 15 ? 1.0f : 0.0f;
        image.floats.insert(image.floats.end(), {lit, lit, lit, 1});
      }
    s.images = {image};
    s.textures = {{.image = 0, .wrap_u = scene::Wrap::clamp, .wrap_v = scene::Wrap::clamp, .nearest = true}};
    s.materials[1].emission_texture.texture = 0;
    test::add_quad(s, corner, {2, 0, 0}, {0, 0, 2}, 1);
  } else {
    test::add_quad(s, corner + vec3(40 * k_side / 6, 0, 9 * k_side / 6), {k_side, 0, 0}, {0, 0, k_side}, 1);
  }
  test::add_quad(s, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 2);  // mirror
  test::add_quad(s, {-4, 1.2f, -4}, {8, 0, 0}, {0, 0, 8}, 0);
  s.cameras = {test::looking_down({2.5f, -1, 0}, 1)};
  s.cameras[0].to_world = mat4(vec4(1, 0, 0, 0), vec4(0, 0, 1, 0), vec4(0, -1, 0, 0), vec4(2, -0.5f, 0, 1));
  s.environment.given = true;
  return s;
}

MeanOf caustic(bool textured, const char* solver) {
  const test::Result r = test::render(panel(textured),
                                      {{"components.primary", "off"},
                                       {"components.secondary", "off"},
                                       {"components.tertiary", "off"},
                                       {"components.caustic", solver},
                                       {"photons.efficiency", "false"}},
                                      16, 48, false);
  return mean_of(r.image, 3);
}

}  // namespace

TEST_CASE("a square of few texels emits as much light as a separate quad") {
  for (const char* solver : {"light", "photons"}) {
    INFO(solver);
    const MeanOf truth = caustic(false, solver), found = caustic(true, solver);
    CHECK(truth.value.x > 0);
    CHECK(std::abs(found.value.x - truth.value.x) < 5 * (found.noise.x + truth.noise.x));
    CHECK(found.value.x == Approx(truth.value.x).epsilon(0.15));
  }
}

}  // namespace lit_texels_tests
