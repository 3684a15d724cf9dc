// links: film_io
// lucerna bench in use: a tiny matrix measured, interrupted and continued; invalid input.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "film/io/image_file.h"
#include "support/run.h"

namespace bench_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using Catch::Contains;
using test::run;
using test::Run;

namespace {

/// A folder with matrix files, removed at the end.
struct Place {
  fs::path path = fs::temp_directory_path() / ("lucerna-cli-bench-" + std::to_string(getpid()));
  Place() { fs::remove_all(path), fs::create_directories(path); }
  ~Place() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
  std::string matrix(const std::string& name, int samples, int reference) const {
    std::ofstream(path / name)
        << R"({"warmup": 2, "reference": {"samples": )" << reference << R"(}, "budgets": {"samples": [)"
        << samples << R"(], "errors": [0.5], "seconds": [0.05]}, "scenes": [{"file": ")" << LUCERNA_SOURCE_DIR
        << R"(/scenes/cornell/cornell.gltf", "size": "16x16"}], "settings": [)"
        << R"({"name": "plain"}, {"name": "adaptive", "set": {"sampling.mode": "adaptive",)"
        << R"("sampling.min_samples": 8}}, {"name": "timed", "budget": "seconds"}]})";
    return *this / name;
  }
};

nlohmann::json read_json(const std::string& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in);
}

size_t count_files(const std::string& folder) {
  return size_t(std::distance(fs::directory_iterator(folder), {}));
}

/// Runs the program until it has printed a line, then sends the signal of Ctrl-C.
Run interrupt_at(const std::string& line, const std::string& arguments, const std::string& log) {
  return test::run_command(std::string("rm -f ") + log + "; " + LUCERNA_BINARY + " " + arguments + " >" +
                           log + " 2>&1 & for i in $(seq 600); do grep -qs '" + line + "' " + log +
                           " && break; sleep 0.1; done; kill -INT $!; wait $!; status=$?; cat " + log +
                           "; exit $status");
}

void refused(const std::string& arguments, const std::string& expected) {
  const Run r = run("bench " + arguments);
  INFO(arguments << "\n" << r.out);
  CHECK(r.status == 1);
  CHECK_THAT(r.out, Contains(expected));
}

}  // namespace

TEST_CASE("bench waits for a picture that is still being prepared when its time is over") {
  const Place place;
  std::ofstream(place.path / "m.json")
      << R"({"repeats": 1, "warmup": 1, "reference": {"samples": 16}, "budgets": {"seconds": [0.01]},)"
      << R"("scenes": [{"file": ")" << LUCERNA_SOURCE_DIR
      << R"(/scenes/cornell/cornell.gltf", "size": "16x16"}],)"
      << R"("settings": [{"name": "plain", "budget": "seconds"}, {"name": "cache", "budget": "seconds",)"
      << R"("set": {"components.secondary": "cache", "components.tertiary": "cache"}}]})";
  const Run r = run("bench " + (place / "m.json") + " --report " + (place / "r"));
  INFO(r.out);
  REQUIRE(r.status == 0);
  const nlohmann::json cell = read_json(place / "r/cells/cornell.cache.0.0.json");
  CHECK(cell.at("samples") >= 1);
  CHECK(cell.at("wall_s") > 0.01);
}

TEST_CASE(
    "bench measures a matrix, keeps existing results, replaces partial files and writes its page again") {
  const Place place;
  const std::string matrix = place.matrix("m.json", 16, 1024), folder = place / "r";
  const Run first = run("bench " + matrix + " --report " + folder);
  INFO(first.out);
  REQUIRE(first.status == 0);
  CHECK_THAT(first.out, Contains("1 of 10  cornell, reference of 1024 samples") && Contains("10 of 10"));
  CHECK(count_files(folder + "/cells") == 9);
  const auto report = read_json(folder + "/report.json");
  CHECK(report["complete"] == true);
  CHECK(report["results"].size() == 9);
  CHECK(report["references"][0]["samples"] == 1024);
  CHECK(report["references"][0]["noise"]["sum"] > 0);
  CHECK(report["references"][0]["relmse_noise"] > 0);
  for (const auto& r : report["results"]) {
    CHECK(r["wall_s"] > 0);
    CHECK(r["rays"] > 0);
    // The number of samples of a timed render depends on the machine; its error may be below the reference's
    // noise.
    if (r["setting"] == "timed")
      CHECK(r["true"]["sum"] >= 0);
    else
      CHECK(r["true"]["sum"] > 0);
    // Noise is known from the second sample on, which a timed render on a busy machine may not reach.
    if (r["samples"] >= 2)
      CHECK(r["estimated"]["sum"] > 0);
    else
      CHECK(r["setting"] == "timed");
    CHECK(r["curve"].size() > 0);
  }
  CHECK(report["results"][0]["samples"] == 16);
  for (const auto& r : report["results"])
    if (r["setting"] == "timed") {
      CHECK(r["wall_s"] >= 0.05);
      CHECK(r["budget"] == "0.05 s");
    }
  std::ifstream page(folder + "/report.html");
  const std::string html((std::istreambuf_iterator<char>(page)), {});
  CHECK_THAT(html, Contains("What accuracy costs in time") && Contains("data:image/png;base64,") &&
                       Contains("<svg") && Contains("bench " + matrix));

  // All results exist: nothing is measured, and the report keeps its date.
  const Run again = run("bench " + matrix + " --report " + folder + " --quiet");
  CHECK(again.status == 0);
  CHECK_THAT(again.out, Contains("all 9 renders exist already"));
  CHECK(read_json(folder + "/report.json") == report);

  // Half a result, half a reference.
  const std::string cell = folder + "/cells/cornell.plain.0.1.json";
  fs::resize_file(cell, fs::file_size(cell) / 2);
  const std::string reference = folder + "/references/cornell-16x16.exr";
  const film::FilmImage before = film::read_exr(reference);
  fs::resize_file(reference, fs::file_size(reference) / 2);
  const Run mended = run("bench " + matrix + " --report " + folder);
  INFO(mended.out);
  CHECK(mended.status == 0);
  CHECK_THAT(mended.out, Contains("half a file; it is measured again") && Contains("it is rendered again") &&
                             Contains("2 of 2  cornell, plain, 16 samples, repeat 2 of 3"));
  CHECK(read_json(cell)["repeat"] == 1);
  const film::FilmImage after = film::read_exr(reference);
  CHECK(*after.find("R") == *before.find("R"));
  CHECK(fs::exists(reference + ".old"));

  fs::remove(folder + "/report.html");
  CHECK(run("bench --page " + folder).status == 0);
  CHECK(fs::file_size(folder + "/report.html") > 10000);
  const Run compared = run("bench --compare " + folder + " " + folder);
  CHECK(compared.status == 0);
  CHECK_THAT(compared.out, Contains("cornell") && Contains("adaptive") && Contains("1.00x="));

  // Another matrix cannot use this folder.
  refused(place.matrix("other.json", 32, 1024) + " --report " + folder,
          "another matrix (it differs at scenes/0");
  CHECK(count_files(folder + "/cells") == 9);
}

TEST_CASE("bench counts the records of the irradiance cache and plots the error against them") {
  const Place place;
  std::ofstream(place / "m.json")
      << R"({"warmup": 1, "reference": {"samples": 1024}, "budgets": {"samples": [4]}, "set": {"cache.rays": 64, "cache.max_rays": 64,)"
      << R"("components.primary": "off", "components.caustic": "off"}, "scenes": [{"file": ")"
      << LUCERNA_SOURCE_DIR << R"(/scenes/cornell/cornell.gltf", "size": "16x16"}], "settings": [)"
      << R"({"name": "plain"}, {"name": "wide", "curve": "c", "set": {"components.secondary": "cache",)"
      << R"("cache.error": 0.9}}, {"name": "narrow", "curve": "c", "set": {"components.secondary": "cache",)"
      << R"("cache.error": 0.3, "cache.min_radius": 1}}]})";
  const std::string folder = place / "r";
  const Run r = run("bench " + (place / "m.json") + " --quiet --report " + folder);
  INFO(r.out);
  REQUIRE(r.status == 0);
  std::map<std::string, double> records;
  const auto report = read_json(folder + "/report.json");
  REQUIRE(report["results"].size() == 9);
  for (const auto& result : report["results"]) {
    if (result["repeat"] == 0) records[result["setting"]] = result["records"];
    CHECK((result["record_rays"] > 0) == (result["setting"] != "plain"));
  }
  CHECK(records["plain"] == 0);
  CHECK(records["wide"] > 0);
  CHECK(records["narrow"] > records["wide"]);
  std::ifstream page(folder + "/report.html");
  const std::string html((std::istreambuf_iterator<char>(page)), {});
  CHECK_THAT(html, Contains("cornell: true error of the whole picture against records"));
}

TEST_CASE("bench keeps finished results at Ctrl-C, and continues from there") {
  const Place place;
  const std::string folder = place / "r";
  // Results that take so long that the signal always arrives during one.
  const std::string matrix = place.matrix("m.json", 1 << 20, 16);
  const Run stopped = interrupt_at("2 of 10", "bench " + matrix + " --report " + folder, place / "log");
  INFO(stopped.out);
  CHECK(stopped.status == 130);
  CHECK_THAT(stopped.out, Contains("interrupted; 0 of 9 renders are kept"));
  CHECK(fs::exists(folder + "/references/cornell-16x16.exr"));
  CHECK(count_files(folder + "/cells") == 0);
  const auto report = read_json(folder + "/report.json");
  CHECK(report["complete"] == false);
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    CHECK_FALSE(entry.path().filename().string().starts_with("."));
  const Run further = interrupt_at("1 of 9", "bench " + matrix + " --report " + folder, place / "log");
  INFO(further.out);
  CHECK(further.status == 130);
  CHECK_THAT(further.out, Contains("1 of 9") && !Contains("reference of"));
}

TEST_CASE("bench refuses invalid input before any work") {
  const Place place;
  const std::string good = place.matrix("m.json", 16, 64);
  refused("", "name one matrix");
  refused("--quick --full", "name one matrix");
  refused("--quick --cache", "name one matrix");
  refused("--full --cache", "name one matrix");
  refused(good + " --indirect", "name one matrix");
  refused(place / "no.json", "no.json");
  std::ofstream(place / "bad.json") << "{\"scenes\": [],\n \"setings\": []}";
  refused(place / "bad.json", "unknown key 'setings'");
  std::ofstream(place / "half.json") << "{\"scenes\": [";
  refused(place / "half.json", "line 1");
  refused(good + " --report /proc/nowhere", "/proc/nowhere");
  refused(good + " --report " + good, "is a file");
  std::ofstream(place / "letter.txt") << "dear";
  refused(good + " --report " + place.path.string(), "which no bench made");
  refused(good + " --repeats 0 --report " + (place / "r"), "--repeats");
  refused(good + " --device nothing --report " + (place / "r"), "nothing");
  CHECK_FALSE(fs::exists(place / "r"));
  refused("--compare " + (place / "a") + " " + (place / "b"), "cannot be read");
  refused("--compare " + (place / "a"), "--compare");
  refused("--page " + (place / "a"), "cannot be read");
  refused("rays", "SCENE");
}

}  // namespace bench_tests
