// links: bench
// The bench of photons without a device: slopes and their intervals on synthetic pictures, the law of the
// radius, and the text and page.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "bench/photon_errors.h"
#include "bench/photons.h"

namespace bench_photons_tests {

using namespace lucerna;
using namespace lucerna::bench;
using Catch::Contains;

namespace {

constexpr size_t k_pixels = 2000;
const std::vector<double> k_rounds = {4, 8, 16, 32, 64, 128, 256};

/// Pictures of alternating luminance 1 and 3, with noise of deviation `noise` rounds^noise_power in every
/// pixel and a bias of `bias` rounds^bias_power in every other one; truths with noise of 0.5.
std::vector<SeedPictures> made_up(size_t seeds, double noise, double noise_power, double bias,
                                  double bias_power) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<SeedPictures> all(seeds);
  for (SeedPictures& s : all) {
    const auto base = [](size_t p) { return p % 2 ? 3.0 : 1.0; };
    for (const double n : k_rounds) {
      auto& picture = s.after.emplace_back();
      for (size_t p = 0; p < k_pixels; ++p)
        picture.push_back(float(base(p) + noise * std::pow(n, noise_power) * normal(random) +
                                (p % 2 ? bias * std::pow(n, bias_power) : 0)));
    }
    for (size_t p = 0; p < k_pixels; ++p) s.truth.push_back(float(base(p) + 0.5 * normal(random)));
  }
  return all;
}

bool holds(const std::optional<Slope>& s, double slope) { return s && s->low <= slope && slope <= s->high; }

}  // namespace

TEST_CASE("slopes on log axes are exact for powers, and unknown without enough points") {
  const std::vector<double> x = {1, 2, 7, 30}, flat = {2, 2};
  std::vector<double> y;
  for (const double v : x) y.push_back(5 * std::pow(v, -1.0 / 3));
  CHECK(log_slope(x, y).value() == Approx(-1.0 / 3));
  CHECK_FALSE(log_slope(std::span(x).first(1), std::span(y).first(1)));
  CHECK_FALSE(log_slope(flat, std::span(y).first(2)));
  y[3] = 0;  // excluded
  CHECK(log_slope(x, y).value() == Approx(-1.0 / 3));
}

TEST_CASE("noise, bias and error of synthetic pictures are recovered") {
  std::vector<SeedPictures> renders = made_up(8, 0.8, -1.0 / 3, 0.6, -0.5);
  std::vector<uint8_t> mask(k_pixels, 1);
  const ErrorCurves curves = error_curves(renders, mask);
  for (size_t k = 0; k < k_rounds.size(); ++k) {
    const double n = k_rounds[k], noise = 0.8 * std::pow(n, -1.0 / 3) / 2,
                 bias = 0.6 * std::pow(n, -0.5) / std::sqrt(2.0) / 2;
    INFO(n);
    CHECK(curves.noise[k] == Approx(noise).epsilon(0.03));
    // The squared bias has the noise of products over 2000 pixels: four standard errors.
    const double mean_noise = (noise * noise + 0.0625) / 8;
    CHECK(curves.bias[k] * curves.bias[k] ==
          Approx(bias * bias).margin(4 * mean_noise * std::sqrt(2.0 / k_pixels)).epsilon(0.02));
    CHECK(curves.error[k] == Approx(std::hypot(noise, bias)).epsilon(0.05));
  }
  // The truths' noise and the masked pixels are excluded.
  for (SeedPictures& s : renders)
    for (auto& picture : s.after) picture[0] = 1e6f;
  mask[0] = 0;
  CHECK(error_curves(renders, mask).noise[0] == Approx(curves.noise[0]).epsilon(0.01));
}

TEST_CASE("a slope's interval contains the true slope and excludes others") {
  const std::vector<uint8_t> mask(k_pixels, 1);
  const std::vector<SeedPictures> renders = made_up(8, 0.8, -1.0 / 3, 0.9, -0.5);
  const auto slopes = error_slopes(k_rounds, renders, mask);
  CHECK(holds(slopes[0], -1.0 / 3));
  CHECK_FALSE(holds(slopes[0], -0.25));
  CHECK_FALSE(holds(slopes[0], -0.5));
  CHECK(holds(slopes[1], -0.5));
  CHECK_FALSE(holds(slopes[1], -0.25));
  CHECK(slopes[2]->low < slopes[2]->high);
  // A bias of zero is hidden by noise and has no slope; two renders have no interval.
  CHECK_FALSE(error_slopes(k_rounds, made_up(8, 0.8, -1.0 / 3, 0, 0), mask)[1]);
  CHECK_FALSE(error_slopes(k_rounds, std::span(renders).first(2), mask)[0]);
}

TEST_CASE("the law of the radius: -alpha / 2 for noise, alpha - 1 for bias, -1/2 for a constant radius") {
  const std::vector<double> late = {1 << 14, 1 << 15, 1 << 16};
  const auto slope = [&](const RadiusLaw& law, bool noise) {
    std::vector<double> y;
    for (const double n : late) y.push_back(noise ? law.noise(uint32_t(n)) : law.bias(uint32_t(n)));
    return log_slope(late, y).value();
  };
  const RadiusLaw shrinking{3, 0, 2.0 / 3}, quick{3, 0, 0.5}, resting{3, 2.5, 2.0 / 3};
  CHECK(slope(shrinking, true) == Approx(-1.0 / 3).epsilon(0.01));
  CHECK(slope(shrinking, false) == Approx(-1.0 / 3).epsilon(0.01));
  CHECK(slope(quick, true) == Approx(-0.25).epsilon(0.01));
  CHECK(slope(quick, false) == Approx(-0.5).epsilon(0.01));
  CHECK(slope(resting, true) == Approx(-0.5).epsilon(0.01));
  CHECK(std::abs(slope(resting, false)) < 0.01);
  CHECK(shrinking.noise(1) == 1);
  CHECK(shrinking.bias(1) == 1);
}

TEST_CASE("intervals: Student's t, and the median's by the sign test") {
  // Tables: 4.303, 2.776, 2.365, 2.045 for 2, 4, 7, 29 degrees.
  CHECK(student_t95(2) == Approx(4.303).epsilon(0.03));
  CHECK(student_t95(4) == Approx(2.776).epsilon(0.01));
  CHECK(student_t95(7) == Approx(2.365).epsilon(0.01));
  CHECK(student_t95(29) == Approx(2.045).epsilon(0.001));
  CHECK(std::isinf(student_t95(0)));
  // Of 15 values the 4th and the 12th enclose the median with 96.5 %; of three, only all do.
  std::vector<double> values;
  for (int i = 15; i >= 1; --i) values.push_back(i);
  const Slope m = median95(values), few = median95({3, 1, 2});
  CHECK(m.value == 8);
  CHECK(m.low == 4);
  CHECK(m.high == 12);
  CHECK(few.low == 1);
  CHECK(few.high == 3);
  CHECK(slope_kept(-0.32, -1.0 / 3));
  CHECK_FALSE(slope_kept(-0.29, -1.0 / 3));
}

TEST_CASE("text and page show the measured values beside the expected ones") {
  using Json = nlohmann::ordered_json;
  const auto row = [](const char* what, int n, double cost, double bytes) {
    return Json{{what, n},
                {"photons", n / 10},
                {"wall_s", 0.5},
                {"cpu_s", 0.9},
                {"trace_s", 0.4},
                {"build_s", 0.05},
                {"build_share", 0.1},
                {"emitted_per_s", 1e6},
                {"stored_per_s", 1e5},
                {"sorted_per_s", 2e6},
                {"gathered_per_s", 3e6},
                {"looked_up_per_s", 1e6},
                {"bytes", bytes},
                {"cpu_us_a_path", cost}};
  };
  Json report{{"version", "9.9"},
              {"date", "2026-01-02 03:04 UTC"},
              {"command", "lucerna bench --photons"},
              {"wall_s", 61.0},
              {"machine", {{"cpu", "A <Processor>"}, {"cores", 2}, {"load", 0.25}}},
              {"device", {{"name", "a device"}, {"driver", "a driver"}}},
              {"slopes",
               {{{"series", "caustic, floor off"},
                 {"scene", "glass"},
                 {"over", "rounds"},
                 {"radius", 3},
                 {"floor", 0},
                 {"alpha", 0.667},
                 {"pixels", 99},
                 {"seeds", 8},
                 {"points",
                  {{{"rounds", 1}, {"noise", 0.5}, {"bias", 0.25}, {"error", 0.6}},
                   {{"rounds", 8}, {"noise", 0.25}, {"bias", 0.0}, {"error", 0.25}}}},
                 {"slopes",
                  {{{"of", "noise"},
                    {"over", "rounds"},
                    {"value", -0.3333},
                    {"low", -0.34},
                    {"high", -0.32},
                    {"expected", -1.0 / 3},
                    {"why", "the law"}},
                   {{"of", "bias"},
                    {"over", "rounds"},
                    {"value", -0.2},
                    {"low", -0.22},
                    {"high", -0.18},
                    {"expected", -1.0 / 3},
                    {"why", "the law"}},
                   {{"of", "error"},
                    {"over", "rounds"},
                    {"value", nullptr},
                    {"expected", -1.0 / 3},
                    {"why", "the law"}}}}}}},
              {"rounds", {row("paths", 10000, 2.0, 1e6), row("paths", 1010000, 2.2, 14e6)}},
              {"lamps", {row("lamps", 1, 2.0, 1e6), row("lamps", 1000, 5.0, 1e6)}},
              {"free",
               {{"scene", "cornell"},
                {"samples", 24},
                {"pairs", 15},
                {"extra", 0.002},
                {"low", -0.004},
                {"high", 0.006},
                {"path_cpu_s", 2.0},
                {"rays", 777},
                {"rays_with_photons", 777},
                {"light_paths", 0.0}}}};
  for (const std::string& reported : {photons_text(report), photons_page(report)}) {
    INFO(reported);
    CHECK_THAT(reported,
               Contains("noise over rounds -0.333 (-0.340 to -0.320), expected -0.333: within a tenth") &&
                   Contains("bias over rounds -0.200 (-0.220 to -0.180), expected -0.333: not within") &&
                   Contains("error over rounds not known") && Contains("lost in noise"));
    // 14 MB for 101 thousand.
    CHECK_THAT(reported, Contains("139 MB a million photons"));
    CHECK_THAT(reported,
               Contains("2.00 µs of CPU time at 10000 paths, 2.20 µs at 1010000; within 1.10 of each other "
                        "from 10000 on"));
    CHECK_THAT(reported, Contains("2.00 µs of CPU time at 1 lamps, 5.00 µs at 1000") &&
                             !Contains("5.00 µs at 1000; within"));
    CHECK_THAT(reported, Contains("+0.20 % (-0.40 to +0.60), 777 rays against 777: under 1 %"));
  }
  CHECK_THAT(photons_page(report), Contains("<svg") && Contains("A &lt;Processor&gt;") &&
                                       Contains("rounds of photons") && !Contains("A <Processor>"));
  report["free"]["low"] = 0.008, report["free"]["high"] = 0.03;
  CHECK_THAT(photons_text(report), Contains("not distinguishable from 1 %"));
  report["free"]["low"] = 0.02;
  CHECK_THAT(photons_text(report), Contains("over 1 %"));
  report["slopes"][0].erase("points");
  CHECK_THROWS_WITH(photons_page(report), Contains("not as a bench writes it"));
}

}  // namespace bench_photons_tests
