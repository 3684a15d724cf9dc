// links: ui
// The computations of the Accuracy panel: axes, texts, forecasts, earlier runs. Without a window.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "ui/accuracy_plot.h"
#include "ui/chart.h"

namespace accuracy_tests {

using namespace lucerna;
using namespace lucerna::ui;

namespace {

std::vector<std::string> labels(const LogAxis& axis, Unit unit, float room) {
  std::vector<std::string> texts;
  for (const Tick& t : ticks(axis, unit, room))
    if (t.labelled) texts.push_back(tick_text(t.value, unit));
  return texts;
}

/// A uniform render of `samples` passes of 0.5 s whose error falls with the root of the samples.
session::Accuracy uniform(int samples, double first_error = 0.8) {
  session::Accuracy a;
  a.run = 1, a.scene_id = 1, a.max_samples = 100000, a.pixels = 1000;
  for (double n = 1; n <= samples; n *= 1.25) {
    stats::Entry e;
    e.has_error = true, e.wall_s = e.render_s = e.device_s = 0.5 * n;
    e.samples = n, e.paths = static_cast<uint64_t>(1000 * n), e.rays = 5 * e.paths;
    e.error = {first_error / std::sqrt(n), 0.5 * first_error / std::sqrt(n),
               0.01 * first_error / std::sqrt(n), 0, 0};
    a.ledger.add(e);
    a.hardest.push_back(0);
  }
  a.paths = 1000.0 * samples, a.rays = 5 * a.paths;
  a.settings["sampling.mode"] = "uniform";
  return a;
}

/// The same in adaptive sampling: four tiles of which one is hard.
session::Accuracy adaptive(double target) {
  session::Accuracy a = uniform(64);
  a.adaptive = true, a.target = target;
  a.min_samples = 16, a.max_samples = 4096, a.tile = 16, a.across = 2;
  for (const double sigma : {0.2, 0.3, 0.4, 2.0}) {
    session::TileStatus t;
    t.samples = 64, t.pixels = 250;
    t.error = static_cast<float>(sigma / 8);
    t.earlier_samples = 32, t.earlier_error = static_cast<float>(sigma / std::sqrt(32.0));
    t.state = double{t.error} <= target ? shared::k_tile_done : shared::k_tile_active;
    a.tiles.push_back(t);
  }
  for (double& h : a.hardest) h = 0.25;
  return a;
}

}  // namespace

TEST_CASE("a logarithmic axis maps both ways, and values that cannot be drawn are outside") {
  const LogAxis x{0.1, 1000, 50, 450}, up{0.001, 1, 180, 20};
  CHECK(x.at(0.1) == Approx(50));
  CHECK(x.at(10) == Approx(250));
  CHECK(up.at(1) == Approx(20));
  for (const double v : {0.1, 0.37, 5.0, 999.0}) CHECK(x.value(x.at(v)) == Approx(v).epsilon(1e-4));
  for (const double v : {0.001, 0.05, 0.9}) CHECK(up.value(up.at(v)) == Approx(v).epsilon(1e-4));
  for (const double v : {0.0, -3.0, 1e-300}) CHECK(x.at(v) < 50);
  CHECK(x.at(1e300) > 450);
  CHECK(up.at(0) > 180);
}

TEST_CASE("ticks: 1-2-5 with enough room, otherwise decades, and never overlapping") {
  const LogAxis percent{0.001, 1, 400, 0};
  CHECK(labels(percent, Unit::relative, 20) == std::vector<std::string>{"0.1 %", "0.2 %", "0.5 %", "1 %",
                                                                        "2 %", "5 %", "10 %", "20 %", "50 %",
                                                                        "100 %"});
  CHECK(labels(percent, Unit::relative, 60) == std::vector<std::string>{"0.1 %", "1 %", "10 %", "100 %"});
  CHECK(labels({1, 7200, 0, 600}, Unit::seconds, 20) ==
        std::vector<std::string>{"1 s", "2 s", "5 s", "10 s", "20 s", "1 min", "2 min", "5 min", "10 min",
                                 "20 min", "1 h", "2 h"});
  CHECK(labels({0.01, 200000, 0, 300}, Unit::seconds, 40).size() >= 3);
  for (const Unit unit : {Unit::seconds, Unit::relative, Unit::count, Unit::milliseconds})
    for (double lo = 1e-4; lo < 100; lo *= 3)
      for (const double span : {4.0, 50.0, 3e3, 1e6})
        for (const float width : {90.0f, 400.0f}) {
          const LogAxis axis{lo, lo * span, 0, width};
          float before = -1e9f;
          std::set<double> seen;
          for (const Tick& t : ticks(axis, unit, 30)) {
            CHECK(t.value >= lo * (1 - 1e-6));
            CHECK(t.value <= lo * span * (1 + 1e-6));
            CHECK(seen.insert(t.value).second);
            if (!t.labelled) continue;
            CHECK(axis.at(t.value) - before >= 30 - 1e-3f);
            before = axis.at(t.value);
          }
        }
  CHECK(tick_text(0.02, Unit::seconds) == "20 ms");
  CHECK(tick_text(20000, Unit::count) == "20k");
  CHECK(tick_text(1e9, Unit::count) == "1G");
  CHECK(tick_text(0.05, Unit::milliseconds) == "50 \xC2\xB5s");
}

TEST_CASE("round numbers") {
  CHECK(nice_below(0.037) == Approx(0.02));
  CHECK(nice_above(0.037) == Approx(0.05));
  for (const double v : {1e-3, 2e-3, 0.5, 1.0, 20.0, 5e4}) {
    CHECK(nice_below(v) == Approx(v));
    CHECK(nice_above(v) == Approx(v));
  }
  CHECK(nice_above(5.1) == Approx(10));
  CHECK(about_text(4.23) == "4.2 s");
  CHECK(about_text(42.4) == "42 s");
  CHECK(about_text(131) == "2 min 10 s");
  CHECK(about_text(100) == "1 min 40 s");
  CHECK(about_text(180) == "3 min");
  CHECK(about_text(12000) == "3 h 20 min");
  CHECK(about_text(14 * 3600) == "14 h");
  CHECK(about_text(5 * 86400) == "5 days");
  CHECK(about_text(3.2e7) == "1 year");
  CHECK(about_text(INFINITY) == "a century");
  CHECK(about_text(59.7) == "1 min");
  CHECK(about_text(3599) == "1 h");
  CHECK(percent_text(0.0182) == "1.82 %");
  CHECK(percent_text(0.182) == "18.2 %");
  CHECK(percent_text(1.82) == "182 %");
  CHECK(percent_text(25.52) == "> 999 %");
}

TEST_CASE("a dragged target is rounded to two figures within the setting's range") {
  CHECK(snapped_target(0.01234) == Approx(0.012));
  CHECK(snapped_target(0.0999) == Approx(0.1));
  CHECK(snapped_target(3.456) == Approx(3.5));
  CHECK(snapped_target(1e-9) == Approx(0.0001));
  CHECK(snapped_target(50) == 10);
  // Along a drag over the plot the value follows the pointer.
  const LogAxis up{0.001, 1, 180, 20};
  double before = 0;
  for (float y = 180; y >= 20; y -= 1) {
    const double v = snapped_target(up.value(y));
    CHECK(v >= before);
    CHECK(std::abs(up.at(v) - y) < 2);
    before = v;
  }
}

TEST_CASE("uniform sampling: the cost of a smaller error in words") {
  const session::Accuracy a = uniform(100);
  const double now = a.ledger.entries().back().wall_s, error = a.ledger.entries().back().error[0];
  // Four times the time for half the error, or slightly less: whether all error is noise is still unknown.
  const auto band = session::seconds_to(a, 0.5 * error);
  REQUIRE(band);
  CHECK(band->middle == Approx(4 * now).epsilon(0.2));
  CHECK(band->high > 4 * now);
  CHECK(band->low < band->middle);
  CHECK(band->high > band->middle);
  const auto texts = target_texts(a, 0.01, stats::Band{100, 130, 180}, now);
  CHECK(texts.at(0) == "1 % will take about 2 min 10 s (1 min 40 s to 3 min)");
  CHECK(texts.back() == "1 %");
  for (size_t i = 1; i < texts.size(); ++i) CHECK(texts[i].size() < texts[i - 1].size());
  // A wide range is given without its middle, a very wide one by its lower end only.
  CHECK(target_texts(a, 0.01, stats::Band{100, 200, 600}, now).at(0) == "1 % will take 1 min 40 s to 10 min");
  CHECK(target_texts(a, 0.01, stats::Band{100, 500, 3000}, now).at(0) ==
        "1 % will take more than 1 min 40 s");
  CHECK(target_texts(a, 0.01, stats::Band{100, 100.5, 101}, now).at(0) == "1 % will take about 1 min 40 s");
  for (const std::string& text : target_texts(a, 0.01, stats::Band{100, 130, 180}, now))
    if (text != "1 %") CHECK_THAT(text, Catch::Contains("1 min 40 s to 3 min"));
  const auto reached = session::seconds_to(a, 2 * error);
  REQUIRE(reached);
  CHECK_THAT(target_texts(a, 0.16, reached, now).at(0), Catch::StartsWith("16 % was reached after "));
  CHECK(target_texts({}, 0.01, {}, 0).at(0) == "1 %");
  // Too few samples: no forecast.
  const session::Accuracy early = uniform(12);
  CHECK_FALSE(session::seconds_to(early, 0.01));
  CHECK(target_texts(early, 0.01, {}, 6).at(0) == "1 %: no forecast yet");
}

TEST_CASE("a target beyond the last sample of uniform sampling is not promised") {
  session::Accuracy a = uniform(100);
  a.max_samples = 256;
  const double now = a.ledger.entries().back().wall_s;
  const auto end = session::seconds_to_end(a);
  REQUIRE(end);
  CHECK(*end == Approx(128).epsilon(0.02));
  // 0.8 / 16 = 5 % at the end.
  const auto text = [&](double target) {
    return target_texts(a, target, session::seconds_to(a, target), now);
  };
  CHECK_THAT(text(0.01).at(0),
             Catch::StartsWith("1 % will not be reached: Samples ends at 256, after 2 min 10 s at about "));
  CHECK_THAT(text(0.01).at(0), Catch::EndsWith("4.7 %"));
  CHECK(text(0.05).at(0) == "5 % may not be reached: Samples ends at 256, after 2 min 10 s");
  CHECK_THAT(text(0.07).at(0), Catch::StartsWith("7 % will take about "));
  for (const double target : {0.01, 0.05}) {
    const auto texts = text(target);
    for (size_t i = 1; i < texts.size(); ++i) CHECK(texts[i].size() < texts[i - 1].size());
  }
  session::Accuracy finished = uniform(260);
  finished.max_samples = 256, finished.finished = true;
  CHECK_THAT(target_texts(finished, 0.01, session::seconds_to(finished, 0.01), 128).at(0),
             Catch::StartsWith("1 % was not reached: Samples ended at 256, at "));
  CHECK_THAT(target_texts(finished, 0.1, session::seconds_to(finished, 0.1), 128).at(0),
             Catch::StartsWith("10 % was reached after "));
}

TEST_CASE(
    "noise has four figures: as seen, of the median tile, of the worst tenth of the tiles, of the mean") {
  stats::Entry line;
  line.has_error = true, line.error = {0.01, 0.01, 0, 0, 0}, line.tile_median = 0.04,
  line.tile_worst_tenth = 0.2;
  line.of_mean.error[0] = 0.15;
  const auto figures = error_figures(line);
  CHECK(figures[0].name == "as seen");
  CHECK(figures[1].name == "of the median tile");
  CHECK(figures[2].name == "of the worst tenth of the tiles");
  CHECK(figures[0].value == 0.01);
  CHECK(figures[1].value == 0.04);
  CHECK(figures[2].value == 0.2);
  CHECK(figures[3].name == "of the mean");
  CHECK(figures[3].value == 0.15);
  CHECK(figures.size() == 4);
  for (const ErrorFigure& f : figures) {
    CHECK_FALSE(f.short_name.empty());
    CHECK_FALSE(f.help.empty());
  }
  // The plot has room for them.
  session::Accuracy a = uniform(100);
  a.ledger.clear();
  line.wall_s = 1, line.paths = 100;
  a.ledger.add(line);
  CHECK(plot_range(a, {}, 0.01, {}, 1).e_hi >= 0.2);
}

TEST_CASE("with records the error has three more figures, and a target below their limit is not promised") {
  session::Accuracy a = uniform(100);
  stats::Ledger ledger;
  for (stats::Entry e : a.ledger.entries()) {
    e.records = 0.02, e.interpolation = 0.01;
    ledger.add(e);
  }
  a.ledger = ledger;
  const stats::Entry& last = a.ledger.entries().back();
  const auto figures = error_figures(last);
  REQUIRE(figures.size() == 7);
  CHECK(figures[0].value == Approx(std::hypot(last.error[0], 0.02) + 0.01));
  CHECK(figures[4].short_name == "paths");
  CHECK(figures[4].value == last.error[0]);
  CHECK(figures[5].short_name == "records");
  CHECK(figures[5].value == 0.02);
  CHECK(figures[6].short_name == "bias");
  CHECK(figures[6].value == 0.01);
  CHECK(present(a)->error == figures[0].value);
  CHECK_FALSE(session::seconds_to(a, 0.02));
  CHECK(target_texts(a, 0.02, {}, last.wall_s).at(0) ==
        "2 % will not be reached: lookups are the limit (3 %), more samples hardly help");
  session::Accuracy tiles = adaptive(0.05);
  tiles.finished = true;
  tiles.tiles[3].state = shared::k_tile_capped, tiles.tiles[3].records = 0.1f;
  CHECK(target_texts(tiles, 0.05, {}, 10).at(0) ==
        "1 of 4 tiles stay over 5 %: lookups are the limit, more samples hardly help");
}

TEST_CASE("with photons but no records only the bias is named") {
  session::Accuracy a = uniform(100);
  stats::Entry last = a.ledger.entries().back();
  CHECK_FALSE(looks_up(last));
  CHECK(error_figures(last).size() == 4);
  last.interpolation = 0.01;
  CHECK(looks_up(last));
  const auto figures = error_figures(last);
  REQUIRE(figures.size() == 6);
  CHECK(figures[0].value == Approx(last.error[0] + 0.01));
  CHECK(figures[4].short_name == "paths");
  CHECK(figures[5].short_name == "bias");
  CHECK(figures[5].value == 0.01);
  CHECK(figures[5].help.find("photons.radius") != std::string::npos);
}

TEST_CASE("adaptive sampling: the forecast counts the rays that the tiles still need") {
  const session::Accuracy a = adaptive(0.05);
  const auto band = session::seconds_to(a, 0.05);
  REQUIRE(band);
  // The hard tile needs (2 / 0.05)^2 = 1600 samples, the others are finished or almost.
  const double now = a.ledger.entries().back().wall_s, a_path = now / a.ledger.entries().back().paths;
  CHECK(band->middle > now + 0.7 * 250 * 1536 * a_path);
  CHECK(band->middle < now + 2 * 250 * 1536 * a_path);
  CHECK(band->low < now + 250 * 1536 * a_path);
  const auto tighter = session::seconds_to(a, 0.04), looser = session::seconds_to(a, 0.5);
  REQUIRE(tighter);
  REQUIRE(looser);
  CHECK(tighter->middle > band->middle);
  CHECK(looser->high == Approx(now).epsilon(0.3));
  CHECK_THAT(target_texts(a, 0.05, band, now).at(0), Catch::StartsWith("Every tile under 5 % will take "));

  // The hard tile would need more than the maximum.
  session::Accuracy few = a;
  few.max_samples = 512;
  CHECK(session::tiles_out_of_reach(a, 0.05) == 0);
  CHECK(session::tiles_out_of_reach(few, 0.05) == 1);
  CHECK_THAT(target_texts(few, 0.05, session::seconds_to(few, 0.05), now).at(0),
             Catch::StartsWith("1 of 4 tiles are likely to stay over 5 %, with all of 512 samples; "));

  session::Accuracy over = a;
  over.finished = true;
  over.tiles[3].state = shared::k_tile_capped;
  CHECK(target_texts(over, 0.05, band, now).at(0) == "1 of 4 tiles stay over 5 %, with all of 4096 samples");
  over.tiles[3].state = shared::k_tile_done;
  CHECK(target_texts(over, 0.05, stats::Band{60, 60, 60}, 60).at(0) == "Every tile under 5 % after 1 min");
}

TEST_CASE("the plot contains its lines, its target and, within limits, its forecast") {
  const session::Accuracy a = uniform(100);
  const PlotRange r = plot_range(a, {}, 0.01, stats::Band{3000, 6000, 1e9}, 50);
  CHECK(r.t_lo <= 0.5);
  CHECK(r.t_hi >= 50);
  CHECK(r.t_hi <= 50 * 300 * 2);  // the forecast is limited
  CHECK(r.e_lo < 0.01);
  CHECK(r.e_hi >= 0.8);
  // Earlier runs count.
  std::deque<Run> earlier{{std::make_shared<session::Accuracy>(uniform(2000, 9)), {}, nullptr, 0, 0}};
  const PlotRange wide = plot_range(a, earlier, 0.01, {}, 50);
  CHECK(wide.t_hi >= 500);
  CHECK(wide.e_hi >= 9);
  const PlotRange none = plot_range({}, {}, 0.05, {}, 0);
  CHECK(none.t_lo > 0);
  CHECK(none.t_hi > none.t_lo);
  CHECK(none.e_hi > none.e_lo);
}

TEST_CASE("earlier runs of a scene are kept and compared, and discarded with it") {
  Runs runs;
  const auto scene = std::make_shared<scene::Scene>();
  session::Snapshot s;
  s.width = 320, s.height = 200;
  const auto show = [&](session::Accuracy a, uint64_t run, uint64_t scene_id = 1) {
    a.run = run, a.scene_id = scene_id;
    s.accuracy = std::make_shared<session::Accuracy>(a);
    runs.follow(s, scene);
  };
  show(uniform(3), 1);
  show(uniform(100), 1);  // the same run, further on
  CHECK(runs.earlier().empty());
  show(adaptive(0.05), 2);
  CHECK(runs.earlier().size() == 1);
  CHECK(runs.earlier()[0].accuracy->ledger.entries().size() == uniform(100).ledger.entries().size());
  show(uniform(2), 3);  // too short to be drawn: it leaves no line
  show(uniform(2), 4);
  CHECK(runs.earlier().size() == 2);
  session::Accuracy changed = uniform(100);
  changed.settings["sampling.mode"] = "adaptive", changed.settings["film.ev"] = "2";
  show(changed, 5);
  s.width = 640;
  CHECK(runs.earlier().size() == 2);
  show(changed, 6);
  const auto reported = differences(runs.earlier().back(), runs.current());
  REQUIRE(reported.size() == 2);
  CHECK(reported[0] == "sampling.mode uniform (now adaptive)");
  CHECK_THAT(reported[1], Catch::StartsWith("320 \xC3\x97 200 pixels"));
  CHECK(differences(runs.current(), runs.current()).empty());
  Run lit = runs.current();
  auto dark = std::make_shared<scene::Scene>();
  dark->environment.scale = 0.5f;
  lit.scene = dark;
  CHECK(differences(lit, runs.current()) == std::vector<std::string>{"other lights"});
  for (uint64_t run = 10; run < 20; ++run) show(uniform(100), run);
  CHECK(runs.earlier().size() == Runs::k_most);
  runs.clear();
  CHECK(runs.earlier().empty());
  show(uniform(100), 30);
  CHECK(runs.earlier().size() == 1);
  show(uniform(100), 31, 2);
  CHECK(runs.earlier().empty());
}

}  // namespace accuracy_tests
