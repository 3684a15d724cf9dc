// links: film
// What the error kernel says of a film, against the same sums taken here in double precision; and what is
// made of it.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "film/error.h"

using namespace lucerna;
using shared::BlockError;

namespace {

/// Samples with a heavy tail; dark towards the right, so that the floor matters.
float sample_value(std::mt19937& random, uint32_t x) {
  std::exponential_distribution<float> tail(1.0f);
  const float t = tail(random);
  return (x > 15 ? 1e-3f : 0.3f) * t * t;
}

uint32_t compact(uint32_t x) { return (x & 1u) | (x >> 1 & 2u) | (x >> 2 & 4u); }

}  // namespace

TEST_CASE("the error kernel: sums over the blocks of an item, to float's precision") {
  gpu::Device device({"cpu", true});
  gpu::ShaderCompiler compiler;
  gpu::Stream stream(device);
  constexpr uint32_t k_width = 20, k_height = 12, k_samples = 6;  // blocks that stick out on two sides
  constexpr float k_floor = 0.05f;
  film::Film film(device, k_width, k_height);
  film.clear(stream);
  const uint32_t blocks = film.blocks();
  REQUIRE(blocks == 6);
  const gpu::Kernel add(device, compiler, "film/add.comp"), error(device, compiler, "film/error.comp"),
      stopping(device, compiler, "film/error.comp", {{"LUCERNA_STOPPING_ONLY", "1"}});
  std::mt19937 random(1);
  std::vector<vec4> values(size_t(blocks) * 64 * k_samples * 4);
  std::vector<shared::WorkBlock> list;
  for (uint32_t b = 0; b < blocks; ++b) list.push_back({blocks - 1 - b, 0});  // in an order of their own
  // Sums of the two halves of every pixel and component, red, green and blue alike but for their size.
  std::vector<double> half(size_t(k_width) * k_height * 4 * 2);
  for (uint32_t s = 0; s < k_samples; ++s)
    for (uint32_t b = 0; b < blocks; ++b)
      for (uint32_t code = 0; code < 64; ++code) {
        const uint32_t x = list[b].index % 3 * 8 + compact(code),
                       y = list[b].index / 3 * 8 + compact(code >> 1);
        for (uint32_t c = 0; c < 4; ++c) {
          const float v = sample_value(random, x);
          values[((size_t(s) * blocks + b) * 64 + code) * 4 + c] = vec4(v, 2 * v, 0.5f * v, 0);
          if (x < k_width && y < k_height)
            half[((size_t(y) * k_width + x) * 4 + c) * 2 + s % 2] += luminance(vec3(v, 2 * v, 0.5f * v));
        }
      }
  gpu::Buffer radiance(device, {.name = "radiance", .bytes = values.size() * sizeof(vec4), .texel = true});
  gpu::Buffer features(device, {.name = "features", .bytes = values.size() * 8, .texel = true});
  gpu::Buffer work(device, {.name = "work blocks", .bytes = list.size() * sizeof(shared::WorkBlock)});
  radiance.write(std::span<const vec4>(values));
  work.write(std::span<const shared::WorkBlock>(list));
  stream.fill(features, 0);
  gpu::Resources resources;
  film.bind(resources);
  resources.set("WorkBlocks", work);
  resources.set("radiance_texels", radiance);
  resources.set("feature_texels", features);
  const shared::FilmPush added{k_width, k_height, 64 * blocks, k_samples};
  stream.dispatch(add, resources, added, blocks);
  // The last block of the list is left out: its figures stay as they were.
  stream.dispatch(error, resources, shared::ErrorPush{k_width, k_height, blocks - 1, k_floor},
                  (blocks + 7) / 8);
  stream.run();

  const auto close = [](double a, double b) { return std::abs(a - b) <= 2e-6 * std::abs(b) + 1e-12; };
  for (uint32_t b = 0; b < blocks; ++b) {
    INFO("block " << b);
    const BlockError& got = film.errors()[b];
    if (b == list.back().index) {
      CHECK(got.pixels == 0);
      continue;
    }
    double pixels = 0, luminance[5] = {}, variance[5] = {}, fourth = 0, quadrant_y[4] = {},
           quadrant_n[4] = {};
    for (const bool second : {false, true}) {
      double relative[4] = {};
      for (uint32_t code = 0; code < 64; ++code) {
        const uint32_t x = b % 3 * 8 + compact(code), y = b / 3 * 8 + compact(code >> 1), q = code / 16;
        if (x >= k_width || y >= k_height) continue;
        double a0 = 0, b0 = 0;
        for (uint32_t c = 0; c < 4; ++c) {
          const double* h = &half[((size_t(y) * k_width + x) * 4 + c) * 2];
          const double va = h[0] / (k_samples / 2), vb = h[1] / (k_samples / 2);
          a0 += va, b0 += vb;
          if (!second) luminance[c + 1] += (va + vb) / 2, variance[c + 1] += (va - vb) * (va - vb) / 4;
        }
        const double y0 = (a0 + b0) / 2, v0 = (a0 - b0) * (a0 - b0) / 4;
        if (!second) {
          ++pixels, ++quadrant_n[q];
          luminance[0] += y0, variance[0] += v0, fourth += v0 * v0, quadrant_y[q] += y0;
        } else {
          const double scale = std::max({y0, quadrant_y[q] / quadrant_n[q], double{k_floor}});
          relative[q] += std::sqrt(1.5707963267948966 * v0) / scale;
        }
      }
      if (!second) continue;
      CHECK(got.pixels == pixels);
      for (int k = 0; k < 5; ++k) {
        CHECK(close(got.luminance[k], luminance[k]));
        CHECK(close(got.variance[k], variance[k]));
      }
      CHECK(close(got.fourth, fourth));
      for (int q = 0; q < 4; ++q) {
        CHECK(got.quadrant_pixels[q] == quadrant_n[q]);
        CHECK(close(got.relative[q], relative[q]));
      }
    }
  }
  // What stops a tile, alone: the same to the last bit, and nothing else is touched.
  const std::vector<BlockError> full(film.errors().begin(), film.errors().end());
  film.clear(stream);
  stream.dispatch(add, resources, added, blocks);
  stream.dispatch(stopping, resources, shared::ErrorPush{k_width, k_height, blocks - 1, k_floor},
                  (blocks + 7) / 8);
  stream.run();
  for (uint32_t b = 0; b < blocks; ++b) {
    for (int q = 0; q < 4; ++q) {
      CHECK(film.errors()[b].relative[q] == full[b].relative[q]);
      CHECK(film.errors()[b].quadrant_pixels[q] == full[b].quadrant_pixels[q]);
    }
    CHECK(film.errors()[b].pixels == 0);
    CHECK(film.errors()[b].variance[0] == 0);
    CHECK(film::relative_error(film, std::span(&b, 1)) == film::tile_error(std::span(&full[b], 1)).relative);
  }
  CHECK(device.validation_messages() == 0);
}

TEST_CASE("Student's t: the 95 % quantiles of the tables") {
  const std::pair<double, double> table[] = {{1, 6.314},  {2, 2.920},  {3, 2.353},   {4, 2.132},  {5, 2.015},
                                             {10, 1.812}, {30, 1.697}, {120, 1.658}, {1e6, 1.645}};
  for (const auto& [degrees, t] : table) CHECK(film::student_90(degrees) == Approx(t).epsilon(0.002));
  for (double d = 1; d < 50; d += 0.1) CHECK(film::student_90(d + 0.1) < film::student_90(d));
}

namespace {

/// Blocks of pixels of luminance 1 with the half differences that `difference` gives (block, quadrant,
/// pixel).
template <class F>
film::TileError tile_of(uint32_t count, const F& difference) {
  std::vector<BlockError> blocks(count);
  for (uint32_t b = 0; b < count; ++b)
    for (uint32_t q = 0; q < 4; ++q)
      for (uint32_t i = 0; i < 16; ++i) {
        const double d = difference(b, q, i), y = std::max(1.0, std::abs(d));
        BlockError& e = blocks[b];
        e.pixels += 1, e.quadrant_pixels[q] += 1;
        e.luminance[0] += float(y), e.variance[0] += float(d * d), e.fourth += float(d * d * d * d);
        e.relative[q] += float(std::sqrt(1.5707963267948966) * std::abs(d) / y);
      }
  return film::tile_error(blocks);
}

}  // namespace

TEST_CASE("a tile's error: noise alike, a lone firefly, a hard corner, a hard line") {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 0.1);
  const auto alike = tile_of(4, [&](auto...) { return normal(random); });
  CHECK(alike.relative == Approx(0.1).epsilon(0.15));
  CHECK(alike.degrees > 150);
  CHECK(alike.standard_error == Approx(0.1 / 16).epsilon(0.15));
  for (const double firefly : {10.0, 1e6}) {
    const auto lone =
        tile_of(4, [&](uint32_t b, uint32_t q, uint32_t i) { return b + q + i == 0 ? firefly : 0.01; });
    CHECK(lone.relative < 0.035);
    CHECK(lone.relative > 0.012);
    CHECK(lone.degrees == Approx(3).epsilon(0.01));
  }
  const auto corner = tile_of(4, [&](uint32_t b, uint32_t q, uint32_t) { return b + q == 0 ? 0.4 : 0.0; });
  CHECK(corner.relative == Approx(0.4 * 1.2533 / 4).epsilon(0.01));  // the mean alone would say 0.031
  const auto line = tile_of(4, [&](uint32_t, uint32_t, uint32_t i) { return i % 4 == 0 ? 0.4 : 0.0; });
  CHECK(line.relative == Approx(0.1 * 1.2533).epsilon(0.01));
  CHECK(film::tile_error({}).relative == 0);
}

TEST_CASE("heavy tails: a firefly marks its tile and its calm neighbours, a lamp does not") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.05);
  const auto calm = [&](double scale) {
    auto tile = tile_of(1, [&](auto...) { return normal(random); });
    tile.luminance *= scale, tile.variance *= scale * scale, tile.fourth *= scale * scale * scale * scale;
    return tile;
  };
  const auto firefly =
      tile_of(1, [&](uint32_t, uint32_t q, uint32_t i) { return q + i == 0 ? 20.0 : normal(random); });
  const auto marks = [](std::vector<film::TileError> tiles) {
    film::mark_heavy_tails(tiles, 5, 0.02);
    std::string text;
    for (const film::TileError& t : tiles) text += t.heavy_tailed ? '#' : '.';
    return text;
  };
  std::vector<film::TileError> tiles(25, calm(1));
  CHECK(marks(tiles) == std::string(25, '.'));
  tiles[12] = calm(1000);  // its noise is large, but not relative to its light
  CHECK(marks(tiles) == std::string(25, '.'));
  tiles[12] = firefly;
  CHECK(marks(tiles) == "......###..###..###......");
  film::mark_heavy_tails({}, 0, 0.02);
}

TEST_CASE("the spread of the tiles: a bright window does not hide grainy walls") {
  CHECK(film::tile_spread({}).worst == 0);
  std::vector<film::TileError> tiles(20);
  for (size_t i = 0; i < tiles.size(); ++i) tiles[(i * 7) % 20].relative = 0.01 * double(i + 1);
  tiles[3].heavy_tailed = true;
  const film::TileSpread spread = film::tile_spread(tiles);
  CHECK(spread.median == Approx(0.11));
  CHECK(spread.worst_tenth == Approx(0.19));
  CHECK(spread.worst == Approx(0.2));
  CHECK(spread.heavy_tailed == 1);
  // A window of 100 that is calm beside walls of 1 with a noise of 30 %.
  const auto block = [](float luminance, float v, float relative) {
    BlockError b{};
    b.pixels = 64, b.luminance[0] = 64 * luminance, b.variance[0] = 64 * v, b.fourth = 64 * v * v;
    for (int q = 0; q < 4; ++q) b.relative[q] = 16 * relative, b.quadrant_pixels[q] = 16;
    return b;
  };
  std::vector<BlockError> blocks(10, block(1, 0.09f, 0.3f));
  blocks.resize(20, block(100, 0, 0));
  const film::ImageError image = film::image_error(blocks);
  CHECK(image.relative(0) < 0.005);
  CHECK(image.degrees == Approx(3 * 640));
  std::vector<film::TileError> walls;
  for (const BlockError& b : blocks) walls.push_back(film::tile_error({&b, 1}));
  CHECK(film::tile_spread(walls).worst_tenth == Approx(0.3));
}
