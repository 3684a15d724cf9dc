// links: film film_io
// The window's preview in pixels whose samples hit several surfaces or materials, through the real shaders.
#include <algorithm>

#include "kernels/film_preview_support.h"

namespace film_preview_edges_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

/// Share of a pixel that the nearer of two surfaces covers, left of a slanted border.
float covered(uint32_t x, uint32_t y) { return std::clamp(20.5f + 0.3f * float(y) - float(x), 0.0f, 1.0f); }

struct Border {
  double edge;       ///< rms relative error of mixed pixels
  double beside;     ///< mean of the nearer surface's pixels next to the border
  double brightest;  ///< of pixels of the nearer surface only
};

/// Light `near`, found by one in four paths, in front of noise-free `far`.
Border border_of(Stage& stage, float near, float far) {
  const std::vector<float> shown = stage.shown();
  double square = 0, mixed = 0, sum = 0, count = 0, brightest = 0;
  for (uint32_t y = 2; y + 2 < stage.height; ++y)
    for (uint32_t x = 2; x + 2 < stage.width; ++x) {
      const float share = covered(x, y), truth = share * near + (1 - share) * far,
                  value = shown[y * stage.width + x];
      if (share > 0 && share < 1) {
        square += (value / truth - 1) * (value / truth - 1), mixed += 1;
      } else if (share == 1) {
        brightest = std::max(brightest, double(value));
        if (covered(x + 2, y) < 1) sum += value, count += 1;
      }
    }
  return {std::sqrt(square / mixed), sum / count, brightest};
}

constexpr float k_near = 0.15f, k_far = 0.9f;
constexpr uint32_t k_samples = 12;
// The standard deviation of twelve samples' shares of two lights, sqrt(s (1 - s) / 12) for occurring shares
// s, times 0.75, over the mean.
constexpr double k_edge_error = 0.3;

/// Adds samples of the nearer surface, by its share, and of the other.
void sample_border(Stage& stage, const Sample& near, const Sample& far) {
  std::mt19937 random(12);
  std::uniform_real_distribution<float> any(0, 1);
  stage.sample(stage.film, k_samples, [&](uint32_t x, uint32_t y) {
    if (any(random) >= covered(x, y)) return far;
    Sample s = near;
    s.light *= any(random) < 0.25f ? 4.0f : 0.0f;
    return s;
  });
}

/// Mixed pixels show both surfaces by their shares, neighbouring pixels the nearer one only.
void check_border(Stage& stage) {
  const Border shown = border_of(stage, k_near, k_far);
  INFO("edge " << shown.edge << ", beside it " << shown.beside);
  CHECK(shown.edge < k_edge_error);
  CHECK(shown.beside < 1.25 * k_near);
}

}  // namespace

TEST_CASE("in front of a bright background a pixel shows each part by its share of samples") {
  Stage stage(64, 48);
  sample_border(stage, {.light = vec3(k_near)}, {.light = vec3(k_far), .depth = 0});
  stage.show();
  check_border(stage);
}

TEST_CASE("in front of another surface a pixel shows each part by its share of depths") {
  Stage stage(64, 48);
  sample_border(stage, {.light = vec3(k_near), .depth = 2}, {.light = vec3(k_far), .depth = 9});
  const gpu::Buffer surfaces = surfaces_of(
      stage, [](uint32_t x, uint32_t y) { return Seen{.depth = covered(x, y) > 0.5f ? 2.0f : 9.0f}; });
  show_seen(stage, surfaces);
  check_border(stage);
}

TEST_CASE("a frame beside a lamp in its plane shows its own light") {
  Stage stage(64, 48);
  stage.component = 0;
  const float far = 20 * k_far;
  sample_border(stage, {.light = vec3(k_near)}, {.light = vec3(far)});
  const gpu::Buffer surfaces =
      surfaces_of(stage, [](uint32_t x, uint32_t y) { return Seen{.emits = covered(x, y) <= 0.5f}; });
  show_seen(stage, surfaces);
  const Border shown = border_of(stage, k_near, far);
  INFO("beside it " << shown.beside << ", brightest " << shown.brightest);
  CHECK(shown.brightest < 3 * k_near);
  CHECK(shown.beside < 1.25 * k_near);
}

TEST_CASE("a dark mat on a table that mirrors a window does not glow") {
  // The table's light is a reflection: over its albedo it is far more than the light on the mat.
  Stage stage(96, 64);
  std::mt19937 random(3);
  const auto mat = [](uint32_t x, uint32_t y) { return x >= 30 && x < 66 && y >= 20 && y < 44; };
  stage.sample(stage.film, 2, [&](uint32_t x, uint32_t y) {
    const float found = random() % 3 == 0 ? 3 : 0;
    return mat(x, y) ? Sample{.light = vec3(0.01f * found), .albedo = vec3(0.05f)}
                     : Sample{.light = vec3(0.8f * found), .albedo = vec3(0.5f)};
  });
  stage.show();
  const std::vector<float> shown = stage.shown();
  double sum = 0, count = 0;
  for (uint32_t y = 20; y < 44; ++y)
    for (uint32_t x = 30; x < 66; ++x) sum += shown[y * 96 + x], count += 1;
  INFO("light of the mat: " << sum / count);
  CHECK(sum / count < 0.015);
  CHECK(sum / count > 0.006);
}

TEST_CASE("a floor's pattern does not show in its reflections, but in its diffuse light") {
  // Planks of two colours; the light is independent of them, half dependent, or proportional.
  Stage stage(96, 64);
  std::mt19937 random(7);
  const float share = GENERATE(0.0f, 0.5f, 1.0f);
  const auto albedo = [](uint32_t x) { return x / 5 % 2 ? 0.6f : 0.2f; };
  const auto light = [&](uint32_t x) { return 0.4f * (1 - share + share * albedo(x) / 0.4f); };
  stage.sample(stage.film, 4, [&](uint32_t x, uint32_t) {
    return Sample{.light = vec3(random() % 4 == 0 ? 4 * light(x) : 0), .albedo = vec3(albedo(x))};
  });
  stage.show();
  const double off = rms(
      stage.shown(), [&](uint32_t x, uint32_t) { return light(x); }, 96);
  INFO("share " << share << ", relative error " << off);
  CHECK(off < 0.15);
}

TEST_CASE("an image in a mirror has the borders of the reflected objects") {
  // Samples hit the mirror; behind it, virtually, are two surfaces of different light.
  Stage stage(96, 64);
  std::mt19937 random(21);
  const auto light = [](uint32_t x) { return x < 41 ? 0.1f : 0.7f; };
  stage.sample(stage.film, 4, [&](uint32_t x, uint32_t) {
    return Sample{.light = vec3(random() % 3 == 0 ? 3 * light(x) : 0)};
  });
  const auto error = [&](bool beyond) {
    const gpu::Buffer surfaces = surfaces_of(stage, [&](uint32_t x, uint32_t) {
      return beyond ? Seen{.depth = x < 41 ? 8.0f : 12.0f, .beyond = true} : Seen{};
    });
    stage.preview.forget();
    show_seen(stage, surfaces);
    return rms(
        stage.shown(), [&](uint32_t x, uint32_t) { return light(x); }, 96);
  };
  const double without = error(false), with = error(true);
  INFO("relative error " << without << ", with the mirror's image " << with);
  CHECK(without > 0.3);
  CHECK(with < 0.15);
}

TEST_CASE("one bright path among many, or two among few, show no speck") {
  Stage stage(96, 64);
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 1);
  const bool few = GENERATE(true, false);
  const uint32_t samples = few ? 6 : 24;
  // In every 16th column and row: a path of one half, or one of each.
  std::vector<uint32_t> added(size_t{96} * 64, 0);
  stage.sample(stage.film, samples, [&](uint32_t x, uint32_t y) {
    float light = std::max(0.0f, 0.2f + 0.12f * noise(random));
    if (x % 16 == 9 && y % 16 == 9 && x < 96 && y < 64 && ++added[y * 96 + x] <= (few ? 2u : 1u)) light += 6;
    return Sample{.light = vec3(light)};
  });
  stage.show();
  const std::vector<float> shown = stage.shown();
  for (uint32_t y = 9; y < 64; y += 16)
    for (uint32_t x = 9; x < 96; x += 16) {
      INFO(samples << " samples, pixel " << x << " " << y);
      CHECK(shown[y * 96 + x] < 0.4f);
    }
}

}  // namespace film_preview_edges_tests
