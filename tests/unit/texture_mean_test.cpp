// links: upload
// Means of emission textures over triangles: above 0 wherever a lookup can find light, and accurate.
#include "upload/texture_mean.h"

#include <catch2/catch.hpp>
#include <random>

#include "upload/textures.h"

namespace texture_mean_tests {

using namespace lucerna;

namespace {

scene::Scene textured(uint32_t width, uint32_t height, scene::Wrap u, scene::Wrap v) {
  scene::Scene s;
  scene::Image image;
  image.name = "light", image.width = width, image.height = height;
  image.floats.assign(4 * size_t{width} * height, 0.0f);
  s.images = {image};
  s.textures = {{.image = 0, .wrap_u = u, .wrap_v = v}};
  return s;
}

void light_texel(scene::Scene& s, uint32_t x, uint32_t y, float value) {
  scene::Image image = s.images[0];
  for (int k = 0; k < 3; ++k) image.floats[4 * (size_t{y} * image.width + x) + size_t(k)] = value;
  s.images = {image};
}

}  // namespace

TEST_CASE("one bright texel counts wherever a triangle can read it, for every wrap mode") {
  std::mt19937 random(5);
  const auto uniform = [&](float lo, float hi) { return lo + (hi - lo) * float(random() >> 8) * 0x1p-24f; };
  scene::TextureUse use;
  use.texture = 0, use.m = {1.5f, 0.2f, -0.3f, -0.1f, 0.8f, 0.4f};
  size_t found = 0;
  for (const scene::Wrap u : {scene::Wrap::repeat, scene::Wrap::clamp, scene::Wrap::mirror})
    for (const scene::Wrap v : {scene::Wrap::repeat, scene::Wrap::clamp, scene::Wrap::mirror})
      for (int i = 0; i < 60; ++i) {
        scene::Scene s = textured(13, 7, u, v);
        light_texel(s, uint32_t(random() % 13), uint32_t(random() % 7), 1e-3f);
        upload::TextureMeans means(s);
        const float size = i % 2 == 0 ? 0.2f : 2.5f;
        const vec2 at(uniform(-2, 2), uniform(-2, 2));
        std::array<vec2, 3> p;
        for (vec2& corner : p) corner = at + vec2(uniform(0, size), uniform(0, size));
        const double mean = means.over(use, p);
        // Random lookups, at each of the four texels of a bilinear one.
        double read = 0;
        for (int k = 0; k < 300; ++k) {
          float a = uniform(0, 1), b = uniform(0, 1);
          if (a + b > 1) a = 1 - a, b = 1 - b;
          const vec2 uv = (1 - a - b) * p[0] + a * p[1] + b * p[2];
          for (const vec2 corner :
               {vec2(-0.4999f), vec2(0.4999f, -0.4999f), vec2(-0.4999f, 0.4999f), vec2(0.4999f)}) {
            scene::TextureUse beside = use;
            beside.m[2] += corner.x / 13, beside.m[5] += corner.y / 7;
            read += double(luminance(upload::read_texture(s, beside, uv)));
          }
        }
        found += read > 0;
        if (read > 0) REQUIRE(mean > 0);
      }
  CHECK(found > 100);
}

TEST_CASE("the mean over a large triangle is that of its texels") {
  scene::Scene s = textured(64, 64, scene::Wrap::repeat, scene::Wrap::repeat);
  scene::Image image = s.images[0];
  for (uint32_t y = 0; y < 64; ++y)
    for (uint32_t x = 0; x < 64; ++x)
      for (uint32_t k = 0; k < 3; ++k) image.floats[4 * (64 * size_t{y} + x) + k] = x < 32 ? 3.0f : 1.0f;
  s.images = {image};
  upload::TextureMeans means(s);
  scene::TextureUse use;
  use.texture = 0;
  // Three quarters of its area lie in the left half.
  CHECK(means.over(use, {vec2(0, 0), vec2(1, 0), vec2(0, 1)}) == Approx(2.5).epsilon(0.05));
  CHECK(means.over(use, {vec2(0, 0), vec2(300, 0), vec2(0, 300)}) == Approx(2));
  CHECK(means.over(use, {vec2(0.1f), vec2(0.1f), vec2(0.1f)}) == Approx(3));
  CHECK(means.over(use, {vec2(0), vec2(NAN), vec2(1)}) == Approx(2));
  CHECK(means.over({}, {vec2(0), vec2(1, 0), vec2(1)}) == 1);
}

}  // namespace texture_mean_tests
