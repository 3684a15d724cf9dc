// links: base
// lucerna bench --photons in use, at tiny sizes: measurement, continuation, and refusals.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/folder.h"
#include "support/run.h"

namespace bench_photons_tests {

namespace fs = std::filesystem;
using Catch::Contains;
using lucerna::test::Run;
using lucerna::test::run;

namespace {

nlohmann::json read_json(const fs::path& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in);
}

}  // namespace

TEST_CASE("bench --photons measures slopes, passes, lamps and the cost of unneeded photons") {
  const lucerna::test::Folder place;
  const std::string folder = (place / "r").string(),
                    small =
                        "bench --photons --side 16 --seeds 3 --rounds 8 --reference-samples 2 --paths "
                        "2000,20000 --lamps 1,9 --repeats 1 --pairs 1 --report " +
                        folder;
  const Run first = run(small);
  INFO(first.out);
  REQUIRE(first.status == 0);
  CHECK_THAT(first.out, Contains("glass, caustic, floor off: ") && Contains("noise over rounds") &&
                            Contains("B a million photons") && Contains("at 1 lamps") &&
                            Contains("nothing to bundle light") &&
                            Contains("1 of 26  glass, caustic, truth 1 of 3"));
  const auto report = read_json(fs::path(folder) / "report.json");
  REQUIRE(report["slopes"].size() == 5);
  for (const auto& s : report["slopes"]) {
    INFO(s["series"]);
    CHECK(s["pixels"] > 16);
    REQUIRE(s["points"].size() >= 4);
    for (const auto& p : s["points"]) CHECK(p["noise"] > 0);
    // Discs as wide as these pictures' pixels require are limited to the same size.
    if (s["over"] == "rounds") CHECK(s["points"].back()["noise"] < s["points"][0]["noise"]);
  }
  REQUIRE(report["rounds"].size() == 2);
  for (const auto& r : report["rounds"]) {
    CHECK(r["photons"] > 0);
    CHECK(r["emitted_per_s"] > 0);
    CHECK(r["sorted_per_s"] > 0);
    CHECK(r["gathered_per_s"] > 0);
    CHECK(r["build_share"] > 0);
    CHECK(r["build_share"] < 1);
  }
  const double few = report["rounds"][0]["photons"], many = report["rounds"][1]["photons"];
  CHECK(many == Approx(10 * few).epsilon(0.2));
  CHECK(report["lamps"][1]["lamps"] == 9);
  CHECK(report["lamps"][1]["photons"] > 0);
  CHECK(report["free"]["light_paths"] == 0);
  CHECK(report["free"]["rays"] == report["free"]["rays_with_photons"]);
  CHECK(fs::exists(fs::path(folder) / "report.html"));
  CHECK(fs::exists(fs::path(folder) / "report.txt"));

  // One unit is missing: it is measured, and figures independent of the clock stay the same.
  fs::remove(fs::path(folder) / "units" / "truth-glass-caustic-2.exr");
  const Run again = run(small);
  INFO(again.out);
  CHECK(again.status == 0);
  CHECK_THAT(again.out, Contains("1 of 1  glass, caustic, truth 2 of 3"));
  CHECK(read_json(fs::path(folder) / "report.json")["slopes"] == report["slopes"]);

  const auto refused = [&](const std::string& arguments, const std::string& expected) {
    const Run r = run(arguments);
    INFO(arguments << "\n" << r.out);
    CHECK(r.status == 1);
    CHECK_THAT(r.out, Contains(expected));
  };
  refused("bench --photons --rounds 16 --report " + folder, "differs at");
  refused("bench --photons --rounds 12 --report " + folder + "2", "expected a power of two");
  refused("bench --photons --seeds 2", "--seeds");
  refused("bench --photons --parts everything", "--parts");
  refused("bench --photons --paths 0", "--paths");
}

TEST_CASE("bench --photons keeps finished parts when interrupted, and continues from there") {
  const lucerna::test::Folder place;
  const std::string folder = (place / "r").string(),
                    small = "bench --photons --parts lamps,free --lamps 1 --pairs 40 --repeats 1 --report " +
                            folder;
  lucerna::test::Running bench(small);
  REQUIRE(bench.says("2 of 2"));
  bench.send(SIGINT);
  const Run r = bench.finish();
  INFO(r.out);
  CHECK(r.status == 128 + SIGINT);
  CHECK_THAT(r.out, Contains("interrupted; finished parts are kept"));
  CHECK(fs::exists(fs::path(folder) / "units" / "lamps-1.json"));
  CHECK_FALSE(fs::exists(fs::path(folder) / "units" / "free.json"));
}

}  // namespace bench_photons_tests
