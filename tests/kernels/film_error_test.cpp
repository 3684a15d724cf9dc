// links: film
// The error kernel's sums over a film compared with the same sums in double precision; and the errors derived
// from them.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "film/error.h"
#include "film/estimator.h"
#include "support/device_name.h"

namespace film_error_tests {

using namespace lucerna;
using shared::BlockError;

namespace {

/// Samples with a heavy tail; dark towards the right, so the floor matters.
float sample_value(std::mt19937& random, uint32_t x) {
  std::exponential_distribution<float> tail(1.0f);
  const float t = tail(random);
  return (x > 15 ? 1e-3f : 0.3f) * t * t;
}

/// Mean over the surrounding 5x5 pixels inside the picture.
template <class Shown>
double mean_around(uint32_t x, uint32_t y, uint32_t width, uint32_t height, const Shown& shown) {
  double sum = 0, count = 0;
  for (uint32_t v = y < 2 ? 0 : y - 2; v <= std::min(y + 2, height - 1); ++v)
    for (uint32_t u = x < 2 ? 0 : x - 2; u <= std::min(x + 2, width - 1); ++u) sum += shown(u, v), ++count;
  return sum / count;
}

uint32_t compact(uint32_t x) { return (x & 1u) | (x >> 1 & 2u) | (x >> 2 & 4u); }

}  // namespace

TEST_CASE("the error kernel: sums over the blocks of an item, to float precision") {
  gpu::Device device({test::device_name(), true});
  gpu::ShaderCompiler compiler;
  gpu::Stream stream(device);
  constexpr uint32_t k_width = 20, k_height = 12, k_samples = 6;  // blocks extend beyond two sides
  constexpr float k_floor = 0.05f, k_white = 4;
  film::Film film(device, k_width, k_height);
  film.clear(stream);
  const uint32_t blocks = film.blocks();
  REQUIRE(blocks == 6);
  const gpu::Kernel add(device, compiler, "film/add.comp"), error(device, compiler, "film/error.comp"),
      stopping(device, compiler, "film/error.comp", {{"LUCERNA_STOPPING_ONLY", "1"}});
  std::mt19937 random(1);
  std::vector<vec4> values(size_t(blocks) * 64 * k_samples * 4);
  std::vector<shared::WorkBlock> list;
  for (uint32_t b = 0; b < blocks; ++b) list.push_back({blocks - 1 - b, 0});  // in another order
  // Sums of the two halves of every pixel and component; red, green and blue are proportional.
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
  const shared::FilmPush added{k_width, k_height, 64 * blocks, k_samples, 0, 0};
  stream.dispatch(add, resources, added, blocks);
  // The last block of the list is excluded: its figures stay unchanged.
  stream.dispatch(error, resources, shared::ErrorPush{k_width, k_height, blocks - 1, k_floor, k_white},
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
    double pixels = 0, luminance[5] = {}, variance[5] = {}, fourth = 0, difference = 0, quadrant_n[4] = {},
           seen[5] = {}, seen_fourth = 0, white = 0, dark = 0;
    for (const bool second : {false, true}) {
      double relative[4] = {};
      for (uint32_t code = 0; code < 64; ++code) {
        const uint32_t x = b % 3 * 8 + compact(code), y = b / 3 * 8 + compact(code >> 1), q = code / 16;
        if (x >= k_width || y >= k_height) continue;
        double a0 = 0, b0 = 0, apart[5] = {};
        for (uint32_t c = 0; c < 4; ++c) {
          const double* h = &half[((size_t(y) * k_width + x) * 4 + c) * 2];
          const double va = h[0] / (k_samples / 2), vb = h[1] / (k_samples / 2);
          a0 += va, b0 += vb, apart[c + 1] = (va - vb) / 2;
          if (!second) luminance[c + 1] += (va + vb) / 2, variance[c + 1] += (va - vb) * (va - vb) / 4;
        }
        const double y0 = (a0 + b0) / 2, v0 = (a0 - b0) * (a0 - b0) / 4;
        if (!second) {
          ++pixels, ++quadrant_n[q];
          white += y0 >= k_white, dark += y0 < k_floor;
          luminance[0] += y0, variance[0] += v0, fourth += v0 * v0;
          difference += (a0 - b0) / 2;
        } else {
          const double shown = std::min(y0, double{k_white}), low = std::min({a0, b0, double{k_white}});
          const double local = mean_around(x, y, k_width, k_height, [&](uint32_t u, uint32_t v) {
            double sum = 0;
            for (size_t h = 0; h < 8; ++h) sum += half[(size_t(v) * k_width + u) * 8 + h];
            return std::min(sum / k_samples, double{k_white});
          });
          const double scale = std::max({shown / 4, local, double{k_floor}});
          const double e = (shown - low) / scale, part = a0 == b0 ? 1 : (shown - low) / std::sqrt(v0);
          relative[q] += std::sqrt(1.5707963267948966) * std::min(e, 1.0);
          seen[0] += e * e, seen_fourth += e * e * e * e;
          for (int c = 1; c < 5; ++c) seen[c] += std::pow(part * apart[c] / scale, 2);
        }
      }
      if (!second) continue;
      CHECK(got.pixels == pixels);
      for (int k = 0; k < 5; ++k) {
        CHECK(close(got.luminance[k], luminance[k]));
        CHECK(close(got.variance[k], variance[k]));
        CHECK(got.seen[k] == Approx(seen[k]).epsilon(1e-4));
      }
      CHECK(got.seen_fourth == Approx(seen_fourth).epsilon(1e-4));
      CHECK(got.white == white);
      CHECK(got.dark == dark);
      CHECK(close(got.fourth, fourth));
      CHECK(got.difference == Approx(difference).margin(2e-6 * luminance[0]));
      for (int q = 0; q < 4; ++q) {
        CHECK(got.quadrant_pixels[q] == quadrant_n[q]);
        CHECK(got.relative[q] == Approx(relative[q]).epsilon(2e-5));
      }
    }
  }
  // Only the stopping criterion: identical bit for bit, and nothing else is written.
  const std::vector<BlockError> full(film.errors().begin(), film.errors().end());
  film.clear(stream);
  stream.dispatch(add, resources, added, blocks);
  stream.dispatch(stopping, resources, shared::ErrorPush{k_width, k_height, blocks - 1, k_floor, k_white},
                  (blocks + 7) / 8);
  stream.run();
  for (uint32_t b = 0; b < blocks; ++b) {
    for (int q = 0; q < 4; ++q) {
      CHECK(film.errors()[b].relative[q] == full[b].relative[q]);
      CHECK(film.errors()[b].quadrant_pixels[q] == full[b].quadrant_pixels[q]);
    }
    CHECK(film.errors()[b].pixels == 0);
    CHECK(film.errors()[b].variance[0] == 0);
    CHECK(film::relative_error(film, std::span(&b, 1)).paths ==
          film::tile_error(std::span(&full[b], 1)).relative);
  }
  // The renderer's interface to both: the same, with named stages.
  film::ErrorEstimator estimator(device, compiler, false);
  for (const bool all : {true, false}) {
    film.clear(stream);
    stream.dispatch(add, resources, added, blocks);
    stream.run();
    stream.take_times();
    if (all)
      estimator.estimate(stream, film, {k_floor, k_white});
    else
      estimator.estimate_stopping(stream, std::span(list).first(blocks - 1), film, {k_floor, k_white});
    stream.run();
    const std::vector<gpu::StageTime> times = stream.take_times();
    REQUIRE(times.size() == 1);
    CHECK(times[0].stage == (all ? "ledger" : "stopping"));
    for (uint32_t b = 0; b < blocks; ++b) {
      const BlockError& got = film.errors()[b];
      const bool last = b == list.back().index;
      CHECK((got.pixels > 0) == all);
      if (all && !last) CHECK(std::memcmp(&got, &full[b], sizeof got) == 0);
      if (!all) CHECK(std::equal(std::begin(got.relative), std::end(got.relative), full[b].relative));
    }
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

TEST_CASE("a tile's error: uniform noise, a single firefly, a hard corner, a hard line") {
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
  CHECK(corner.relative == Approx(0.4 * 1.2533 / 4).epsilon(0.01));  // the mean alone would give 0.031
  const auto line = tile_of(4, [&](uint32_t, uint32_t, uint32_t i) { return i % 4 == 0 ? 0.4 : 0.0; });
  CHECK(line.relative == Approx(0.1 * 1.2533).epsilon(0.01));
  CHECK(film::tile_error({}).relative == 0);
}

TEST_CASE("heavy tails: a firefly marks its tile and its quiet neighbours, a lamp does not") {
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
  // A noise-free window of 100 beside walls of 1 with a noise of 30 %.
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

TEST_CASE("the error kernel: records' errors are summed beside the pixels' noise and leave it unchanged") {
  gpu::Device device({test::device_name(), true});
  gpu::ShaderCompiler compiler;
  gpu::Stream stream(device);
  constexpr uint32_t k_width = 12, k_height = 8;
  constexpr float k_floor = 0.05f;
  film::Film film(device, k_width, k_height);
  film.clear(stream);
  const gpu::Kernel add(device, compiler, "film/add.comp"), plain(device, compiler, "film/error.comp"),
      error(device, compiler, "film/error.comp", {{"LUCERNA_LOOKUP_ERRORS", "1"}}),
      stopping(device, compiler, "film/error.comp",
               {{"LUCERNA_LOOKUP_ERRORS", "1"}, {"LUCERNA_STOPPING_ONLY", "1"}});
  constexpr uint32_t k_blocks = 2, k_samples = 2;
  std::mt19937 random(3);
  std::vector<vec4> values(size_t{k_blocks} * 64 * k_samples * 4);
  for (vec4& v : values) v = vec4(0.05f + 0.1f * sample_value(random, 0));
  gpu::Buffer radiance(device, {.name = "radiance", .bytes = values.size() * sizeof(vec4), .texel = true});
  gpu::Buffer features(device, {.name = "features", .bytes = values.size() * 8, .texel = true});
  const std::vector<shared::WorkBlock> list{{0, 0}, {1, 0}};
  gpu::Buffer work(device, {.name = "work blocks", .bytes = list.size() * sizeof(shared::WorkBlock)});
  radiance.write(std::span<const vec4>(values));
  work.write(std::span<const shared::WorkBlock>(list));
  stream.fill(features, 0);
  film.make_room_for_lookup_errors();
  gpu::Resources resources;
  film.bind(resources);
  resources.set("WorkBlocks", work);
  resources.set("radiance_texels", radiance);
  resources.set("feature_texels", features);
  std::vector<vec2> records(size_t{k_width} * k_height);
  for (size_t i = 0; i < records.size(); ++i)
    records[i] = vec2(1e-4f * float(i), 2e-4f * float(i % 7) - 3e-4f);
  gpu::Buffer estimated(device, {.name = "estimated", .bytes = records.size() * sizeof(vec2)});
  estimated.write(std::span<const vec2>(records));
  resources.set("FilmLookups", estimated);
  const auto run = [&](const gpu::Kernel& kernel, uint32_t known) {
    stream.dispatch(kernel, resources, shared::ErrorPush{k_width, k_height, k_blocks, k_floor, 1e9f, known},
                    1);
    stream.run();
    return std::vector<BlockError>(film.errors().begin(), film.errors().end());
  };
  stream.dispatch(add, resources, shared::FilmPush{k_width, k_height, 64 * k_blocks, k_samples, 0, 0},
                  k_blocks);
  std::vector<BlockError> without = run(plain, 0), unknown = run(error, 0), full = run(error, 1);
  // Unmixed light is unchanged.
  for (BlockError& e : unknown) {
    CHECK(e.unmixed == e.luminance[0]);
    e.unmixed = 0;
  }
  for (BlockError& e : without) e.unmixed = 0;
  CHECK(std::memcmp(without.data(), unknown.data(), without.size() * sizeof(BlockError)) == 0);
  const film::Image image = film.read();
  for (uint32_t b = 0; b < k_blocks; ++b) {
    double sums[4] = {};
    for (uint32_t q = 0; q < 4; ++q) {
      CHECK(full[b].relative[q] == without[b].relative[q]);
      for (uint32_t k = 0; k < 16; ++k) {
        const uint32_t x = b * 8 + q % 2 * 4 + k % 4, y = q / 2 * 4 + k / 4;
        if (x >= k_width) continue;
        const auto shown = [&](uint32_t u, uint32_t v) {
          double sum = 0;
          for (const auto& c : image.components) sum += luminance(c[v * k_width + u]);
          return sum;
        };
        const double scale =
            std::max({shown(x, y) / 4, mean_around(x, y, k_width, k_height, shown), double{k_floor}});
        const vec2 r = records[y * k_width + x];
        sums[0] += r.x, sums[1] += r.y, sums[2] += r.x / (scale * scale), sums[3] += r.y / (scale * scale);
      }
    }
    CHECK(full[b].lookup_noise == Approx(sums[0]).epsilon(1e-5));
    CHECK(full[b].interpolation == Approx(sums[1]).epsilon(1e-4).margin(1e-7));
    CHECK(full[b].lookup_noise_relative == Approx(sums[2]).epsilon(1e-4));
    CHECK(full[b].interpolation_relative == Approx(sums[3]).epsilon(1e-3).margin(1e-5));
  }
  // The stopping criterion has the same records' error.
  film.clear(stream);
  stream.dispatch(add, resources, shared::FilmPush{k_width, k_height, 64 * k_blocks, k_samples, 0, 0},
                  k_blocks);
  const std::vector<BlockError> alone = run(stopping, 1);
  for (uint32_t b = 0; b < k_blocks; ++b) {
    CHECK(alone[b].lookup_noise_relative == full[b].lookup_noise_relative);
    CHECK(alone[b].interpolation_relative == full[b].interpolation_relative);
    CHECK(alone[b].lookup_noise == 0);
  }
}

TEST_CASE(
    "the bias of lookups: summed by halves beside their light, and squared without the noise of either "
    "half") {
  gpu::Device device({test::device_name(), true});
  gpu::ShaderCompiler compiler;
  gpu::Stream stream(device);
  constexpr uint32_t k_width = 12, k_height = 8, k_blocks = 2, k_pixels = k_width * k_height;
  constexpr float k_floor = 0.05f;
  film::Film film(device, k_width, k_height);
  film.clear(stream);
  CHECK_FALSE(film.lookup_bias_known());
  const gpu::Kernel add(device, compiler, "film/add.comp", {{"LUCERNA_LOOKUP_BIAS", "1"}}),
      error(device, compiler, "film/error.comp", {{"LUCERNA_LOOKUP_ERRORS", "1"}}),
      stopping(device, compiler, "film/error.comp",
               {{"LUCERNA_LOOKUP_ERRORS", "1"}, {"LUCERNA_STOPPING_ONLY", "1"}});
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  gpu::Buffer radiance(device, {.name = "radiance", .bytes = k_blocks * 64 * 2 * 4 * 16, .texel = true});
  gpu::Buffer features(device, {.name = "features", .bytes = k_blocks * 64 * 2 * 32, .texel = true});
  gpu::Buffer work(device, {.name = "work blocks", .bytes = k_blocks * sizeof(shared::WorkBlock)});
  stream.fill(features, 0);
  std::array<std::vector<double>, 2> mean{std::vector<double>(k_pixels), std::vector<double>(k_pixels)};
  gpu::Resources resources;
  // Three samples, in two batches: two even ones and an odd one. Only the first lane has a bias.
  for (const uint32_t first : {0u, 2u}) {
    const uint32_t samples = first == 0 ? 2 : 1;
    std::vector<vec4> values(k_blocks * 64 * samples * 4);
    for (uint32_t s = 0; s < samples; ++s)
      for (uint32_t b = 0; b < k_blocks; ++b)
        for (uint32_t code = 0; code < 64; ++code) {
          const uint32_t x = b * 8 + compact(code), y = compact(code >> 1);
          const float bias = 0.02f + 0.05f * normal(random);
          for (uint32_t c = 0; c < 4; ++c)
            values[((size_t{s} * k_blocks + b) * 64 + code) * 4 + c] = vec4(vec3(0.1f), c == 1 ? bias : 7);
          if (x < k_width) mean[(first + s) % 2][y * k_width + x] += double(bias) / ((first + s) % 2 ? 1 : 2);
        }
    radiance.write(std::span<const vec4>(values));
    const std::vector<shared::WorkBlock> list{{0, first}, {1, first}};
    work.write(std::span<const shared::WorkBlock>(list));
    film.make_room_for_lookup_bias(stream);
    film.bind(resources);
    resources.set("WorkBlocks", work);
    resources.set("radiance_texels", radiance);
    resources.set("feature_texels", features);
    stream.dispatch(add, resources, shared::FilmPush{k_width, k_height, 64 * k_blocks, samples, 0, 0},
                    k_blocks);
    stream.run();
  }
  REQUIRE(film.lookup_bias_known());
  const auto estimated = film.read_lookup_bias();
  for (int half = 0; half < 2; ++half)
    for (size_t i = 0; i < k_pixels; ++i)
      CHECK(double(estimated[half][i]) == Approx(mean[half][i]).epsilon(1e-5).margin(1e-7));
  const auto run = [&](const gpu::Kernel& kernel, uint32_t known) {
    const std::vector<shared::WorkBlock> list{{0, 0}, {1, 0}};
    work.write(std::span<const shared::WorkBlock>(list));
    stream.dispatch(kernel, resources,
                    shared::ErrorPush{k_width, k_height, k_blocks, k_floor, 1e9f, 0, known}, 1);
    stream.run();
    return std::vector<BlockError>(film.errors().begin(), film.errors().end());
  };
  for (const BlockError& e : run(error, 0)) {
    CHECK(e.interpolation == 0);
    CHECK(e.interpolation_relative == 0);
    CHECK(e.bias[0] == 0);
    CHECK(e.bias[1] == 0);
  }
  const std::vector<BlockError> full = run(error, 1);
  const double scale = 0.4;  // all pixels alike
  for (uint32_t b = 0; b < k_blocks; ++b) {
    double square = 0, even = 0, odd = 0;
    for (uint32_t i = 0; i < k_pixels; ++i)
      if (i % k_width / 8 == b) square += mean[0][i] * mean[1][i], even += mean[0][i], odd += mean[1][i];
    CHECK(full[b].interpolation == Approx(square).epsilon(1e-4));
    CHECK(full[b].interpolation_relative == Approx(square / (scale * scale)).epsilon(1e-4));
    CHECK(full[b].bias[0] == Approx(even).epsilon(1e-5));
    CHECK(full[b].bias[1] == Approx(odd).epsilon(1e-5));
    CHECK(full[b].lookup_noise == 0);
    const film::TileError tile = film::tile_error({&full[b], 1});
    CHECK(tile.lookups.interpolation == Approx(std::sqrt(std::max(0.0, even * odd)) / full[b].pixels));
    CHECK(tile.half_width_90() ==
          Approx(film::student_90(tile.degrees) * tile.standard_error + tile.lookups.interpolation));
  }
  const std::vector<BlockError> alone = run(stopping, 1);
  for (uint32_t b = 0; b < k_blocks; ++b)
    CHECK(alone[b].interpolation_relative == full[b].interpolation_relative);
  // Halves of opposite sign are noise.
  BlockError noise{};
  noise.pixels = 64, noise.bias[0] = 3, noise.bias[1] = -2;
  CHECK(film::blur_error({&noise, 1}) == 0);
  // Another picture starts with zero.
  film.clear(stream);
  CHECK_FALSE(film.lookup_bias_known());
  film.make_room_for_lookup_bias(stream);
  stream.run();
  for (const auto& half : film.read_lookup_bias())
    for (const float value : half) CHECK(value == 0);
  CHECK(device.validation_messages() == 0);
}

TEST_CASE("a tile's interval contains the truth equally often with and without shared noise") {
  // Pixels of a tile in groups with the same Gaussian error; tiles differ in brightness.
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  constexpr uint32_t k_across = 12, k_pixels = 64;
  for (const uint32_t group : {1u, 8u}) {
    size_t naive = 0, held = 0, all = 0;
    double widened = 0;
    for (int picture = 0; picture < 20; ++picture) {
      std::vector<film::TileError> tiles, alone;
      for (uint32_t t = 0; t < k_across * k_across; ++t) {
        const double sigma = std::exp(normal(random));
        BlockError b{};
        b.pixels = k_pixels;
        for (uint32_t i = 0; i < k_pixels; i += group) {
          const double even = sigma * normal(random), odd = sigma * normal(random), half = (even - odd) / 2;
          const auto n = double(group);
          b.luminance[0] += float(n * (even + odd) / 2), b.difference += float(n * half);
          b.variance[0] += float(n * half * half), b.fourth += float(n * std::pow(half, 4));
        }
        tiles.push_back(film::tile_error({&b, 1}));
      }
      alone = tiles;
      film::count_shared_noise(tiles, k_across);
      for (size_t t = 0; t < tiles.size(); ++t) {
        ++all;
        naive += std::abs(tiles[t].luminance) <= alone[t].half_width_90();  // the truth is 0
        held += std::abs(tiles[t].luminance) <= tiles[t].half_width_90();
        widened += std::pow(tiles[t].standard_error / alone[t].standard_error, 2);
      }
    }
    INFO("groups of " << group << ": " << double(held) / double(all) << " held, "
                      << double(naive) / double(all) << " without");
    CHECK(double(held) > 0.87 * double(all));
    CHECK(double(held) < 0.95 * double(all));
    // At least 1, so it is slightly more where nothing is shared.
    CHECK(widened / double(all) > 0.9 * group);
    CHECK(widened / double(all) < 1.2 * group);
    if (group > 1) CHECK(double(naive) < 0.6 * double(all));
  }
}

TEST_CASE("a tile's error combines paths and records in quadrature and adds interpolation") {
  BlockError e{};
  e.pixels = 64, e.luminance[0] = 32, e.variance[0] = 64 * 0.04f, e.fourth = 64 * 3 * 0.0016f;
  for (int q = 0; q < 4; ++q) e.relative[q] = 16 * 0.4f, e.quadrant_pixels[q] = 16;
  const film::TileError plain = film::tile_error({&e, 1});
  CHECK(plain.relative_sum() == plain.relative);
  CHECK(plain.half_width_90() == film::student_90(plain.degrees) * plain.standard_error);
  e.lookup_noise = 64 * 0.09f, e.interpolation = 64 * 0.01f;
  e.lookup_noise_relative = 64 * 0.09f, e.interpolation_relative = 64 * 0.01f;
  shared::BlockLookups r{};
  r.pixels = 64;
  for (uint32_t k = 0; k < 2 * shared::k_lookup_lanes; ++k) r.noise[k] = 64 * (k % 3 ? 0.3f : -0.3f);
  // A lane's signs agree between the paths if their sums are of the same records.
  for (uint32_t k = 0; k < shared::k_lookup_lanes; ++k) r.noise[shared::k_lookup_lanes + k] = r.noise[k];
  r.interpolation[0] = r.interpolation[1] = 64 * -0.2f;
  const film::TileError tile = film::tile_error({&e, 1}, {&r, 1});
  CHECK(tile.standard_error == plain.standard_error);
  CHECK(tile.lookups.noise == Approx(0.3));
  CHECK(tile.lookups.interpolation == Approx(0.2));
  CHECK(tile.relative_sum() == Approx(std::hypot(plain.relative, 0.3) + 0.1));
  // The records dominate the noise: the sum has their degrees of freedom, plus a little for the paths'.
  const double noise = std::hypot(plain.standard_error, 0.3);
  CHECK(tile.half_width_90() < film::student_90(shared::k_lookup_lanes) * noise + 0.2);
  CHECK(tile.half_width_90() > 1.6448 * noise + 0.2);
  const film::ImageError image = film::image_error({&e, 1});
  CHECK(image.lookup_noise_rms == Approx(0.3));
  CHECK(image.interpolation_rms == Approx(0.1));
  CHECK(image.relative_sum() == Approx((std::hypot(image.rms[0], 0.3) + 0.1) / 0.5));
  // Estimates below zero, which occur by chance, count as zero.
  e.lookup_noise = e.lookup_noise_relative = -1e-3f;
  CHECK(film::tile_error({&e, 1}).relative_lookup_noise == 0);
}

TEST_CASE("where lookups found no light the error is unknown, not zero", "[film_error]") {
  constexpr float k_mark = shared::k_found_nothing;
  shared::BlockError dark{};
  dark.pixels = 64;
  for (float& n : dark.quadrant_pixels) n = 16;
  CHECK_FALSE(film::without_evidence(dark));  // no lookups, as in path tracing
  // The smallest and the largest mark: the square over that of the pixel's scale.
  for (const float scale : {shared::k_luminance_floor, 100.0f}) {
    dark.interpolation_relative = 64 * k_mark * k_mark / (scale * scale);
    CHECK(film::without_evidence(dark));
  }
  dark.interpolation_relative = 1e-12f;  // one of the halves has found light
  CHECK_FALSE(film::without_evidence(dark));
  dark.interpolation_relative = k_mark * k_mark;
  const film::TileError tile = film::tile_error(std::array{dark});
  CHECK(tile.unknown);
  CHECK(tile.relative == 1);
  // A quarter of a picture; and a whole picture that is black.
  shared::BlockError lit{};
  lit.pixels = 64, lit.luminance[0] = 64;
  CHECK(film::image_error(std::array{lit, dark, lit, lit}).relative(0) == Approx(0.5));
  CHECK(film::image_error(std::array{dark}).relative_sum() == 1);
  CHECK(film::image_error(std::array{lit}).relative_sum() == 0);
}

}  // namespace film_error_tests
