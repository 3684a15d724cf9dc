// links: film_io
// lucerna bench latency in use.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/run.h"

namespace bench_latency_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using Catch::Contains;
using test::run;
using test::Run;

TEST_CASE("latency of every edit of a small picture is measured, printed and written; references are kept") {
  const fs::path folder = fs::temp_directory_path() / ("lucerna-cli-latency-" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string where = folder.string();
  const std::string arguments =
      "cornell --size 48x48 --seconds 1.2 --settle 30 --reference-samples 16 --reference-solver cache "
      "--solvers cache "
      "--edits load,strength,material,camera,solver --set cache.passes=2 --references " +
      where + "/references --json " + where + "/latency.json --pictures " + where + "/pictures";
  const Run first = run("bench --latency " + arguments);
  INFO(first.out);
  REQUIRE(first.status == 0);
  CHECK_THAT(first.out, Contains("usable") && Contains("set back") && Contains("rendering the reference"));
  std::ifstream in(where + "/latency.json");
  const nlohmann::json j = nlohmann::json::parse(in);
  size_t measured = 0;
  for (const auto& row : j["rows"]) {
    ++measured;
    CHECK(row["solver"] == "cache");
    CHECK(row["error"]["1"].is_number());
    CHECK(row["error"]["3"].is_null());  // it was not watched for that long
  }
  CHECK(measured >= 4);  // the scene may have no lamp that can be dimmed
  CHECK(fs::exists(folder / "pictures" / "cornell-cache-camera-01.0s.png"));

  const Run second = run("bench latency " + arguments);
  INFO(second.out);
  CHECK(second.status == 0);
  CHECK_THAT(second.out, !Contains("rendering the reference"));
  fs::remove_all(folder);
}

TEST_CASE("bench latency reports unsupported arguments") {
  const auto refused = [](const std::string& arguments, const std::string& expected) {
    const Run r = run("bench latency " + arguments);
    INFO(arguments << "\n" << r.out);
    CHECK(r.status == 1);
    CHECK_THAT(r.out, Contains(expected));
  };
  refused("cornell --edits lamp", "there is no edit 'lamp'");
  refused("cornell --size 12", "expected WIDTHxHEIGHT");
  refused("cornell --set film.ev", "expected KEY=VALUE");
  refused("cornell --set cache.no_such_key=1", "cache.no_such_key");
  refused("cornell --set film.ev=bright", "film.ev");
  refused("no-such-scene", "no-such-scene");
}

}  // namespace bench_latency_tests
