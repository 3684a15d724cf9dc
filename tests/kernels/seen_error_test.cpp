// links: film
// The error as seen (shaders/shared/seen_error.h) of pictures with known halves, through the real shader.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "film/error.h"
#include "film/estimator.h"
#include "shaders/shared/tone.h"

namespace seen_error_tests {

using namespace lucerna;

namespace {

/// Luminance of a component in the two halves.
struct Halves {
  float even = 0, odd = 0;
};
using Pixel = std::array<Halves, 4>;

/// Light of the first component only.
Pixel grey(float even, float odd) { return {Halves{even, odd}}; }

uint32_t compact(uint32_t x) { return (x & 1u) | (x >> 1 & 2u) | (x >> 2 & 4u); }

class Bench {
 public:
  struct Errors {
    film::ImageError image;
    std::vector<film::TileError> tiles;  ///< of 16x16 pixels
  };

  /// `samples`: per pixel, 0, 1 or 2.
  template <class F>
  Errors estimate(uint32_t width, uint32_t height, const film::SeenRange& range, const F& pixel,
                  uint32_t samples = 2) {
    film::Film film(device_, width, height);
    film.clear(stream_);
    const uint32_t blocks = film.blocks();
    std::vector<vec4> values(size_t{blocks} * 64 * 2 * 4);
    std::vector<shared::WorkBlock> list;
    for (uint32_t b = 0; b < blocks; ++b) {
      list.push_back({b, 0});
      for (uint32_t code = 0; code < 64; ++code) {
        const uint32_t x = b % film.blocks_across() * 8 + compact(code),
                       y = b / film.blocks_across() * 8 + compact(code >> 1);
        if (x >= width || y >= height) continue;
        const Pixel p = pixel(x, y);
        for (uint32_t c = 0; c < 4; ++c)
          for (uint32_t s = 0; s < samples; ++s)
            values[((size_t{s} * blocks + b) * 64 + code) * 4 + c] =
                vec4(vec3(s == 0 ? p[c].even : p[c].odd), 0);
      }
    }
    gpu::Buffer radiance(device_, {.name = "radiance", .bytes = values.size() * 16, .texel = true});
    gpu::Buffer features(device_, {.name = "features", .bytes = values.size() * 8, .texel = true});
    gpu::Buffer work(device_, {.name = "work blocks", .bytes = list.size() * sizeof(shared::WorkBlock)});
    radiance.write(std::span<const vec4>(values));
    work.write(std::span<const shared::WorkBlock>(list));
    stream_.fill(features, 0);
    gpu::Resources resources;
    film.bind(resources);
    resources.set("WorkBlocks", work);
    resources.set("radiance_texels", radiance);
    resources.set("feature_texels", features);
    if (samples > 0)
      stream_.dispatch(add_, resources, shared::FilmPush{width, height, 64 * blocks, samples, 0, 0}, blocks);
    estimator_.estimate(stream_, film, range);
    stream_.run();
    return {film::image_error(film.errors()), film::tile_errors(film, 16)};
  }

  size_t complaints() const { return device_.validation_messages(); }

 private:
  gpu::Device device_{{"cpu", true}};
  gpu::ShaderCompiler compiler_;
  gpu::Stream stream_{device_};
  gpu::Kernel add_{device_, compiler_, "film/add.comp"};
  film::ErrorEstimator estimator_{device_, compiler_, false};
};

constexpr film::SeenRange k_linear{0.02f, 1};

float sign(uint32_t x, uint32_t y) { return (x + y) % 2 ? 1.0f : -1.0f; }

}  // namespace

TEST_CASE("Constant noise: the error as seen is its relative size, for picture and tiles") {
  Bench bench;
  const auto e = bench.estimate(32, 16, k_linear, [](uint32_t x, uint32_t y) {
    return grey(0.5f + 0.05f * sign(x, y), 0.5f - 0.05f * sign(x, y));
  });
  CHECK(e.image.seen(0) == Approx(0.1));
  CHECK(e.image.seen_sum() == Approx(0.1));
  CHECK(e.image.relative(0) == Approx(0.1));
  CHECK(e.image.seen_degrees == Approx(3 * 512));
  CHECK(e.image.share(0) == 1);
  for (const film::TileError& tile : e.tiles) CHECK(tile.relative == Approx(0.1 * 1.2533));
  // An exposure that gives the same displayed picture changes nothing.
  const auto brighter = bench.estimate(
      32, 16, film::seen_range(-3, shared::k_tone_linear),
      [](uint32_t x, uint32_t y) { return grey(4 + 0.4f * sign(x, y), 4 - 0.4f * sign(x, y)); });
  CHECK(brighter.image.seen(0) == Approx(0.1));
  CHECK(brighter.tiles[0].relative == Approx(e.tiles[0].relative));
  CHECK(bench.complaints() == 0);
}

TEST_CASE("A bright window over 5 % of the picture dominates the error of the mean, not the error as seen") {
  Bench bench;
  // Walls have a 10 % error in tertiary light; the window, four by eight of 640 pixels, has a 50 % error in
  // primary light. The scale of a pixel is the mean of the surrounding 5x5.
  const auto in_window = [](int x, int y) { return x >= 8 && x < 12 && y >= 8 && y < 16; };
  const auto squares = [&](double window, bool of_window, double off) {
    double sum = 0;
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 32; ++x) {
        if (in_window(x, y) != of_window) continue;
        double light = 0, count = 0;
        for (int v = std::max(0, y - 2); v <= std::min(19, y + 2); ++v)
          for (int u = std::max(0, x - 2); u <= std::min(31, x + 2); ++u)
            light += in_window(u, v) ? window : 0.2, ++count;
        sum += std::pow(off / std::max(light / count, (of_window ? window : 0.2) / 4), 2);
      }
    return sum / 640;
  };
  const auto room = [&](uint32_t x, uint32_t y) {
    Pixel p{};
    const float d = sign(x, y);
    if (in_window(int(x), int(y)))
      p[0] = {20 + 10 * d, 20 - 10 * d};
    else
      p[2] = {0.2f + 0.02f * d, 0.2f - 0.02f * d};
    return p;
  };
  const auto e = bench.estimate(32, 20, k_linear, room).image;
  CHECK(e.white == Approx(0.05));
  CHECK(e.relative(1) > 30 * e.relative(3));
  // On the display the window is white in both halves.
  CHECK(e.seen(1) == 0);
  CHECK(std::pow(e.seen(3), 2) == Approx(squares(1, false, 0.02)));
  CHECK(e.seen(3) > 0.08);
  CHECK(e.seen(0) == Approx(e.seen(3)));
  CHECK(e.share(2) == 1);
  // A lower exposure shows it: each pixel relative to its own surroundings.
  const auto dim = bench.estimate(32, 20, {0.02f, 1000}, room).image;
  CHECK(dim.white == 0);
  CHECK(std::pow(dim.seen(1), 2) == Approx(squares(20, true, 10)));
  CHECK(std::pow(dim.seen(3), 2) == Approx(squares(20, false, 0.02)));
  CHECK(dim.share(0) + dim.share(2) == Approx(1));
  CHECK(dim.seen(0) == Approx(std::hypot(dim.seen(1), dim.seen(3))));
}

TEST_CASE("A clipped value counts by the part below white") {
  Bench bench;
  const auto one = [](float even, float odd) {
    return [=](uint32_t x, uint32_t y) { return x + y == 0 ? grey(even, odd) : grey(0.2f, 0.2f); };
  };
  const auto seen = [&](float even, float odd) {
    return std::sqrt(64) * bench.estimate(8, 8, k_linear, one(even, odd)).image.seen(0);
  };
  // A lamp: both halves are white.
  CHECK(seen(100, 50) == 0);
  CHECK(seen(1, 3) == 0);
  // The pixel is white and its darker half is not; around it are 3x3 pixels.
  CHECK(seen(3, 0.5f) == Approx(0.5 / ((1 + 8 * 0.2) / 9)));
  CHECK(seen(1e6f, 0.5f) == Approx(0.5 / ((1 + 8 * 0.2) / 9)));
  // One half is white and the pixel is not.
  CHECK(seen(1.2f, 0.4f) == Approx(0.4 / ((0.8 + 8 * 0.2) / 9)));
}

TEST_CASE("A firefly counts at most the bound, and does not hold its tile") {
  Bench bench;
  const auto e = bench.estimate(16, 16, {0.02f, 1e9f}, [](uint32_t x, uint32_t y) {
    return x + y == 0 ? grey(0, 1e5f) : grey(0.1f, 0.1f);
  });
  CHECK(16 * e.image.seen(0) == Approx(double{shared::k_seen_most}));
  CHECK(e.image.seen_degrees == Approx(3));
  CHECK(e.tiles.at(0).relative < 0.03);
}

TEST_CASE("A dark picture is compared with the floor, a black one has no error") {
  Bench bench;
  const auto dark = bench.estimate(16, 16, k_linear, [](uint32_t x, uint32_t y) {
    return grey(0.001f + 0.0005f * sign(x, y), 0.001f - 0.0005f * sign(x, y));
  });
  CHECK(dark.image.seen(0) == Approx(0.0005 / 0.02));
  CHECK(dark.image.relative(0) == Approx(0.5));
  CHECK(dark.image.dark == 1);
  const auto black = bench.estimate(16, 16, k_linear, [](uint32_t, uint32_t) { return Pixel{}; });
  CHECK(black.image.seen(0) == 0);
  CHECK(black.image.seen_sum() == 0);
  CHECK(black.image.pixels == 256);
  for (int c = 0; c < 4; ++c) CHECK(black.image.share(c) == 0);
}

TEST_CASE("Pictures of one pixel, of one sample, of none") {
  Bench bench;
  const auto half = [](uint32_t, uint32_t) { return grey(0.3f, 0.5f); };
  CHECK(bench.estimate(1, 1, k_linear, half).image.seen(0) == Approx(0.25));
  CHECK(bench.estimate(1, 1, k_linear, half).image.pixels == 1);
  for (const uint32_t samples : {0u, 1u}) {
    const auto none = bench.estimate(5, 3, k_linear, half, samples);
    CHECK(none.image.pixels == 0);
    CHECK(none.image.seen_sum() == 0);
    CHECK(none.tiles.at(0).relative == 0);
  }
  CHECK(film::image_error({}).seen_sum() == 0);
  CHECK(film::image_error({}).share(0) == 0);
}

TEST_CASE("Components' shares sum to the whole, and independent ones' squares to the sum's square") {
  Bench bench;
  std::mt19937 random(11);
  std::normal_distribution<float> normal;
  // Noise of .02, .04, 0 and .01 on .1, .2, 0 and .2; the third component is off.
  const auto e = bench.estimate(96, 64, k_linear, [&](uint32_t, uint32_t) {
    Pixel p{};
    const float noise[4] = {0.02f, 0.04f, 0, 0.01f}, mean[4] = {0.1f, 0.2f, 0, 0.2f};
    for (int c = 0; c < 4; ++c)
      p[c] = {mean[c] + noise[c] * normal(random), mean[c] + noise[c] * normal(random)};
    return p;
  });
  const film::ImageError& i = e.image;
  CHECK(i.seen(3) == 0);
  CHECK(i.share(2) == 0);
  CHECK(i.share(0) + i.share(1) + i.share(2) + i.share(3) == Approx(1));
  // The halves have that noise, so the pixel's is divided by sqrt(2); 6144 pixels: 3.3 sigma are 6 % of a
  // square.
  const double scale = 2 * 0.25;
  CHECK(std::pow(i.seen(1), 2) == Approx(0.0004 / scale).epsilon(0.06));
  CHECK(std::pow(i.seen(2), 2) == Approx(0.0016 / scale).epsilon(0.06));
  CHECK(std::pow(i.seen(4), 2) == Approx(0.0001 / scale).epsilon(0.06));
  CHECK(std::pow(i.seen(0), 2) == Approx(0.0021 / scale).epsilon(0.06));
  // Errors that cancel in the sum remain in the components.
  const auto cancel = bench.estimate(8, 8, k_linear, [](uint32_t, uint32_t) {
    return Pixel{Halves{0.3f, 0.1f}, Halves{0.1f, 0.3f}};
  });
  CHECK(cancel.image.seen(0) == Approx(0).margin(1e-6));
  CHECK(cancel.image.seen(1) == Approx(0.25));
  CHECK(cancel.image.share(0) == Approx(0.5));
}

TEST_CASE("Above its white a tone curve shows at most a tenth of a relative change") {
  const auto shown = [](double y, uint32_t curve) {
    const float encoded = shared::tone_map(vec3(float(y)), curve).y;
    return encoded <= 0.04045f ? double(encoded) / 12.92 : std::pow((double(encoded) + 0.055) / 1.055, 2.4);
  };
  for (const uint32_t curve : {shared::k_tone_neutral, shared::k_tone_agx, shared::k_tone_linear}) {
    const double white = double(shared::tone_white(curve));
    INFO("curve " << curve << ", white " << white);
    const auto slope = [&](double y) {
      return std::log(shown(1.02 * y, curve) / shown(y, curve)) / std::log(1.02);
    };
    CHECK(slope(white) < 0.125);
    CHECK(slope(2 * white) < 0.125);
    CHECK(slope(0.5 * white) > 0.13);
  }
  const film::SeenRange range = film::seen_range(2, shared::k_tone_linear);
  CHECK(range.floor == 0.005f);
  CHECK(range.white == 0.25f);
}

}  // namespace seen_error_tests
