// links: stats
// The ledger's entries, and forecasts for synthetic renders with a known law.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "stats/forecast.h"

namespace stats_tests {

using namespace lucerna::stats;

namespace {

/// A render whose error is c * work^-exponent, one second per thousand paths.
Ledger render(double exponent, uint64_t paths, double wobble = 0) {
  Ledger ledger;
  for (uint64_t p = 100; p <= paths; p += 100) {
    if (!ledger.due(p, 100)) continue;
    Entry e;
    e.has_error = true, e.degrees = 2000, e.paths = p, e.rays = 5 * p, e.samples = double(p) / 100,
    e.wall_s = 1e-3 * double(p);
    for (double& x : e.error)
      x = 2 * std::pow(double(p) / 100, -exponent) * (1 + wobble * std::sin(double(ledger.entries().size())));
    ledger.add(e);
  }
  return ledger;
}

/// Error of a tile after that many samples by the law of forecast.h, with this noise of one sample.
double tile_error(double noise, double samples, double k) {
  return std::pow(std::pow(k_saturated_error, -k) + std::pow(samples / (noise * noise), 0.5 * k), -1 / k);
}

/// Tiles that follow the law; tile 0 is the hard one.
std::vector<TileProgress> tiles(uint32_t count, double easy, double hard, double samples, double k) {
  std::vector<TileProgress> list(count);
  for (uint32_t t = 0; t < count; ++t) {
    const double noise = t == 0 ? hard : easy;
    list[t] = {.error = tile_error(noise, samples, k),
               .samples = samples,
               .pixels = 256,
               .earlier_error = tile_error(noise, samples / 2, k),
               .earlier_samples = samples / 2};
  }
  return list;
}

}  // namespace

TEST_CASE("an entry each time the work has grown by half, later by a quarter, and one for the end") {
  Ledger ledger;
  CHECK_FALSE(ledger.due(0, 10));
  CHECK_FALSE(ledger.due(19, 10));  // fewer than two samples per pixel: no error estimate
  CHECK(ledger.due(20, 10));
  ledger.add({.paths = 20});
  CHECK_FALSE(ledger.due(29, 10));
  CHECK(ledger.due(30, 10));
  ledger.add({.paths = 1000});
  CHECK_FALSE(ledger.due(1249, 10));
  CHECK(ledger.due(1250, 10));
  ledger.add({.paths = 1000, .rays = 7});  // the same moment again replaces the entry
  REQUIRE(ledger.entries().size() == 2);
  CHECK(ledger.entries()[1].rays == 7);
  CHECK(render(0.5, 1000000).entries().size() < 60);
}

TEST_CASE("CSV: the same number of fields in every line, unknown ones empty") {
  Ledger ledger;
  ledger.add({.wall_s = 0.5, .paths = 10});
  Entry full{.paths = 20};
  full.truth.emplace();
  full.total_rays = Band{1, 2, 3};
  full.has_error = true;
  full.layers = {0.25, 0.5}, full.of_mean.layers = {0.125, 1};
  full.truth_of_layers = {std::nullopt, 2};
  ledger.name_layers({"mirrored", "near"});
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
  CHECK(csv.find(",1,2,3,0.25,0.5,0.125,1,,2\n") != std::string::npos);
  CHECK(csv.find(",seen_mirrored,seen_near,of_mean_mirrored,of_mean_near,truth_mirrored,truth_near\n") !=
        std::string::npos);
}

TEST_CASE("time to a smaller error: the law is found, and the band contains the truth") {
  for (const double exponent : {0.5, 0.6, 1.0}) {
    for (const double wobble : {0.0, 0.03}) {
      CAPTURE(exponent, wobble);
      const Ledger ledger = render(exponent, 100000, wobble);
      const Outlook outlook(ledger);
      REQUIRE(outlook.known());
      CHECK(outlook.exponent() == Approx(exponent).margin(wobble > 0 ? 0.15 : 0.05));
      const double target = 0.25 * 2 * std::pow(1000.0, -exponent);
      const double truth = 100 * std::pow(4, 1 / exponent);
      const auto band = seconds_to(ledger, target);
      REQUIRE(band);
      CHECK(band->low <= truth);
      CHECK(band->high >= truth);
      CHECK(band->low <= band->middle);
      CHECK(band->middle <= band->high);
      CHECK(band->high < 5 * band->low);
      CHECK(band->middle == Approx(truth).epsilon(wobble > 0 ? 0.4 : 0.2));
    }
  }
  // Preparation before the first sample takes its time once: a forecast does not scale it.
  Ledger prepared;
  const Ledger plain = render(0.5, 100000);
  for (Entry e : plain.entries()) e.prepared_s = 40, e.wall_s += 40, prepared.add(e);
  for (const double target : {0.03, 0.01}) {
    const auto with = seconds_to(prepared, target), without = seconds_to(plain, target);
    REQUIRE((with && without));
    CHECK(with->middle == Approx(without->middle + 40));
    CHECK(with->high == Approx(without->high + 40));
  }
  // Already reached: the time between two entries; an entry without an error does not count, even as the
  // last.
  const auto reached = seconds_to(render(0.5, 100000), 0.21);
  REQUIRE(reached);
  CHECK(reached->low == reached->high);
  CHECK(reached->middle == Approx(0.1 * 4 / 0.21 / 0.21).epsilon(0.02));
  Ledger unreported = render(0.5, 1000);
  Entry nothing = unreported.entries().back();
  nothing.has_error = false, nothing.paths *= 2, nothing.error = {};
  unreported.add(nothing);
  CHECK_FALSE(seconds_to(unreported, 10));
  CHECK_FALSE(seconds_to(Ledger(), 0.1));
  CHECK_FALSE(seconds_to(render(0.5, 1000), 0));
}

TEST_CASE(
    "the error of records and interpolation is never forecast to be undercut, nor reported as reached") {
  Ledger plain = render(0.5, 3000000), ledger;
  for (Entry e : plain.entries()) {
    e.records = 0.03, e.interpolation = 0.02;
    ledger.add(e);
  }
  CHECK(ledger.entries().back().sum() > 0.05);
  CHECK(ledger.entries().back().floor() == Approx(0.05));
  // The paths alone have reached both.
  REQUIRE(plain.entries().back().error[0] < 0.04);
  REQUIRE(seconds_to(plain, 0.04));
  CHECK(paths_target(plain, 0.04) == 0.04);
  CHECK(paths_target(ledger, 0.04) == 0);
  CHECK_FALSE(seconds_to(ledger, 0.04));
  CHECK_FALSE(seconds_to(ledger, 0.0499));
  // A reachable target is reached when paths and records together are below it: later than by paths alone.
  CHECK(paths_target(ledger, 0.06) == Approx(std::sqrt(0.04 * 0.04 - 0.03 * 0.03)));
  const auto sum = seconds_to(ledger, 0.06), paths = seconds_to(plain, 0.06);
  REQUIRE(sum);
  REQUIRE(paths);
  CHECK(sum->middle > 2 * paths->middle);
}

TEST_CASE("there is no forecast before enough entries exist, and wider bands for few pixels") {
  CHECK_FALSE(Outlook(Ledger()).known());
  for (const uint64_t samples : {2, 4, 8, 12}) CHECK_FALSE(seconds_to(render(0.5, 100 * samples), 0.01));
  CHECK(seconds_to(render(0.5, 2000), 0.01));
  // A render observed only from its middle has no past to extrapolate.
  Ledger late;
  const Ledger whole = render(0.5, 3000), plain = render(0.5, 10000);
  for (const Entry& e : whole.entries())
    if (e.samples > 16) late.add(e);
  REQUIRE(late.entries().size() < 3);
  CHECK_FALSE(seconds_to(late, 0.01));
  // Few degrees of freedom: a wider band with about the same middle.
  const auto with_degrees = [&](double degrees) {
    Ledger ledger;
    for (Entry e : plain.entries()) e.degrees = degrees, ledger.add(e);
    return *seconds_to(ledger, 0.05);
  };
  const Band few = with_degrees(20), many = with_degrees(5000);
  CHECK(few.high / few.low > 1.5 * (many.high / many.low));
}

TEST_CASE("the 90 % band contains the truth of synthetic renders in nine cases of ten") {
  // Pixels whose halves differ by a random walk, with noise that falls as 1/N^(1 + q) for some and 1/N for
  // the rest; a ledger's error is the sum of the squares.
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  constexpr int k_pixels = 400, k_renders = 200;
  int reported = 0, in = 0, low = 0, pairs = 0, steady = 0;
  double width = 0;
  for (int render = 0; render < k_renders; ++render) {
    const double q = 0.25 + 0.75 * uniform(random), bend = std::pow(10, 2 * uniform(random) - 0.5);
    std::vector<double> walk(k_pixels, 0), sigma(k_pixels);
    for (double& s : sigma) s = std::exp(1.0 * normal(random));  // some are much noisier
    Ledger ledger;
    std::vector<Entry> all;
    double done = 0;
    for (double n = 2; n < 1200; n = std::floor(n * 1.3 + 1)) {
      double sum = 0, fourth = 0;
      for (int p = 0; p < k_pixels; ++p) {
        walk[p] += std::sqrt(n - done) * normal(random);
        const double v = sigma[p] * sigma[p] * walk[p] * walk[p] / (n * n) * (1 + bend * std::pow(n, -q));
        sum += v, fourth += v * v;
      }
      done = n;
      Entry e;
      e.has_error = true, e.samples = n, e.paths = uint64_t(n * k_pixels), e.rays = 5 * e.paths;
      e.wall_s = e.render_s = 0.1 * n, e.error[0] = std::sqrt(sum / k_pixels);
      e.degrees = 3 * sum * sum / fourth;
      all.push_back(e);
    }
    const double target = all.back().error[0];
    std::optional<Band> before;
    for (const Entry& e : all) {
      ledger.add(e);
      if (e.error[0] <= target) break;  // reached by chance, before the end
      if (e.samples > 500) break;
      const auto band = seconds_to(ledger, target);
      CHECK(band.has_value() == (e.samples >= 16));
      if (!band) continue;
      // The truth: where the error stays below the target.
      Ledger whole;
      for (const Entry& line : all) whole.add(line);
      const double truth = seconds_to(whole, target)->middle;
      ++reported, in += band->low <= truth && truth <= band->high, low += truth > band->high;
      if (before) ++pairs, steady += before->low <= band->middle && band->middle <= before->high;
      before = band;
      width += std::log(band->high / band->low);
    }
  }
  INFO(reported << " forecasts, " << in << " held the truth, " << low << " were too short; on average "
                << std::exp(width / reported) << " from end to end");
  REQUIRE(reported > 1000);
  CHECK(in > 0.88 * reported);
  CHECK(low < 0.1 * reported);
  // Each forecast lies within the previous one.
  CHECK(steady > 0.97 * pairs);
  CHECK(std::exp(width / reported) < 5);
}

TEST_CASE(
    "paths of an adaptive render: easy tiles stop at the minimum, hard ones continue, the maximum holds") {
  for (const double samples : {16.0, 64.0})
    for (const double k : {0.8, 1.2, 2.0}) {
      CAPTURE(samples, k);
      const auto list = tiles(16, 0.1, 1.0, samples, k);
      // Tile 0 needs this many samples; its three neighbours run along until it is at twice the target.
      const double target = 0.05;
      const auto needed = [&](double error) {
        return std::pow(std::pow(error, -k) - std::pow(k_saturated_error, -k), 2 / k);
      };
      const double own = needed(target), beside = std::max(64.0, needed(2 * target));
      CHECK(samples_to(list[0], target, k) == Approx(own));
      const auto band = total_paths(list, 4, target, 64, 1e6);
      REQUIRE(band);
      const double truth = 256 * (own + 3 * beside + 12 * 64);
      CHECK(band->low < truth);
      CHECK(band->high > truth);
      CHECK(band->middle == Approx(truth).epsilon(0.25));
      CHECK(band->high < 5 * band->low);
      CHECK(total_paths(list, 4, target, 64, 100)->high <=
            256 * (4 * 100 + 12 * 64) * 1.0001 + 256 * 12 * 36);
      // Earlier samples determine the law: without them the band is wider.
      auto unknown = list;
      for (TileProgress& t : unknown) t.earlier_samples = 0;
      const auto wide = total_paths(unknown, 4, target, 64, 1e6);
      CHECK(wide->high / wide->low > band->high / band->low);
    }
  auto closed = tiles(4, 1, 1, 100, 1);
  for (TileProgress& t : closed) t.open = false;
  CHECK(total_paths(closed, 2, 1e-3, 64, 1e6)->high == 4 * 256 * 100);
  CHECK(total_paths({}, 0, 0.1, 2, 10)->high == 0);
  // No forecast from few samples, unless no tile is open.
  CHECK_FALSE(total_paths(tiles(4, 1, 1, 8, 1), 2, 0.05, 64, 1e6));
  // If the error is above its ceiling, or unknown, the result stays finite.
  CHECK(std::isfinite(samples_to({.error = 1.2, .samples = 2, .pixels = 256}, 0.01, 1)));
  CHECK(samples_to({.error = 0, .samples = 8, .pixels = 256}, 0.01, 1) == 8);
  CHECK(samples_to({.error = 0.1, .samples = 8, .pixels = 256}, 5, 1) < 8);
}

TEST_CASE("an open tile whose error rises is never counted as finished") {
  for (const double jump : {1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 1e4, 1e8}) {
    CAPTURE(jump);
    std::vector<TileProgress> list(4, {.error = 0.01, .samples = 64, .pixels = 256, .open = false});
    list[0] = {.error = 0.02 * jump,
               .samples = 64,
               .pixels = 256,
               .open = true,
               .earlier_error = 0.02,
               .earlier_samples = 32};
    const double now = 4 * 64 * 256.0, most = (1024 + 3 * 64) * 256.0;
    const auto band = total_paths(list, 2, 0.01, 16, 1024);
    REQUIRE(band);
    CHECK(band->low > 1.05 * now);
    CHECK(band->middle > 1.5 * now);
    CHECK(band->low <= band->middle);
    CHECK(band->middle <= band->high);
    CHECK(band->high <= 1.0001 * most);
    // From twenty times the target it is far: close to the maximum.
    if (jump >= 10) CHECK(band->high > 0.9 * most);
  }
}

TEST_CASE("the error at the end of a render with a fixed number of samples lies within its band") {
  for (const double exponent : {0.5, 0.6}) {
    const Ledger ledger = render(exponent, 20000);  // 200 samples per pixel
    const auto band = error_at(ledger, 1000);
    REQUIRE(band);
    const double truth = 2 * std::pow(1000.0, -exponent);
    CHECK(band->low < truth);
    CHECK(band->high > truth);
    CHECK(band->high < 2 * band->low);
    // It is the inverse of the time to that error.
    const auto seconds = seconds_to(ledger, band->middle);
    REQUIRE(seconds);
    CHECK(seconds->middle == Approx(100).epsilon(0.1));
  }
  CHECK_FALSE(error_at(render(0.5, 800), 1000));
}

TEST_CASE("a changing speed widens the band of seconds in both directions") {
  Ledger slowing;
  const Ledger even = render(0.5, 100000);
  for (Entry e : even.entries()) {
    if (e.paths > 75000) e.wall_s += 3e-3 * (double(e.paths) - 75000);  // four times the time from here on
    slowing.add(e);
  }
  CHECK(spread_of_pace(even) == Approx(0.05));
  CHECK(spread_of_pace(slowing) > 0.2);
  const auto wide = seconds_to(slowing, 0.02), plain = seconds_to(even, 0.02);
  REQUIRE((wide && plain));
  CHECK(wide->high / wide->low > 1.3 * (plain->high / plain->low));
}

TEST_CASE("the remaining time of work of estimated size does not jump") {
  // Relighting as measured: the first rays cost eight times as much, the estimated cost per ray reaches the
  // truth within a quarter of the work, and estimates are occasionally off by a tenth.
  WorkPace pace;
  std::vector<double> totals;
  const double work = 1000;
  double seconds = 0, left_before = 1e9;
  for (double done = 0; done < work; done += 10) {
    const double estimate = work * (1 + 4 * std::exp(-done / 60) + 0.1 * std::sin(done));
    const double left = std::max(estimate - done, 0.04 * done);
    if (const auto rest = pace.follow(seconds, done, left)) {
      CHECK(seconds >= WorkPace::k_least_seconds);
      CHECK(*rest >= 0);
      // It counts down: it never rises by more than a tenth.
      CHECK(*rest < 1.1 * left_before);
      left_before = *rest;
      totals.push_back(seconds + *rest);
    }
    seconds += done < 50 ? 0.8 : 0.1;
  }
  REQUIRE(totals.size() > 60);
  for (const double total : totals) {
    CHECK(total < 1.6 * seconds);
    CHECK(total > seconds / 1.6);
  }
  for (size_t i = 1; i < totals.size(); ++i) CHECK(totals[i] == Approx(totals[i - 1]).epsilon(0.12));
  // The next work starts from zero.
  CHECK_FALSE(pace.follow(seconds + 1, 5, 100));
}

}  // namespace stats_tests
