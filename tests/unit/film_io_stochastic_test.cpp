// links: film_io
// Comparison of noisy pictures: its false alarms, its power, correlated noise, and invalid input.
#include "film/io/stochastic.h"

#include <catch2/catch.hpp>
#include <random>

namespace film_io_stochastic_tests {

using namespace lucerna;
using namespace lucerna::film;
using Catch::Contains;

namespace {

/// A picture of mean `level` whose halves have the given noise per pixel; with `group` > 1 that many
/// neighbours share it. `bright`: probability of a sample of 100 times the mean.
FilmImage picture(uint32_t seed, float level, float noise, int group = 1, float bright = 0) {
  FilmImage image{.width = 64, .height = 48};
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform;
  const size_t n = size_t{image.width} * image.height;
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float> all(n), odd(n);
    float even_noise = 0, odd_noise = 0;
    for (size_t i = 0; i < n; ++i) {
      if (i % static_cast<size_t>(group) == 0) even_noise = normal(random), odd_noise = normal(random);
      const float x = level * (1 + noise * even_noise) + (uniform(random) < bright ? 100 * level : 0),
                  y = level * (1 + noise * odd_noise) + (uniform(random) < bright ? 100 * level : 0);
      all[i] = 0.5f * (x + y), odd[i] = y;
    }
    image.channels.emplace_back(name, all);
    image.channels.emplace_back(std::string("odd.") + name, odd);
  }
  image.channels.emplace_back("samples", std::vector<float>(n, 16));
  return image;
}

FilmImage scaled(FilmImage image, uint32_t x0, uint32_t y0, uint32_t side, float factor) {
  for (auto& [name, plane] : image.channels)
    if (name != "samples")
      for (uint32_t y = y0; y < y0 + side; ++y)
        for (uint32_t x = x0; x < x0 + side; ++x) plane[size_t{y} * image.width + x] *= factor;
  return image;
}

int alarms(int group, float bright) {
  int count = 0;
  for (uint32_t seed = 0; seed < 200; ++seed)
    count += compare_stochastic(picture(2 * seed + 1, 0.4f, 0.3f, group, bright),
                                picture(2 * seed + 2, 0.4f, 0.3f, group, bright), {.significance = 0.05}, "r")
                 .different;
  return count;
}

}  // namespace

TEST_CASE("Student's distribution against known values") {
  CHECK(student_two_sided(0, 5) == Approx(1));
  CHECK(student_two_sided(12.706, 1) == Approx(0.05).epsilon(1e-3));
  CHECK(student_two_sided(2.571, 5) == Approx(0.05).epsilon(1e-3));
  CHECK(student_two_sided(1.96, 1e9) == Approx(0.05).epsilon(1e-3));
  CHECK(student_two_sided(5, 1e9) == Approx(5.733e-7).epsilon(1e-3));
  CHECK(student_two_sided(1e3, 3) == Approx(2.2e-9).epsilon(0.05));
}

TEST_CASE("equal pictures rarely differ, whatever their noise") {
  // 200 pairs at 5 %: ten on average; more than 20 has a probability below 0.002.
  CHECK(alarms(1, 0) <= 20);
  CHECK(alarms(8, 0) <= 20);
  CHECK(alarms(1, 0.0005f) <= 20);
}

TEST_CASE("a change beyond the noise is found and located") {
  const FilmImage reference = picture(1, 0.4f, 0.3f);
  const auto compare = [&](const FilmImage& now) { return compare_stochastic(now, reference, {}, "r"); };
  CHECK_FALSE(compare(picture(2, 0.4f, 0.3f)).different);
  // The standard error of a tile's difference is 0.3 / sqrt(2 * 256) * sqrt(2) = 1.9 %.
  const StochasticComparison tile = compare(scaled(picture(2, 0.4f, 0.3f), 32, 16, 16, 1.2f));
  CHECK(tile.different);
  CHECK(tile.different_tiles == 1);
  CHECK(tile.worst.area == std::array<uint32_t, 4>{32, 16, 16, 16});
  CHECK(tile.tests == 3 * (12 + 1));
  CHECK_THAT(to_text(tile), Contains("1 of 12 tiles differ beyond noise") && Contains("at 32,16: "));
  // 2.5 % everywhere is beyond the noise of no tile, but of the whole.
  const StochasticComparison whole = compare(picture(2, 0.41f, 0.3f));
  CHECK(whole.different);
  CHECK_THAT(to_text(whole), Contains("whole picture"));
  const std::vector<uint8_t> map = tile_picture(tile, 0.001);
  const size_t inside = (size_t{20} * 64 + 40) * 4;
  CHECK((map[inside] == 255 && map[inside + 1] == 40));
}

TEST_CASE("without noise the tolerance decides, and the bias of lookups is allowed") {
  const FilmImage reference = picture(1, 0.4f, 0);
  CHECK_FALSE(compare_stochastic(picture(2, 0.4004f, 0), reference, {}, "r").different);
  CHECK(compare_stochastic(picture(2, 0.402f, 0), reference, {}, "r").different);
  FilmImage biased = picture(2, 0.42f, 0);
  biased.channels.emplace_back("lookup.bias", std::vector<float>(size_t{64} * 48, 0.021f));
  CHECK_FALSE(compare_stochastic(biased, reference, {}, "r").different);
}

TEST_CASE("pictures that cannot be compared are refused with the reason") {
  const FilmImage reference = picture(1, 0.4f, 0.3f);
  FilmImage small = reference;
  small.height = 24;
  for (auto& [name, plane] : small.channels) plane.resize(size_t{64} * 24);
  CHECK_THROWS_WITH(compare_stochastic(small, reference, {}, "r.exr"),
                    "r.exr: is 64x48 pixels; the picture has 64x24");
  FilmImage plain = reference;
  std::erase_if(plain.channels, [](const auto& c) { return c.first.starts_with("odd."); });
  CHECK_THROWS_WITH(compare_stochastic(reference, plain, {}, "r.exr"), Contains("r.exr: no channel 'odd.R'"));
  FilmImage few = reference;
  few.channels.back().second[7] = 1;
  CHECK_THROWS_WITH(compare_stochastic(reference, few, {}, "r.exr"), Contains("fewer than two samples"));
  FilmImage bad = reference;
  bad.channels[0].second[5] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(compare_stochastic(reference, bad, {}, "r.exr"),
                    Contains("'R' has values that are not finite"));
  CHECK_THROWS_WITH(compare_stochastic(reference, reference, {.layer = "caustic"}, "r.exr"),
                    "r.exr: there is no layer 'caustic'");
}

}  // namespace film_io_stochastic_tests
