// links: stats
// The ledger's lines and what the forecasts make of made-up renders whose law is known.
#include <catch2/catch.hpp>
#include <cmath>

#include "stats/forecast.h"

using namespace lucerna::stats;

namespace {

/// A render whose error is c * work^-exponent, a second for every thousand paths.
Ledger render(double exponent, uint64_t paths, double wobble = 0) {
  Ledger ledger;
  for (uint64_t p = 100; p <= paths; p += 100) {
    if (!ledger.due(p, 100)) continue;
    Entry e;
    e.told = true, e.paths = p, e.rays = 5 * p, e.samples = double(p) / 100, e.wall_s = 1e-3 * double(p);
    for (double& x : e.error)
      x = 2 * std::pow(double(p) / 100, -exponent) * (1 + wobble * std::sin(double(ledger.entries().size())));
    ledger.add(e);
  }
  return ledger;
}

/// Tiles that follow the law of forecast.h, of this noise in one sample; tile 0 is the hard one.
std::vector<TileProgress> tiles(uint32_t count, double easy, double hard, double samples) {
  std::vector<TileProgress> list(count);
  for (uint32_t t = 0; t < count; ++t) {
    const double s = t == 0 ? hard : easy;
    list[t] = {.error = 1 / std::sqrt(samples / (s * s) + 1 / (k_saturated_error * k_saturated_error)),
               .samples = samples,
               .pixels = 256};
  }
  return list;
}

}  // namespace

TEST_CASE("a line each time the work has grown by half, later by a quarter, and one for the end") {
  Ledger ledger;
  CHECK_FALSE(ledger.due(0, 10));
  CHECK_FALSE(ledger.due(19, 10));  // fewer than two samples a pixel: no error can be told
  CHECK(ledger.due(20, 10));
  ledger.add({.paths = 20});
  CHECK_FALSE(ledger.due(29, 10));
  CHECK(ledger.due(30, 10));
  ledger.add({.paths = 1000});
  CHECK_FALSE(ledger.due(1249, 10));
  CHECK(ledger.due(1250, 10));
  ledger.add({.paths = 1000, .rays = 7});  // the same moment again replaces the line
  REQUIRE(ledger.entries().size() == 2);
  CHECK(ledger.entries()[1].rays == 7);
  CHECK(render(0.5, 1000000).entries().size() < 60);
}

TEST_CASE("CSV: as many fields in every line, unknown ones empty") {
  Ledger ledger;
  ledger.add({.wall_s = 0.5, .paths = 10});
  Entry full{.paths = 20};
  full.truth.emplace();
  full.total_rays = Band{1, 2, 3};
  ledger.add(full);
  const std::string csv = ledger.csv();
  std::vector<size_t> commas(1, 0);
  for (const char c : csv)
    if (c == '\n')
      commas.push_back(0);
    else
      commas.back() += c == ',';
  REQUIRE(commas.size() == 4);
  CHECK(commas[0] == commas[1]);
  CHECK(commas[0] == commas[2]);
  CHECK(csv.find("\n0.5,0,0,0,10,") != std::string::npos);
  CHECK(csv.find(",1,2,3\n") != std::string::npos);
}

TEST_CASE("time to a smaller error: the law is found, the truth lies within the band") {
  for (const double exponent : {0.5, 0.65, 0.9}) {
    for (const double wobble : {0.0, 0.05}) {
      CAPTURE(exponent, wobble);
      const Ledger ledger = render(exponent, 100000, wobble);
      CHECK(fit(ledger).exponent == Approx(exponent).margin(wobble > 0 ? 0.06 : 1e-6));
      const double target = 0.25 * 2 * std::pow(1000.0, -exponent);
      const double truth = 100 * std::pow(4, 1 / exponent);
      const auto band = seconds_to(ledger, target);
      REQUIRE(band);
      CHECK(band->low <= truth);
      CHECK(band->high >= truth);
      CHECK(band->low <= band->middle);
      CHECK(band->middle <= band->high);
      CHECK(band->middle == Approx(truth).epsilon(wobble > 0 ? 0.4 : 0.06));
    }
  }
  // What was prepared before the first sample takes its time once: a forecast does not scale it.
  Ledger prepared;
  const Ledger plain = render(0.5, 100000);
  for (Entry e : plain.entries()) e.prepared_s = 40, e.wall_s += 40, prepared.add(e);
  for (const double target : {0.03, 0.01}) {
    const auto with = seconds_to(prepared, target), without = seconds_to(plain, target);
    REQUIRE((with && without));
    CHECK(with->middle == Approx(without->middle + 40));
    CHECK(with->high == Approx(without->high + 40));
  }
  // Reached: when it was.
  const auto reached = seconds_to(render(0.5, 100000), 0.2);  // at 100 samples, 10 s
  REQUIRE(reached);
  CHECK(reached->low == reached->high);
  CHECK(reached->middle == Approx(10).epsilon(0.26));
  CHECK(reached->middle >= 10);
  CHECK_FALSE(seconds_to(Ledger(), 0.1));
  CHECK_FALSE(seconds_to(render(0.5, 1000), 0));
  CHECK(fit(Ledger()).exponent == 0.5);
}

TEST_CASE("paths of an adaptive render: easy tiles stop at the minimum, hard ones go on, the cap holds") {
  // Even with 2 samples, where the hard tile's error is at its ceiling.
  for (const double samples : {2.0, 32.0}) {
    CAPTURE(samples);
    const auto list = tiles(16, 0.1, 1.0, samples);
    // Tile 0 needs this many, its three neighbours run along until it is at twice the target.
    const double target = 0.05, ceiling = 1 / (k_saturated_error * k_saturated_error);
    const double own = 1 / (target * target) - ceiling, beside = 0.25 / (target * target) - ceiling;
    CHECK(samples_to(list[0], target) == Approx(own));
    const Band band = total_paths(list, 4, target, 64, 1e6);
    CHECK(band.middle == Approx(256 * (own + 3 * beside + 12 * 64)).epsilon(1e-6));
    CHECK(band.low < band.middle);
    CHECK(band.high > band.middle);
    CHECK(total_paths(list, 4, target, 64, 100).high <= 256 * (4 * 100 + 12 * 64) * 1.0001);
  }
  auto closed = tiles(4, 1, 1, 100);
  for (TileProgress& t : closed) t.open = false;
  CHECK(total_paths(closed, 2, 1e-3, 64, 1e6).high == 4 * 256 * 100);
  CHECK(total_paths({}, 0, 0.1, 2, 10).high == 0);
  // Where the error is beyond its ceiling, or not known, the answer stays a number.
  CHECK(std::isfinite(samples_to({.error = 1.2, .samples = 2, .pixels = 256}, 0.01)));
  CHECK(samples_to({.error = 0, .samples = 8, .pixels = 256}, 0.01) == 8);
  CHECK(samples_to({.error = 0.1, .samples = 8, .pixels = 256}, 5) < 8);
}
