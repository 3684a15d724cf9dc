// links: bench
// From results to figures, table, page and comparison: synthetic results with known figures.
#include <catch2/catch.hpp>
#include <fstream>
#include <regex>

#include "base/base64.h"
#include "bench/compare_reports.h"
#include "bench/html.h"
#include "bench/page.h"
#include "bench/plot.h"
#include "bench/thumbnails.h"
#include "film/io/image_file.h"
#include "unit/bench_support.h"

namespace bench_page_tests {

using namespace lucerna;
using namespace lucerna::bench;
using Catch::Contains;
using Json = nlohmann::ordered_json;

namespace {

Json report(double gain = 4, size_t cells = ~size_t{0}) {
  const Matrix m = test::small_matrix();
  return make_report(m, test::fake_summary(m, gain, cells), test::fake_about());
}

/// The first tag that is not closed or is closed twice; "" if there is none.
std::string unbalanced(const std::string& html) {
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-zA-Z0-9]+)([^<>]*)>");
  for (std::sregex_iterator at(html.begin(), html.end(), tag), end; at != end; ++at) {
    const std::string name = (*at)[2], rest = (*at)[3];
    if ((*at)[1] == "/") {
      if (open.empty() || open.back() != name) return "</" + name + ">";
      open.pop_back();
    } else if (!rest.ends_with("/")) {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : "<" + open.back() + ">";
}

size_t count(const std::string& text, const std::string& what) {
  size_t n = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("Figures: times, ratios, index and forecast match the synthetic renders") {
  const Json r = report();
  CHECK(r["complete"] == true);
  CHECK(r["cells"]["done"] == 18);
  CHECK(r["references"].size() == 2);
  REQUIRE(r["scenes"].size() == 2);
  const Json &plain = r["scenes"][0]["settings"][0], &adaptive = r["scenes"][0]["settings"][1];
  // 0.19 / sqrt(t): 5 % at 14.44 s, 2 % at 90.25 s, beyond the end at 16 s.
  CHECK(plain["time_to"][1]["kind"] == "extrapolated");
  CHECK(plain["time_to"][1]["seconds"]["median"].get<double>() == Approx(90.25));
  CHECK_FALSE(plain["time_to"][1].contains("ratio"));
  CHECK(adaptive["time_to"][0]["kind"] == "measured");
  CHECK(adaptive["time_to"][0]["seconds"]["median"].get<double>() == Approx(3.61));
  CHECK(adaptive["time_to"][0]["seconds"]["low"].get<double>() == Approx(3.61 * 0.98 * 0.98));
  CHECK(adaptive["time_to"][0]["ratio"].get<double>() == Approx(4));
  CHECK(adaptive["time_to"][0]["noise"] == false);
  // Tiles have twice the error: 5 % in four times the time.
  CHECK(adaptive["tiles_time_to"][0]["seconds"]["median"].get<double>() == Approx(14.44).epsilon(0.05));
  CHECK(adaptive["time_common"]["error"].get<double>() == Approx(0.048));
  CHECK(adaptive["time_common"]["ratio"].get<double>() == Approx(4));
  // Relative squared errors are a hundredth of .19^2 / t: .0004 after .9025 s, adaptive after a quarter.
  CHECK(plain["relmse_time_to"][2]["error"].get<double>() == Approx(0.0004));
  CHECK(plain["relmse_time_to"][2]["seconds"]["median"].get<double>() == Approx(0.9025));
  CHECK(adaptive["relmse_time_to"][2]["kind"] == "at_once");
  CHECK(adaptive["relmse_time_common"]["ratio"].get<double>() == Approx(4));
  CHECK(adaptive["relmse_time_common"]["error"].get<double>() == Approx(0.000023));
  CHECK(plain["relmse_power"]["median"].get<double>() == Approx(-1));
  CHECK_FALSE(plain["relmse_end"].contains("first"));
  CHECK(adaptive["relmse_end"]["seconds"].get<double>() == Approx(16));
  CHECK(adaptive["relmse_end"]["relmse"]["median"].get<double>() == Approx(0.000361 / 16 / 4));
  CHECK(adaptive["relmse_end"]["first"]["median"].get<double>() == Approx(0.000361 / 16));
  CHECK(adaptive["relmse_end"]["kind"] == "measured");
  CHECK(adaptive["relmse_end"]["ratio"].get<double>() == Approx(4));
  CHECK(adaptive["relmse_end"]["noise"] == false);
  CHECK(adaptive["index"]["relative"].get<double>() == Approx(100));
  CHECK(plain["index"]["relative"].get<double>() == Approx(25));
  CHECK(adaptive["index"]["ratio"].get<double>() == Approx(4));
  CHECK(r["index"][0]["value"].get<double>() == Approx(25));
  CHECK(adaptive["rate"]["noise"] == true);
  CHECK(adaptive["forecast"]["seconds"]["median"].get<double>() == Approx(1.1));
  CHECK(adaptive["forecast"]["in_band"] == 3);
  // Repeats differ by 2 % in error, 4 % in time.
  CHECK(r["scenes"][0]["noise"]["time"].get<double>() == Approx(1.09).epsilon(0.02));
  CHECK(plain["cells"].size() == 2);
  CHECK(plain["error_at"].size() == 2);
}

TEST_CASE("A gain within the noise is not reported as a gain") {
  const auto reported = findings(report(1.01));
  REQUIRE(reported.size() == 6);
  for (const std::string& line : reported) CHECK_THAT(line, Contains("by more than the measurement’s noise"));
  const auto gain = findings(report(4));
  CHECK_THAT(gain[0],
             Contains("adaptive: the whole picture to 4.8 % in 3.92 s, plain in 15.7 s: 4.00 times sooner"));
  CHECK_THAT(
      gain[2],
      Contains(
          "adaptive ends with a relative squared error of 5.64e-06 after 16.0 s, plain then has 2.26e-05: "
          "4.00 times less"));
  const auto loss = findings(report(0.25));
  CHECK_THAT(loss[0], Contains("times later"));
  CHECK_THAT(loss[2], Contains("times more"));
}

TEST_CASE("Gains from one repeat are reported as such, and extrapolated figures are marked") {
  Json r = report(4);
  r["matrix"]["repeats"] = 1;
  for (Json& scene : r["scenes"]) {
    scene.erase("noise");
    for (Json& s : scene["settings"])
      for (const char* measure : {"time_common", "tiles_time_common", "relmse_end"})
        if (s.contains(measure)) s[measure].erase("noise");
  }
  r["scenes"][0]["settings"][1]["relmse_end"]["kind"] = "extrapolated";
  const auto reported = findings(r);
  REQUIRE(reported.size() == 7);
  CHECK_THAT(reported[0], Contains("4.00 times sooner"));
  CHECK_THAT(reported[2], Contains("plain would then have 2.26e-05"));
  CHECK_THAT(reported[6], Contains("one repeat"));
}

TEST_CASE("An error below the reference's noise counts as not measured") {
  const Matrix m = test::small_matrix();
  bench::RunSummary s = test::fake_summary(m, 4);
  s.references[0].noise[0] = 0.06;  // 0.7 of it is 4.2 %: adaptive ends at 2.4 %
  for (auto& [id, r] : s.results) r.in_reference_noise = r.truth[0] < 0.042;
  const Json r = make_report(m, s, test::fake_about());
  const Json& adaptive = r["scenes"][0]["settings"][1];
  CHECK(adaptive["cells"][0]["in_reference_noise"] == true);
  CHECK_FALSE(adaptive.contains("index"));
  CHECK(adaptive["time_to"][1]["kind"] == "extrapolated");
  CHECK_THAT(make_page(r, "/no/pictures"), Contains("in the reference’s noise"));
}

TEST_CASE(
    "The first setting's error after a longer time is extrapolated; older reports are shown without it") {
  const Matrix m = test::small_matrix();
  bench::RunSummary s = test::fake_summary(m, 4);
  std::erase_if(s.results, [](const auto& r) { return r.first.starts_with("cornell.plain.1"); });
  Json r = make_report(m, s, test::fake_about());
  const Json& end = r["scenes"][0]["settings"][1]["relmse_end"];
  CHECK(end["kind"] == "extrapolated");
  CHECK(end["first"]["median"].get<double>() == Approx(0.000361 / 16));
  const std::string heading = "relative mean squared error";
  const std::string html = make_page(r, "/no/pictures");
  CHECK_THAT(html, Contains(heading) && Contains("± 1.2e-05") && Contains("t<sup>-1.00</sup>") &&
                       Contains("time to 0.0004"));
  r["scenes"][0]["settings"][1].erase("relmse_end");
  CHECK_THAT(make_page(r, "/no/pictures"), !Contains(heading));
}

TEST_CASE("The table has a line for each cell and repeat, all with the same fields") {
  const std::string csv = make_csv(report());
  CHECK(count(csv, "\n") == 19);
  const auto fields = [&](size_t from) { return count(csv.substr(from, csv.find('\n', from) - from), ","); };
  for (size_t at = 0; at < csv.size(); at = csv.find('\n', at) + 1) CHECK(fields(at) == fields(0));
  CHECK_THAT(csv, Contains("\ncornell,adaptive,error 5 %,2,3,host,16"));
}

TEST_CASE("The page is self-contained, well-formed and holds every number of its tables") {
  const test::Folder folder;
  film::write_png(folder / "cornell.plain.png", 16, 16, std::vector<uint8_t>(16 * 16 * 4, 128));
  film::FilmImage error{.width = 16, .height = 16};
  error.channels.emplace_back("error", std::vector<float>(256, 0.03f));
  film::write_exr(folder / "cornell.plain.exr", error);
  const Json r = report();
  const std::string html = make_page(r, folder.path);
  CHECK(html.starts_with("<!DOCTYPE html>"));
  CHECK(unbalanced(html.substr(html.find('\n'))) == "");
  for (const char* outside : {"http:", "https:", "<script", "<link", "url(", "@import", "file:"})
    CHECK(html.find(outside) == std::string::npos);
  CHECK(html.find("NaN") == std::string::npos);
  CHECK(html.find("nan ") == std::string::npos);
  CHECK(html.find("inf") == std::string::npos);
  CHECK(count(html, "data:image/png;base64,") == 2);
  CHECK(count(html, "<svg") == 4);
  CHECK(count(html, "</svg>") == 4);
  CHECK_THAT(html, Contains("small &lt;&amp;&gt; matrix"));
  for (const Json& scene : r["scenes"]) {
    for (const Json& s : scene["settings"]) {
      for (const char* measure : {"time_to", "tiles_time_to", "relmse_time_to"})
        for (const Json& e : s[measure]) {
          CHECK_THAT(html, Contains(seconds_text(e["seconds"]["median"].get<double>())));
          CHECK_THAT(html, Contains(seconds_text(e["seconds"]["high"].get<double>())));
          if (e.contains("ratio")) CHECK_THAT(html, Contains(ratio_text(e["ratio"].get<double>())));
        }
      for (const Json& cell : s["cells"])
        CHECK_THAT(html, Contains(count_text(cell["rays"]["median"].get<double>())));
      CHECK_THAT(html, Contains(ratio_text(s["forecast"]["seconds"]["median"].get<double>())));
    }
    for (const char* key : {"time", "index", "rate"})
      CHECK_THAT(html, Contains(ratio_text(scene["noise"][key].get<double>())));
  }
  for (const char* word : {"A Processor, 2 cores", "3.5 GiB", "A System", "a device", "9.9", "5 min 21 s",
                           "lucerna bench --quick", "2026-01-02", "4096"})
    CHECK_THAT(html, Contains(word));
}

namespace {

const char* const k_curves_matrix = R"({
  "name": "curves", "budgets": {"samples": [16, 64]},
  "scenes": [{"file": "cornell/cornell.gltf", "size": "16x16"}, {"file": "glass/glass.gltf", "size": "24x16"}],
  "settings": [{"name": "plain"},
               {"name": "split-60", "curve": "split sphere"}, {"name": "split-30", "curve": "split sphere"},
               {"name": "hessian-60", "curve": "hessian"}, {"name": "hessian-30", "curve": "hessian"},
               {"name": "lone", "curve": "of one"}]
})";

/// Records on cornell only; the second setting of a curve has four times the first one's records, the smaller
/// budget a thousand more. Repeats differ in both.
Json report_of_curves(bool with_records = true) {
  const Matrix m = parse_matrix(k_curves_matrix, "m", std::string(LUCERNA_SOURCE_DIR) + "/scenes");
  RunSummary s = test::fake_summary(m, 1);
  for (const Cell& c : m.cells()) {
    Result& r = s.results.at(m.id(c));
    if (c.setting == 0 || c.scene != 0 || !with_records) continue;
    const bool fine = r.setting.ends_with("-30"), hessian = r.setting.starts_with("hessian");
    r.records =
        uint64_t((hessian ? 300 : 500) * (fine ? 4 : 1) + 10 * (c.repeat - 1) + (c.budget ? 0 : 1000));
    r.record_rays = 256 * r.records;
    r.truth[0] = (fine ? 0.03 : 0.06) * (hessian ? 0.8 : 1) * (1 + 0.1 * (c.repeat - 1));
  }
  return make_report(m, s, test::fake_about());
}

/// The plots of error against records: from <svg to </svg>.
std::vector<std::string> record_plots(const std::string& html) {
  std::vector<std::string> found;
  for (size_t at = html.find("<svg"); at != std::string::npos; at = html.find("<svg", at + 1)) {
    const std::string svg = html.substr(at, html.find("</svg>", at) - at);
    if (svg.find(">records that light is looked up in<") != std::string::npos) found.push_back(svg);
  }
  return found;
}

}  // namespace

TEST_CASE("Error against records: a line for each curve, on scenes with records") {
  const Json r = report_of_curves();
  const Json& cell = r["scenes"][0]["settings"][2]["cells"][1];
  CHECK(cell["records"]["median"] == 2000);
  CHECK(cell["records"]["low"] == 1990);
  CHECK(cell["records"]["high"] == 2010);
  CHECK(cell["record_rays"]["median"] == 512000);
  CHECK_THAT(make_csv(r), Contains(",records,record_rays,") && Contains(",2010,514560,"));
  const std::string html = make_page(r, "/no/pictures");
  CHECK(unbalanced(html.substr(html.find('\n'))) == "");
  const auto plots = record_plots(html);
  REQUIRE(plots.size() == 1);
  const std::string& svg = plots[0];
  CHECK_THAT(svg, Contains("cornell: true error of the whole picture against records"));
  for (const char* dot :
       {"<title>split-60: 500 records, 6.00 %</title>", "<title>split-30: 2000 records, 3.00 %<",
        "<title>hessian-60: 300 records, 4.80 %<", "<title>hessian-30: 1200 records, 2.40 %<"})
    CHECK_THAT(svg, Contains(dot));
  CHECK(count(svg, "<circle") == 4);
  // A line and a band each, with their names at their ends. One point makes no curve; no curve makes no line.
  CHECK(count(svg, "fill=\"none\"") == 2);
  CHECK(count(svg, "fill-opacity=\"0.16\"") == 2);
  CHECK_THAT(svg, Contains(">split sphere</text>") && Contains(">hessian</text>"));
  CHECK_THAT(svg, !Contains("lone") && !Contains("of one") && !Contains("plain"));
  CHECK_THAT(svg, Contains(">500</text>") && Contains(">2 k</text>") && !Contains("seconds"));
  // The settings of a curve share its colour.
  CHECK(svg.find(setting_colour(1)) != std::string::npos);
  CHECK(svg.find(setting_colour(2)) != std::string::npos);
  CHECK(svg.find(setting_colour(3)) == std::string::npos);
  CHECK_THAT(html, Contains("<th>records</th>") && Contains("<td>2000</td><td>512 k</td>"));
}

TEST_CASE("A curve's best setting is reported, and the number of records for the other curve's error") {
  const std::vector<std::string> reported = findings(report_of_curves());
  const auto line = [&](const char* what) {
    for (const std::string& l : reported)
      if (l.starts_with("cornell: ") && l.find(what) != std::string::npos) return l;
    return std::string();
  };
  // Split sphere: 6 % with 500, 3 % with 2000; hessian: 4.8 % with 300, 2.4 % with 1200, so 3 % with 768.
  CHECK_THAT(line("records"),
             Contains("hessian: the whole picture to 3 % with 768 records, split sphere with 2000: "
                      "2.60 times fewer"));
  CHECK_THAT(line("records"), !Contains("of one"));
  const std::string ends = line("ends with a relative squared error");
  CHECK(count(ends, "split-") <= 1);
  CHECK(count(ends, "hessian-") <= 1);
  CHECK(std::none_of(reported.begin(), reported.end(), [](const std::string& l) {
    return l.starts_with("glass") && l.find("records") != l.npos;
  }));
}

TEST_CASE("A curve runs from few records to many, with a band over the repeats") {
  Json r = report_of_curves();
  Json& settings = r["matrix"]["settings"];
  std::swap(r["scenes"][0]["settings"][1], r["scenes"][0]["settings"][2]);
  const std::string svg = record_plots(make_page(r, "/no/pictures")).at(0);
  CHECK(settings[1]["name"] == "split-60");
  CHECK(svg.find("split-60: ") < svg.find("split-30: "));
  // An error below the reference's noise is no point: one of two remains, and no line.
  r["scenes"][0]["settings"][1]["cells"][1]["in_reference_noise"] = true;
  const std::string one = record_plots(make_page(r, "/no/pictures")).at(0);
  CHECK(one.find("split") == std::string::npos);
  CHECK_THAT(one, Contains(">hessian</text>"));
}

TEST_CASE("Without records, or in a report from before they were counted, there is no such plot") {
  Json r = report_of_curves(false);
  CHECK(record_plots(make_page(r, "/no/pictures")).empty());
  r = report_of_curves();
  for (Json& s : r["scenes"][0]["settings"])
    for (Json& cell : s["cells"]) cell.erase("records"), cell.erase("record_rays");
  const std::string html = make_page(r, "/no/pictures");
  CHECK(record_plots(html).empty());
  CHECK_THAT(html, !Contains("<th>records</th>"));
  CHECK(record_plots(make_page(report(), "/no/pictures")).empty());
}

TEST_CASE("The page of an unfinished bench is marked; an empty bench has a page too") {
  const std::string part = make_page(report(4, 7), "/no/pictures");
  CHECK_THAT(part, Contains("Not complete: 7 of 18"));
  CHECK(unbalanced(part.substr(part.find('\n'))) == "");
  const std::string none = make_page(report(4, 0), "/no/pictures");
  CHECK_THAT(none, Contains("Not complete: 0 of 18"));
  CHECK(unbalanced(none.substr(none.find('\n'))) == "");
  CHECK_THROWS_AS(make_page(Json{{"what", "else"}}, "/no/pictures"), Error);
}

TEST_CASE("Reports are written and read; other files are refused") {
  const test::Folder folder;
  const Json r = report();
  std::filesystem::create_directories(folder / "pictures");
  write_report(folder.path, r);
  CHECK(read_report(folder.path) == r);
  CHECK(read_report(folder / "report.json") == r);
  const std::string whole = read_file(folder / "report.json");
  std::ofstream(folder / "half.json") << whole.substr(0, whole.size() / 2);
  std::ofstream(folder / "other.json") << "{}";
  CHECK_THROWS_WITH(read_report(folder / "half.json"), Contains("half.json") && Contains("half a file"));
  CHECK_THROWS_WITH(read_report(folder / "other.json"), Contains("no report"));
  CHECK_THROWS_WITH(read_report(folder / "none"), Contains("cannot be read"));
}

TEST_CASE("Two reports: ratios, marks of noise, missing settings") {
  const Json before = report(1), after = report(4);
  const std::string text = compare_reports(before, after);
  INFO(text);
  // Plain is unchanged; adaptive is four times faster.
  CHECK(std::regex_search(text, std::regex("cornell +plain +~?1.00x= +~1.00x= +~1.00x= +1.00x= +1.00x=")));
  CHECK(std::regex_search(text, std::regex("glass +adaptive +~4.00x  +~4.00x  +~4.00x  +4.00x  +1.00x=")));
  CHECK(text.find("missing") == std::string::npos);
  CHECK(text.find("note") == std::string::npos);
  const std::string part = compare_reports(before, report(4, 1));
  INFO(part);
  CHECK_THAT(part, Contains("missing in the new report: cornell, plain, 64 samples\n"));
  CHECK_THAT(part, Contains("missing in the new report: cornell, adaptive\n"));
  CHECK_THAT(part, Contains("missing in the new report: glass\n"));
  CHECK_THAT(part, Contains("new report is not complete"));
  Json elsewhere = after;
  elsewhere["machine"]["cpu"] = "Another";
  CHECK_THAT(compare_reports(before, elsewhere), Contains("machine/cpu differs"));
}

TEST_CASE("Small parts of the page") {
  CHECK(base64("") == "");
  CHECK(base64("M") == "TQ==");
  CHECK(base64("Ma") == "TWE=");
  CHECK(base64("Man") == "TWFu");
  CHECK(base64(std::string("\0\xff\x10", 3)) == "AP8Q");
  CHECK(seconds_text(0.004) == "4.0 ms");
  CHECK(seconds_text(0.042) == "0.0420 s");
  CHECK(seconds_text(4.123) == "4.12 s");
  CHECK(seconds_text(99.99) == "1 min 40 s");
  CHECK(seconds_text(130.4) == "2 min 10 s");
  CHECK(seconds_text(3 * 3600 + 5 * 60) == "3 h 05 min");
  CHECK(percent_text(0.0523) == "5.23 %");
  CHECK(percent_text(0) == "0 %");
  CHECK(count_text(12345678) == "12.3 M");
  CHECK(log_ticks(0.09, 0.6) == std::vector<double>{0.1, 0.2, 0.5});
  CHECK(magma(0) == std::array<uint8_t, 3>{0, 0, 4});
  CHECK(magma(2) == std::array<uint8_t, 3>{252, 253, 191});
  // Labels keep their order and distance, and stay inside the frame.
  const auto at = spread_labels({100, 101, 50, 102, 10}, 16, 10, 120);
  CHECK(at[2] == 50);
  CHECK(at[4] == 10);
  CHECK(at[1] - at[0] >= 15.99);
  CHECK(at[3] - at[1] >= 15.99);
  CHECK(at[3] <= 120.01);
  CHECK(make_plot({}, {}, "t", "e").empty());
  CHECK(make_plot({{"none", "#fff", {}, {}}}, {}, "t", "e").empty());
  // A short axis has ticks beyond 1, 2 and 5.
  const PlotLine line{"a", "#fff", {{2100, {0.04, 0.03, 0.05, 3}}, {6100, {0.02, 0.02, 0.02, 3}}}, {}};
  CHECK_THAT(make_plot({line}, {}, "t", "e", Across::records), Contains(">3 k<") && Contains(">7 k<"));
  CHECK_THAT(make_plot({line}, {}, "t", "e"), Contains(">3000<") && Contains("seconds of rendering"));
}

}  // namespace bench_page_tests
