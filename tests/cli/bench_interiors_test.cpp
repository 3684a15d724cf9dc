// links: film_io
// lucerna bench interiors in use: a room with few pixels and samples, a second lucerna, interruption and
// continuation; refusals.
#include <signal.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "film/io/image_file.h"
#include "support/folder.h"
#include "support/run.h"

namespace bench_interiors_tests {

namespace fs = std::filesystem;
using Catch::Contains;
using lucerna::test::Run;
using lucerna::test::run;

namespace {

const std::string k_room = std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell";

nlohmann::json read_json(const fs::path& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in);
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string small(const fs::path& place, const std::string& report = "r") {
  return "bench interiors --scenes " + k_room +
         " --size 32x24 --samples 4,16 --reference-samples 64 --repeats 1 --report " +
         (place / report).string() + " --references " + (place / "refs").string();
}

}  // namespace

TEST_CASE(
    "bench interiors measures rooms by error as seen, beside a second lucerna, and keeps existing results") {
  const lucerna::test::Folder place;
  const std::string command = small(place.path) + " --settings path,cache --against " + LUCERNA_BINARY;
  const Run first = run(command);
  INFO(first.out);
  REQUIRE(first.status == 0);
  CHECK_THAT(first.out, Contains("1 of 9  cornell, reference of 64 samples") &&
                            Contains("cornell, before-cache, 16 samples, repeat 1 of 1") &&
                            Contains("cache, 16 samples: over 1 scenes") && Contains("report.html"));
  const auto report = read_json(place / "r/report.json");
  CHECK(report["complete"] == true);
  REQUIRE(report["results"].size() == 8);
  std::map<std::string, double> seen;
  for (const auto& r : report["results"]) {
    CHECK(r["wall_s"] > 0);
    CHECK(r["rays"] > 0);
    CHECK(r["samples"] == (r["budget"] == "4 samples" ? 4 : 16));
    CHECK(r["seen"] > 0);
    // Products of differences from two references: the trimmed part can be negative by chance.
    CHECK(r["seen_all"].get<double>() == Approx(r["seen"].get<double>()).epsilon(0.5));
    CHECK(r["true"]["sum"] > 0);
    CHECK(r["estimated"]["sum"] > 0);
    seen[r["setting"].get<std::string>() + r["budget"].get<std::string>() + r["repeat"].dump()] = r["seen"];
  }
  // The other program is this one: its pictures are the same.
  for (const char* cell : {"path4 samples0", "path16 samples0", "cache16 samples0"})
    CHECK(seen[cell] == seen["before-" + std::string(cell)]);
  CHECK(seen["path4 samples0"] > 2 * seen["path16 samples0"]);
  CHECK(report["scenes"][0]["settings"][2]["cells"][1]["seen_beside"].contains("ratio"));
  const std::string html = read_text(place / "r/report.html");
  CHECK_THAT(html, Contains("How soon rooms are right") && Contains("data:image/png;base64,") &&
                       Contains("<svg") && Contains("before-cache"));
  for (const auto& entry : fs::directory_iterator(place / "r"))
    CHECK_FALSE(entry.path().filename().string().starts_with("outside"));

  // All results exist, and the page can be written again.
  const Run again = run(command);
  CHECK(again.status == 0);
  CHECK_THAT(again.out, Contains("all 8 renders exist already"));
  CHECK(read_json(place / "r/report.json") == report);
  CHECK(run("bench --page " + (place / "r").string()).status == 0);
  CHECK(read_text(place / "r/report.html") == html);
  // Another bench finds the references.
  const Run next = run(small(place.path, "r2") + " --settings path");
  INFO(next.out);
  CHECK(next.status == 0);
  CHECK_THAT(next.out, Contains("1 of 2  cornell, path, 4 samples") && !Contains("reference of"));
  // Other settings are another measurement.
  const Run other = run(small(place.path) + " --settings path");
  CHECK(other.status == 1);
  CHECK_THAT(other.out, Contains("another matrix (it differs at settings"));
}

TEST_CASE("bench interiors keeps finished results at Ctrl-C") {
  const lucerna::test::Folder place;
  const std::string command = "bench --interiors --scenes " + k_room +
                              "/cornell.gltf --size 16x16 --seconds 0.05,60 --reference-samples 16 --repeats "
                              "1 --settings path --report " +
                              (place / "r").string() + " --references " + (place / "refs").string();
  lucerna::test::Running running(command);
  REQUIRE(running.says("3 of 3"));
  running.send(SIGINT);
  const Run stopped = running.finish();
  INFO(stopped.out);
  CHECK(stopped.status == 128 + SIGINT);
  CHECK_THAT(stopped.out, Contains("interrupted; 1 of 2 renders are kept"));
  CHECK(fs::exists(place / "refs/cornell-16x16.exr"));
  CHECK(read_json(place / "r/report.json")["complete"] == false);
  CHECK_FALSE(fs::exists(place / "r/outside.exr"));
}

TEST_CASE("bench interiors waits for a picture that is late") {
  const lucerna::test::Folder place;
  const Run r =
      run("bench interiors --scenes " + k_room +
          " --size 24x16 --seconds 0.01 --reference-samples 16 --repeats 1 --settings cache --report " +
          (place / "r").string() + " --references " + (place / "refs").string());
  INFO(r.out);
  REQUIRE(r.status == 0);
  const auto cell = read_json(place / "r/cells/cornell.cache.0.0.json");
  CHECK(cell["wall_s"] > 0.01);
  CHECK(cell["samples"] > 0);
}

TEST_CASE("bench interiors refuses impossible measurements") {
  const lucerna::test::Folder place;
  const auto refused = [&](const std::string& arguments, const std::string& expected) {
    const Run r = run("bench interiors --report " + (place / "r").string() + " " + arguments);
    INFO(arguments << "\n" << r.out);
    CHECK(r.status == 1);
    CHECK_THAT(r.out, Contains(expected));
    CHECK_FALSE(fs::exists(place / "r"));
  };
  refused("--scenes " + (place / "none").string(), "is no folder with scenes");
  refused("--scenes " + place.path.string(), "there is no .gltf or .glb file in it");
  refused("--against /bin/true", "expected another lucerna");
  refused("--against " + (place / "none").string(), "cannot be run");
  refused("--settings everything", "--settings");
  refused("--size 4x4", "expected WIDTHxHEIGHT");
  refused("--seconds 5 --samples 4", "--seconds");
  refused("--seconds 0", "--seconds");
}

}  // namespace bench_interiors_tests
