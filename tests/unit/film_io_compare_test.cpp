// links: film_io
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "film/io/compare.h"

namespace film_io_compare_tests {

using namespace lucerna;
using film::Comparison;
using film::FilmImage;

namespace {

FilmImage flat(uint32_t width, uint32_t height, float r, float g, float b) {
  const size_t n = size_t{width} * height;
  return {.width = width,
          .height = height,
          .channels = {{"R", std::vector<float>(n, r)},
                       {"G", std::vector<float>(n, g)},
                       {"B", std::vector<float>(n, b)}},
          .metadata = {}};
}

FilmImage noise(uint32_t size, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0, 2);
  FilmImage image = flat(size, size, 0, 0, 0);
  for (auto& [name, values] : image.channels)
    for (float& v : values) v = value(random);
  return image;
}

std::string error_of(const FilmImage& a, const FilmImage& b, const std::string& layer,
                     const film::CompareOptions& options = {}) {
  try {
    film::compare(a, b, layer, options);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("An image equals itself") {
  const FilmImage image = noise(40, 1);
  const Comparison c = film::compare(image, image);
  CHECK(c.rmse == 0);
  CHECK(c.relmse == 0);
  CHECK(c.p99.absolute == 0);
  CHECK(c.largest.absolute == 0);
  CHECK(c.pixels == 1600);
  CHECK(c.blocks.count == 9);
  CHECK(c.blocks.p05 == 1);
  CHECK(c.blocks.p95 == 1);
  for (double ratio : c.mean_ratio) CHECK(ratio == 1);
}

TEST_CASE("Constant images have the expected figures") {
  const Comparison c = film::compare(flat(32, 16, 2, 1, 0), flat(32, 16, 1, 1, 2));
  CHECK(c.rmse == Approx(std::sqrt(5.0 / 3)));
  CHECK(c.relmse == Approx((1 / 1.01 + 0 + 4 / 4.01) / 3));
  CHECK(c.trimmed.rmse == Approx(c.rmse));
  CHECK(c.trimmed.relmse == Approx(c.relmse));
  CHECK(c.p99.absolute == Approx(1.0));
  CHECK(c.p99.relative == Approx((1 / std::sqrt(1.01) + 2 / std::sqrt(4.01)) / 3));
  CHECK(c.mean_ratio == std::vector<double>{2, 1, 0});
  CHECK(c.blocks.median == Approx(0.75));
  CHECK(c.blocks.count == 2);
}

TEST_CASE("The reference is the second image: the relative measure is not symmetric") {
  const FilmImage dark = flat(4, 4, 0.1f, 0.1f, 0.1f), bright = flat(4, 4, 1, 1, 1);
  CHECK(film::compare(dark, bright).relmse == Approx(0.81 / 1.01));
  CHECK(film::compare(bright, dark).relmse == Approx(0.81 / 0.02));
}

TEST_CASE("One outlier in a thousand pixels is dropped by the trimmed measures, two are not") {
  FilmImage a = flat(25, 40, 1, 1, 1);
  const FilmImage b = a;
  a.channels[1].second[777] = 1000;
  const Comparison one = film::compare(a, b);
  CHECK(one.relmse == Approx(999.0 * 999 / 1.01 / 3 / 1000));
  CHECK(one.trimmed.relmse == 0);
  CHECK(one.trimmed.rmse == 0);
  CHECK(one.p99.absolute == 0);
  CHECK(one.largest.absolute == Approx(333));
  CHECK(one.largest.at == std::array<uint32_t, 2>{777 % 25, 777 / 25});
  a.channels[0].second[12] = 3;
  const Comparison two = film::compare(a, b);
  CHECK(two.trimmed.relmse == Approx(4 / 1.01 / 3 / 999));
}

TEST_CASE("The 99th percentile is the nearest rank") {
  FilmImage a = flat(10, 10, 0, 0, 0);
  const FilmImage b = a;
  for (size_t p = 0; p < 100; ++p)
    for (auto& [name, values] : a.channels) values[(p * 37) % 100] = static_cast<float>(p + 1);
  CHECK(film::compare(a, b).p99.absolute == Approx(99));
}

TEST_CASE("Non-finite values are counted on each side and do not affect other figures") {
  FilmImage a = flat(8, 8, 1, 1, 1), b = flat(8, 8, 1, 1, 1);
  a.channels[0].second[3] = std::numeric_limits<float>::quiet_NaN();
  a.channels[1].second[3] = std::numeric_limits<float>::infinity();
  b.channels[2].second[9] = -std::numeric_limits<float>::infinity();
  const Comparison c = film::compare(a, b);
  CHECK(c.non_finite == std::array<uint64_t, 2>{2, 1});
  CHECK(c.nan == std::array<uint64_t, 2>{1, 0});
  CHECK(c.pixels == 62);
  CHECK(c.rmse == 0);
  CHECK(c.mean_ratio == std::vector<double>{1, 1, 1});
}

TEST_CASE("Non-finite pixels are counted in every layer of either image") {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  FilmImage a = flat(8, 8, 1, 1, 1), b = flat(8, 8, 1, 1, 1);
  CHECK(film::non_finite_text(film::compare(a, b)).empty());
  // One pixel counts once, whatever the number of its channels.
  a.channels[0].second[3] = nan, a.channels[1].second[3] = infinity, a.channels[1].second[4] = nan;
  b.channels[2].second[9] = -infinity;
  for (FilmImage* image : {&a, &b}) image->channels.emplace_back("caustic.R", std::vector<float>(64, 0));
  b.channels[3].second[0] = b.channels[3].second[1] = b.channels[3].second[2] = nan;
  CHECK(film::non_finite_text(film::compare(a, b)) ==
        "rgb: 2 pixels of the first image, 1 of the second; caustic: 0 pixels of the first image, 3 of the "
        "second");
  CHECK(film::non_finite_text(film::compare(a, b, "caustic")) ==
        "caustic: 0 pixels of the first image, 3 of the second; rgb: 2 pixels of the first image, 1 of the "
        "second");
  const auto json = nlohmann::json::parse(film::to_json(film::compare(a, b)));
  CHECK(json["non_finite_pixels"] == nlohmann::json{{"rgb", {2, 1}}, {"caustic", {0, 3}}});
  CHECK(film::to_text(film::compare(a, b)).find("caustic: 0 pixels") != std::string::npos);
}

TEST_CASE("Depth is infinite where no surface is hit, which is no fault") {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  FilmImage a = flat(4, 4, 1, 1, 1), b = a;
  for (FilmImage* image : {&a, &b}) image->channels.emplace_back("Z", std::vector<float>(16, 5));
  a.channels[3].second[0] = b.channels[3].second[0] = infinity;
  a.channels[3].second[1] = infinity;  // beside a silhouette
  CHECK(film::compare(a, b).non_finite_layers.empty());
  CHECK(film::non_finite_text(film::compare(a, b, "Z")) == "Z: 1 pixels of the first image, 0 of the second");
  b.channels[3].second[2] = nan;
  CHECK(film::non_finite_text(film::compare(a, b)) == "Z: 0 pixels of the first image, 1 of the second");
}

TEST_CASE("Block ratios show a local error that the mean hides") {
  FilmImage a = flat(64, 64, 1, 1, 1);
  const FilmImage b = a;
  for (auto& [name, values] : a.channels)
    for (size_t y = 0; y < 64; ++y)
      for (size_t x = 0; x < 64; ++x) values[y * 64 + x] = x < 16 ? 1.5f : (x < 32 ? 0.5f : 1.0f);
  const Comparison c = film::compare(a, b);
  CHECK(c.mean_ratio[0] == Approx(1));
  CHECK(c.blocks.p05 == Approx(0.5));
  CHECK(c.blocks.median == Approx(1));
  CHECK(c.blocks.p95 == Approx(1.5));
}

TEST_CASE("A black reference causes no division by zero") {
  const Comparison both = film::compare(flat(4, 4, 0, 0, 0), flat(4, 4, 0, 0, 0));
  CHECK(both.mean_ratio == std::vector<double>{1, 1, 1});
  CHECK(both.blocks.count == 0);
  const Comparison one = film::compare(flat(4, 4, 1, 0, 0), flat(4, 4, 0, 0, 0));
  CHECK(std::isinf(one.mean_ratio[0]));
  CHECK(nlohmann::json::parse(film::to_json(one))["mean_ratio"][0].is_null());
}

TEST_CASE("Incomparable images give one located message") {
  const FilmImage a = flat(4, 4, 1, 1, 1);
  CHECK_THAT(error_of(a, flat(4, 5, 1, 1, 1), ""), Catch::Contains("4x4 and 4x5"));
  CHECK_THAT(error_of(a, a, "primary"),
             Catch::Equals("layer 'primary': not in the first image, which has: rgb"));
  FilmImage more = a;
  more.channels.push_back({"primary.R", std::vector<float>(16, 1)});
  CHECK_THAT(error_of(more, a, "primary"), Catch::Contains("not in the second image"));
  FilmImage most = more;
  most.channels.push_back({"primary.G", std::vector<float>(16, 1)});
  CHECK_THAT(error_of(more, most, "primary"), Catch::Contains("1 channels in the first image, 2"));
  CHECK(error_of(more, more, "primary").empty());
  CHECK_THAT(error_of(a, a, "", {.epsilon = 0}), Catch::Contains("epsilon"));
  CHECK_THAT(error_of(a, a, "", {.trimmed_share = 1}), Catch::Contains("trimmed"));
  CHECK_THAT(error_of(a, a, "", {.block = 0}), Catch::Contains("block"));
}

TEST_CASE("JSON and text contain the figures") {
  const Comparison c = film::compare(noise(33, 2), noise(33, 3));
  const nlohmann::json json = nlohmann::json::parse(film::to_json(c));
  CHECK(json["layer"] == "rgb");
  CHECK(json["relmse"].get<double>() == Approx(c.relmse));
  CHECK(json["rmse"].get<double>() == Approx(c.rmse));
  CHECK(json["channels"] == std::vector<std::string>{"R", "G", "B"});
  CHECK(json["block_ratio"]["median"].get<double>() == Approx(c.blocks.median));
  // Two independent uniforms on 0..2 differ by 2/3 in the mean square; 3267 values: standard error 0.014.
  CHECK(c.rmse * c.rmse == Approx(2.0 / 3).margin(0.06));
  CHECK_THAT(film::to_text(c), Catch::Contains("relative MSE") && Catch::Contains("mean R"));
}

TEST_CASE("The difference picture shows size, channel and non-finite values") {
  FilmImage a = flat(2, 2, 1, 1, 1);
  const FilmImage b = flat(2, 2, 1, 1, 1);
  a.channels[0].second[1] = 1.1f;
  a.channels[1].second[2] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<uint8_t> rgba = film::difference_picture(a, b, "", 10);
  CHECK(std::vector<uint8_t>(rgba.begin(), rgba.begin() + 4) == std::vector<uint8_t>{0, 0, 0, 255});
  CHECK(std::vector<uint8_t>(rgba.begin() + 4, rgba.begin() + 8) == std::vector<uint8_t>{255, 0, 0, 255});
  CHECK(std::vector<uint8_t>(rgba.begin() + 8, rgba.begin() + 12) == std::vector<uint8_t>{255, 0, 255, 255});
}

}  // namespace film_io_compare_tests
