// links: film_filter
// The filter for finished pictures, through the real shaders: the noise that it removes, the detail that it
// keeps, and its reported error.
#include "film/filter/filter.h"

#include <bit>
#include <catch2/catch.hpp>

#include "film/filter/filter_error.h"
#include "kernels/film_preview_support.h"

namespace film_filter_tests {

using namespace lucerna;
using test::Sample;

namespace {

struct Filtered {
  film::Image samples, filtered;
  film::FilterError error;
  /// Red of the sum of all components.
  static std::vector<double> red(const film::Image& image) {
    std::vector<double> sum(image.samples.size());
    for (const auto& component : image.components)
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += double(component[i].x);
    return sum;
  }
};

Filtered filter(test::Stage& stage, uint32_t looked_up = 0) {
  film::Filter filter(stage.device, stage.compiler);
  film::Film out(stage.device, stage.width, stage.height);
  filter.apply(stage.stream, stage.film, out, nullptr, looked_up);
  Filtered f{stage.film.read(), out.read(), {}};
  f.error = film::filter_error(f.samples, f.filtered, 16, 0.02);
  return f;
}

using Truth = std::function<double(uint32_t x, uint32_t y)>;

double rms(const film::Image& image, const Truth& truth) {
  const std::vector<double> red = Filtered::red(image);
  double sum = 0;
  for (size_t i = 0; i < red.size(); ++i) {
    const double d = red[i] - truth(uint32_t(i) % image.width, uint32_t(i) / image.width);
    sum += d * d;
  }
  return std::sqrt(sum / double(red.size()));
}

double mean(const film::Image& image) {
  const std::vector<double> red = Filtered::red(image);
  return std::accumulate(red.begin(), red.end(), 0.0) / double(red.size());
}

/// Rare light in large amounts with a mean of 1: variance 3 per sample.
struct Noise {
  std::mt19937 random{7};
  float operator()() {
    std::uniform_real_distribution<float> u(0, 1);
    return u(random) < 0.25f ? 4.0f : 0.0f;
  }
};

/// A random texture: 0.15 to 0.85, another colour every two pixels.
float texture(uint32_t x, uint32_t y) {
  uint32_t h = x / 2 * 73856093u ^ y / 2 * 19349663u;
  h = (h ^ h >> 13) * 1274126177u;
  return 0.15f + 0.7f * float(h >> 8 & 0xffff) / 65535;
}

}  // namespace

TEST_CASE("the filter keeps noise-free pictures and reports no error") {
  test::Stage stage(40, 24);
  const auto light = [](uint32_t x, uint32_t y) {
    return 0.5f + (x > 17 ? 2.0f : 0.0f) + (y == 9 ? 1.0f : 0.0f);
  };
  stage.sample(stage.film, 4, [&](uint32_t x, uint32_t y) {
    const float albedo = texture(x, y);
    return Sample{vec3(albedo * light(x, y)), vec3(albedo)};
  });
  const Filtered f = filter(stage);
  CHECK(rms(f.filtered, [&](uint32_t x, uint32_t y) { return double(texture(x, y) * light(x, y)); }) < 1e-3);
  CHECK(f.error.rms < 2e-3);
  CHECK(f.filtered.samples == f.samples.samples);
}

TEST_CASE("the filter removes most of pure noise, and reports the rest") {
  test::Stage stage(96, 64);
  Noise noise;
  stage.sample(stage.film, 16, [&](uint32_t, uint32_t) { return Sample{vec3(noise())}; });
  const Filtered f = filter(stage);
  const Truth one = [](uint32_t, uint32_t) { return 1.0; };
  const double before = rms(f.samples, one), after = rms(f.filtered, one);
  INFO(before << " -> " << after << ", reported " << f.error.rms);
  CHECK(before == Approx(std::sqrt(3.0 / 16)).epsilon(0.05));
  CHECK(after < before / 8);
  CHECK(f.error.rms > 0.5 * after);
  CHECK(f.error.rms < 2 * after);
  CHECK(mean(f.filtered) == Approx(mean(f.samples)).epsilon(0.01));
  size_t held = 0;
  for (const film::FilteredTile& t : f.error.tiles) held += std::abs(t.luminance - 1) < t.half_width_90();
  CHECK(held >= f.error.tiles.size() * 8 / 10);
}

TEST_CASE("the filter keeps textures and shadows, and its reported error is correct") {
  test::Stage stage(96, 64);
  Noise noise;
  // A hard shadow; at its foot a contact line, two pixels wide; and a texture everywhere.
  const Truth light = [](uint32_t x, uint32_t y) { return x < 40 ? (y == 30 || y == 31 ? 0.1 : 1.0) : 0.2; };
  const Truth seen = [&](uint32_t x, uint32_t y) { return light(x, y) * double(texture(x, y)); };
  stage.sample(stage.film, 64, [&](uint32_t x, uint32_t y) {
    return Sample{vec3(float(seen(x, y)) * noise()), vec3(texture(x, y))};
  });
  const Filtered f = filter(stage);
  const double before = rms(f.samples, seen), after = rms(f.filtered, seen);
  INFO(before << " -> " << after << ", reported " << f.error.rms);
  CHECK(after < before / 3);
  double squares = 0;
  for (const float e : f.error.pixels) squares += double{e} * double{e};
  const double by_pixel = std::sqrt(squares / double(f.error.pixels.size()));
  INFO("by pixel " << by_pixel);
  CHECK(by_pixel > 0.6 * after);
  CHECK(by_pixel < 1.6 * after);
  CHECK(f.error.rms > 0.3 * after);
  CHECK(f.error.rms < 1.6 * after);
  // Light over colour, across the edge and in the line.
  const std::vector<double> red = Filtered::red(f.filtered);
  const auto column = [&](uint32_t x) {
    double sum = 0;
    for (uint32_t y = 0; y < 26; ++y) sum += red[y * 96 + x] / double(texture(x, y)) / 26;
    return sum;
  };
  CHECK(column(38) == Approx(1).margin(0.06));
  CHECK(column(39) == Approx(1).margin(0.08));
  CHECK(column(40) == Approx(0.2).margin(0.04));
  CHECK(column(41) == Approx(0.2).margin(0.04));
  double line = 0;
  for (uint32_t x = 0; x < 36; ++x)
    for (const uint32_t y : {30u, 31u}) line += red[y * 96 + x] / double(texture(x, y)) / 72;
  CHECK(line == Approx(0.1).margin(0.06));
}

TEST_CASE("the filter removes an outlier, and keeps light that both halves have") {
  test::Stage stage(48, 48);
  Noise noise;
  uint32_t fireflies = 0;
  stage.sample(stage.film, 16, [&](uint32_t x, uint32_t y) {
    if (x == 20 && y == 21 && fireflies++ == 0) return Sample{vec3(2000)};
    if (x == 34 && y == 12) return Sample{vec3(50)};
    return Sample{vec3(noise())};
  });
  const Filtered f = filter(stage);
  const std::vector<double> red = Filtered::red(f.filtered);
  CHECK(red[12 * 48 + 34] == Approx(50).epsilon(0.02));
  for (uint32_t y = 17; y < 26; ++y)
    for (uint32_t x = 16; x < 25; ++x) {
      INFO(x << ' ' << y);
      CHECK(red[y * 48 + x] < 1.8);
    }
}

TEST_CASE("the filter removes rare bright samples that lie near each other in both halves by chance") {
  // One sample of 800 is 600 times as bright as the others: one pixel of 50, and pixels of both halves within
  // two pixels of each other at many places. A bright square of 3x3 pixels is light.
  test::Stage stage(128, 96);
  stage.component = 2;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> u(0, 1);
  const auto in_square = [](uint32_t x, uint32_t y) { return x >= 60 && x < 63 && y >= 40 && y < 43; };
  stage.sample(stage.film, 16, [&](uint32_t x, uint32_t y) {
    const float light = in_square(x, y) ? 40.0f : 1.0f;
    return Sample{vec3(light * (0.5f + u(random)) + (u(random) < 1.0f / 800 ? 600.0f : 0.0f))};
  });
  const Filtered f = filter(stage);
  const std::vector<double> red = Filtered::red(f.filtered);
  size_t bright = 0;
  for (uint32_t y = 0; y < 96; ++y)
    for (uint32_t x = 0; x < 128; ++x) {
      const bool near = x >= 52 && x < 71 && y >= 32 && y < 51;
      bright += !near && red[y * 128 + x] > 4;
    }
  CHECK(bright == 0);
  CHECK(red[41 * 128 + 61] > 30);
  // Their light remains, spread: 1 and 600 / 800.
  CHECK(mean(f.filtered) == Approx(mean(f.samples)).epsilon(0.1));
}

TEST_CASE("the filter removes noise from pixels that show two surfaces, unlike all around them") {
  // The edge of a near surface before a far one, oblique, so that pixels show different shares of both.
  test::Stage stage(64, 64);
  Noise noise;
  std::uniform_real_distribution<float> inside(0, 1);
  const auto edge = [](float y) { return 20 + 0.37f * y; };
  stage.sample(stage.film, 16, [&](uint32_t x, uint32_t y) {
    Sample s{vec3(noise())};
    if (float(x) + inside(noise.random) > edge(float(y))) s.depth = 40, s.normal = vec3(1, 0, 0);
    return s;
  });
  const Filtered f = filter(stage);
  const std::vector<double> before = Filtered::red(f.samples), after = Filtered::red(f.filtered);
  double noisy = 0, left = 0;
  for (uint32_t y = 0; y < 64; ++y) {
    const size_t i = y * 64 + size_t(edge(float(y)));
    noisy += std::pow(before[i] - 1, 2) / 64, left += std::pow(after[i] - 1, 2) / 64;
  }
  INFO(std::sqrt(noisy) << " -> " << std::sqrt(left));
  CHECK(left < noisy / 9);
}

TEST_CASE("the filter treats components separately, including one that is off") {
  std::vector<std::vector<vec3>> alone;
  for (const bool both : {false, true}) {
    test::Stage stage(24, 24);
    Noise noise;
    stage.sample(stage.film, 8, [&](uint32_t, uint32_t) { return Sample{vec3(noise())}; });
    if (both) {
      // Samples of another component for the same pixels, without light of the first.
      stage.component = 3;
      stage.sample(stage.film, 8, [&](uint32_t x, uint32_t) { return Sample{vec3(float(x))}; });
    }
    const Filtered f = filter(stage);
    for (const uint32_t c : {0u, 2u})
      for (const vec3& v : f.filtered.components[c]) CHECK(v == vec3(0));
    CHECK(mean(f.filtered) == Approx(mean(f.samples)).epsilon(0.02));
  }
}

TEST_CASE("the filter with one sample, one pixel, no light") {
  SECTION("one sample has no noise estimate") {
    test::Stage stage(20, 20);
    Noise noise;
    stage.sample(stage.film, 1, [&](uint32_t, uint32_t) { return Sample{vec3(noise())}; });
    const Filtered f = filter(stage);
    CHECK(f.filtered.components == f.samples.components);
    for (size_t i = 0; i < 400; ++i) CHECK(f.error.pixels[i] == luminance(f.samples.components[1][i]));
  }
  SECTION("one pixel") {
    test::Stage stage(1, 1);
    stage.sample(stage.film, 2, [&](uint32_t, uint32_t) { return Sample{vec3(0.25f)}; });
    const Filtered f = filter(stage);
    CHECK(f.filtered.components[1][0].x == Approx(0.25f).epsilon(1e-3));
    CHECK(f.error.pixels[0] < 1e-3f);
    CHECK(f.error.tiles.size() == 1);
  }
  SECTION("no light") {
    test::Stage stage(33, 9);
    stage.sample(stage.film, 4, [&](uint32_t, uint32_t) { return Sample{vec3(0)}; });
    const Filtered f = filter(stage);
    for (const auto& component : f.filtered.components)
      for (const vec3& v : component) CHECK(v == vec3(0));
    CHECK(f.error.rms == 0);
    CHECK(f.error.relative() == 0);
    for (const film::FilteredTile& t : f.error.tiles) CHECK(t.standard_error == 0);
  }
  SECTION("no samples") {
    test::Stage stage(9, 9);
    const Filtered f = filter(stage);
    for (const vec3& v : f.filtered.components[1]) CHECK(v == vec3(0));
    CHECK(f.error.rms == 0);
  }
}

TEST_CASE("the filter gives the same bits for the same film, and scales with the light") {
  std::vector<std::vector<vec3>> found;
  for (const float scale : {1.0f, 1.0f, 1024.0f, 1.0f / 65536}) {
    test::Stage stage(40, 40);
    Noise noise;
    stage.sample(stage.film, 8, [&](uint32_t x, uint32_t) {
      // No surface on the right.
      Sample s{vec3(scale * (noise() + (x > 20 ? 3.0f : 0.0f)))};
      if (x > 30) s.depth = 0;
      return s;
    });
    const Filtered f = filter(stage);
    found.push_back(f.filtered.components[1]);
    for (vec3& v : found.back()) v /= scale;
    CHECK(f.error.rms < 0.3 * double{scale});
  }
  // Powers of two scale the whole picture.
  for (size_t k = 1; k < found.size(); ++k) CHECK(found[k] == found[0]);
}

TEST_CASE("the filter does not count noise shared by both halves through records as light") {
  test::Stage stage(64, 48);
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.1f), records(0, 0.15f);
  // A record covers 4x4 pixels.
  std::vector<float> held(16 * 12);
  for (float& h : held) h = records(random);
  stage.sample(stage.film, 16, [&](uint32_t x, uint32_t y) {
    return Sample{vec3(1 + held[y / 4 * 16 + x / 4] + noise(random))};
  });
  const Truth light = [](uint32_t, uint32_t) { return 1.0; };
  const double before = rms(stage.film.read(), light), unknown = rms(filter(stage, 2).filtered, light);
  CHECK(unknown > 0.6 * before);
  stage.film.make_room_for_lookup_errors();
  gpu::Resources resources;
  stage.film.bind(resources);
  const gpu::Buffer& squares = *std::get<const gpu::Buffer*>(*resources.find("FilmLookups"));
  stage.stream.fill(squares, std::bit_cast<uint32_t>(0.15f * 0.15f));
  stage.stream.run();
  stage.film.complete_lookup_errors();
  const double known = rms(filter(stage, 2).filtered, light);
  INFO(before << ", unknown " << unknown << ", known " << known);
  CHECK(known < 0.8 * unknown);
  // Another component looks them up, or none does.
  CHECK(rms(filter(stage, 1).filtered, light) == unknown);
}

TEST_CASE("the filter fades as samples grow") {
  double share[2];
  const Truth light = [](uint32_t x, uint32_t y) { return 1 + 0.5 * std::sin(0.9 * x) * std::sin(0.7 * y); };
  for (const uint32_t many : {0u, 1u}) {
    test::Stage stage(48, 48);
    std::mt19937 random(3);
    // 4 samples each, with the noise of 4 samples or of the mean of 4096.
    std::normal_distribution<float> noise(0, many ? 0.5f / 32 : 0.5f);
    stage.sample(stage.film, 4, [&](uint32_t x, uint32_t y) {
      return Sample{vec3(float(light(x, y)) * std::max(0.0f, 1 + noise(random)))};
    });
    const Filtered f = filter(stage);
    share[many] = rms(f.filtered, light) / rms(f.samples, light);
    INFO(share[many]);
    CHECK(share[many] < 1.35);
  }
  CHECK(share[0] < 0.8);
}

TEST_CASE("the error of a filtered picture includes a known bias") {
  std::mt19937 random(11);
  std::normal_distribution<float> noise(0, 0.2f);
  film::Image samples, filtered;
  samples.width = 80, samples.height = 64;
  const size_t n = 80 * 64;
  samples.samples.assign(n, 16);
  for (size_t c = 0; c < 4; ++c) samples.components[c].resize(n), samples.odd_half[c].resize(n);
  filtered = samples;
  for (size_t i = 0; i < n; ++i) {
    const float even = 1 + noise(random), odd = 1 + noise(random);
    samples.components[0][i] = vec3((even + odd) / 2), samples.odd_half[0][i] = vec3(odd);
    // Half of the picture is wrong by 0.1, without any noise.
    const float wrong = i % 80 < 40 ? 1.1f : 1.0f;
    filtered.components[0][i] = filtered.odd_half[0][i] = vec3(wrong);
  }
  const film::FilterError error = film::filter_error(samples, filtered, 16, 0.02);
  REQUIRE(error.tiles_across == 5);
  double left = 0, right = 0;
  for (size_t i = 0; i < n; ++i) {
    if (i % 80 < 28) left += std::pow(double{error.pixels[i]}, 2) / (28 * 64);
    if (i % 80 >= 52) right += std::pow(double{error.pixels[i]}, 2) / (28 * 64);
  }
  CHECK(std::sqrt(left) == Approx(0.1).epsilon(0.25));
  CHECK(std::sqrt(right) < 0.05);
  CHECK(error.tiles[0].standard_error == Approx(0.1).epsilon(0.3));
  CHECK(error.tiles[4].standard_error < 0.06);
  CHECK(error.luminance == Approx(1.05));
}

}  // namespace film_filter_tests
