// links: irradiance_cache
// The report of an irradiance cache as plain data: texts of the status bar, sections of the panel, legends,
// the card of a point.
#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/irradiance_cache/info.h"
#include "solvers/irradiance_cache/report.h"

namespace cache_report_tests {

using namespace lucerna;
using namespace lucerna::irradiance_cache;
using Catch::Contains;

namespace {

OptionValues settings() { return OptionValues(info().options); }

/// A complete cache of two passes.
CacheReport complete() {
  CacheReport c;
  c.room = 1000, c.placed = 120;
  c.status.pass = 2, c.status.records = 120, c.status.rays = 64 * 120;
  for (uint32_t i = 0; i < 2; ++i) {
    CachePass p;
    p.number = i, p.complete = true, p.paths = 1000, p.uncovered = i == 0 ? 500 : 1;
    p.records = i == 0 ? 100 : 20, p.rays = 64 * p.records, p.tried = 150, p.clusters = 40;
    for (size_t k = 0; k < p.ms.size(); ++k) p.ms[k] = double(k + 1);
    c.status.passes.push_back(p);
  }
  c.status.last = StageDone{.stage = BuildStage::octree, .pass = 1, .ms = 3};
  c.status.stop = StopReason::covered;
  return c;
}

const solvers::PanelSection& section(const solvers::Report& r, const std::string& title) {
  for (const auto& s : r.sections)
    if (s.title == title) return s;
  FAIL("no section " << title);
  return r.sections[0];
}

template <class T>
const T& item(const solvers::PanelSection& s) {
  for (const auto& i : s.items)
    if (const T* found = std::get_if<T>(&i)) return *found;
  FAIL("no such item in " << s.title);
  return std::get<T>(s.items[0]);
}

std::string value_of(const solvers::PanelSection& s, const std::string& name) {
  for (const auto& i : s.items)
    if (const auto* row = std::get_if<solvers::ValueRow>(&i); row && row->name == name) return row->value;
  return "";
}

/// The card's text with much or little room.
std::string words_of(const solvers::Card& card, solvers::Card::Room room) {
  std::string text;
  for (const auto& line : card.lines) {
    if (line.room != solvers::Card::Room::any && line.room != room) continue;
    if (const auto* title = std::get_if<solvers::Card::Title>(&line.what))
      text += title->left + "|" + title->right + "\n";
    if (const auto* row = std::get_if<solvers::Card::Row>(&line.what))
      text += row->name + "|" + row->value + "\n";
    if (const auto* note = std::get_if<solvers::Card::Note>(&line.what)) text += note->text + "\n";
    if (const auto* f = std::get_if<solvers::Card::Figures>(&line.what)) text += f->name + "\n";
    if (const auto* w = std::get_if<solvers::Card::Weight>(&line.what)) text += "weight " + w->name + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("the status bar's text follows the build") {
  CacheReport c = complete();
  solvers::Report r = make_report(c, settings());
  CHECK(r.solver == info().name);
  CHECK((r.ready && !r.waits && r.preparing.empty() && r.state == "complete"));
  CHECK(r.refining.empty());
  c.refines = true;
  CHECK(make_report(c, settings()).refining == "refining records");
  c.refines = false;
  c.status.stop = StopReason::building, c.placed = 2810;
  r = make_report(c, settings());
  CHECK((!r.ready && !r.waits && r.state == "building"));
  CHECK(r.preparing == "cache, pass 3: 2810 records");
  c.placed = 0;
  CHECK(make_report(c, settings()).preparing == "cache, pass 3: choosing places for records");
  c.placed = 2810;
  c.status.relighting.records = 100, c.status.relighting.share = 0.4f;
  CHECK(make_report(c, settings()).preparing == "cache: relighting 100 records, 40 %");
  c.status.waits = true, c.status.last = StageDone{.stage = BuildStage::probe};
  r = make_report(c, settings());
  CHECK((r.waits && !r.ready && r.state == "waits"));
  CHECK(r.preparing == "cache waits: probe, pass 1");
  CHECK_THAT(r.to_go_on, Contains("cache.run continues"));
  CHECK(r.figure("records") == 120);
  CHECK(r.figure("stage") == double(BuildStage::probe));
  CHECK(r.figure("nothing of that name") == 0);
}

TEST_CASE("the panel shows numbers, steps and passes, each step with its text") {
  CacheReport c = complete();
  OptionValues s = settings();
  solvers::Report r = make_report(c, s);
  REQUIRE(r.sections.size() == 4);
  const auto& numbers = section(r, "Cache");
  CHECK(numbers.note == "complete");
  CHECK(value_of(numbers, "Records") ==
        "120 of 1\xE2\x80\x88"
        "000");
  CHECK(value_of(numbers, "Passes") == "2 of 12");
  CHECK(value_of(numbers, "New candidates, last pass") == "0.10 %");
  CHECK(value_of(numbers, "Pixels without records") == "\xE2\x80\x93");
  const auto& strip = item<solvers::StepStrip>(section(r, "Stages of building"));
  CHECK(strip.steps.size() == k_build_stages.size());
  CHECK(strip.last == int(BuildStage::octree));
  for (const auto& button : item<solvers::CommandButtons>(section(r, "Stages of building")).buttons) {
    CHECK(solvers::find_command(info(), button.command) != nullptr);
    CHECK_FALSE(button.enabled);
  }
  const auto& passes = section(r, "Passes of building");
  const auto& table = item<solvers::Table>(passes);
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0].bar == 1);
  CHECK(table.rows[0].cells.size() == table.columns.size());
  CHECK_THAT(table.rows[1].help, Contains("Pass 2: 1 of 1\xE2\x80\x88"
                                          "000 paths found no record"));
  const auto& parts = item<solvers::Parts>(passes).parts;
  REQUIRE(parts.size() == k_build_steps.size());
  double sum = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    sum += double{parts[i].share};
    CHECK(parts[i].host == (parts[i].name == "choose"));
    for (size_t k = 0; k < i; ++k) CHECK(parts[i].help != parts[k].help);
  }
  CHECK(sum == Approx(1));
  CHECK(parts.back().name == "octree");
  CHECK_THAT(parts.back().help, Contains("octree"));

  Overlap o;
  o.pixels = 100, o.served = 70, o.gathered = 20, o.mean = 2.5, o.most = 3, o.histogram = {30, 10, 20, 40};
  o.histogram.resize(33);
  c.overlap = o;
  r = make_report(c, s);
  CHECK(value_of(section(r, "Cache"), "Pixels without records") == "10.0 %");
  const auto& columns = item<solvers::Histogram>(section(r, "Cache")).columns;
  REQUIRE(columns.size() == 13);
  CHECK(columns[3].height == 1);
  CHECK(columns[0].lower == Approx(20.0 / 30));
  CHECK_THAT(columns[1].help, Contains("10.0 % of the pixels: served by 1 record."));
  // The pyramid's level has a control while it is shown.
  const auto rows = [&] {
    size_t n = 0;
    const solvers::Report report = make_report(c, s);
    for (const auto& i : section(report, "Overlays").items)
      n += std::holds_alternative<solvers::OptionRow>(i);
    return n;
  };
  CHECK(rows() == 3);
  s.set("overlay.discontinuity", "geometry");
  CHECK(rows() == 4);
}

TEST_CASE("every active view has its legend") {
  CacheReport c = complete();
  OptionValues s = settings();
  CHECK(make_report(c, s).legends.empty());
  s.set("overlay.records", "true"), s.set("overlay.overlap", "true");
  s.set("overlay.discontinuity", "irradiance"), s.set("overlay.discontinuity_level", "2");
  c.placement = PlacementShow::chosen;
  std::vector<solvers::Legend> all = make_report(c, s).legends;
  REQUIRE(all.size() == 4);
  CHECK(all[0].title == "Records, by the pass that placed them");
  CHECK(all[0].marks.size() == 2);
  CHECK(all[1].marks[1].text == "130 rejected");
  CHECK((all[2].ramp && all[2].ticks.size() == 4 && all[2].marks.size() == 2 && !all[2].marks_in_line));
  CHECK(all[3].title == "Detail of irradiance, cells of 4 pixels");
  c.color = shared::k_record_by_distance, c.scale = {0.1f, 7};
  c.placement = PlacementShow::clusters;
  all = make_report(c, s).legends;
  REQUIRE(all[0].range);
  CHECK(all[0].range->unit == solvers::Legend::Range::Unit::metres);
  CHECK(all[0].range->hi == 7);
  CHECK(all[1].marks.size() == 6);
  CHECK(all[1].marks[4].text == "40 clusters");
}

TEST_CASE("the card shows the record under a point and the records it reads, shortened in little room") {
  using Room = solvers::Card::Room;
  CacheReport c = complete();
  c.inspection.solid = true, c.inspection.lookup = shared::k_lookup_possible;
  CHECK_FALSE(make_report(c, settings()).card);  // no point is inspected
  c.looked_at = vec2(0.5f);
  const auto reported = [&](Room room = Room::much) {
    return words_of(*make_report(c, settings()).card, room);
  };
  CHECK_THAT(reported(), Contains("No record serves here: path traced."));
  c.status.stop = StopReason::building;
  CHECK_THAT(reported(), Contains("No record serves here yet."));
  c.inspection.gathers = true;
  CHECK_THAT(reported(), Contains("Paths gather the light here."));
  c.inspection.gathers = false, c.inspection.count = 9;
  for (uint32_t i = 0; i < 9; ++i) c.inspection.serving.push_back({100 + i, float(9 - i) / 45, {}, 1});
  Record record;
  record.radius = 0.31f, record.lesser_radius = 0.1f, record.mean_distance = INFINITY, record.rays = 64;
  record.parts[1].value = vec3(0.5f, 0.25f, 0.125f);
  c.inspection.under = {.index = 1508, .record = record, .read = 0.25f, .at = {}};
  const std::string much = reported(), little = reported(Room::little);
  CHECK_THAT(much, Contains("pass 1 \xC2\xB7 screen") && Contains("Radius|10.0 cm x 31.0 cm\n") &&
                       Contains("Mean distance (harmonic)|\xE2\x88\x9E") && Contains("secondary\n") &&
                       Contains("Luminance, smoothed|0.294, 0.250\n") && !Contains("tertiary"));
  CHECK_THAT(much, Contains("Served by 9 records\nweight 100\n") && Contains("and 3 more|13.3 %"));
  CHECK_THAT(little, Contains("508|31.0 cm\n") && !Contains("Radius") && Contains("weight 105") &&
                         !Contains("weight 106"));
  c.inspection.lookup = shared::k_lookup_too_steep;
  CHECK_THAT(reported(), Contains("too steep"));
  c.inspection.solid = false;
  CHECK_FALSE(make_report(c, settings()).card);
}

}  // namespace cache_report_tests
