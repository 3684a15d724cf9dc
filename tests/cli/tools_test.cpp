// links: base
// The developer tools (tests/tools): what they print, write and refuse.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/run.h"

namespace tools_tests {

namespace fs = std::filesystem;
using lucerna::test::Run;
using lucerna::test::run_command;

namespace {

Run run(const std::string& arguments) {
  return run_command(
      (fs::path(LUCERNA_BINARY).parent_path().parent_path() / "tests" / "lucerna-tools").string() + " " +
      arguments);
}

struct File {
  std::string path =
      (fs::temp_directory_path() / ("lucerna-bench-" + std::to_string(getpid()) + ".json")).string();
  ~File() { fs::remove(path); }
  std::string text() const {
    std::stringstream all;
    all << std::ifstream(path).rdbuf();
    return all.str();
  }
};

void check_parts(const std::string& text, std::initializer_list<const char*> parts) {
  for (const char* part : parts) {
    INFO(part << " in\n" << text);
    CHECK(text.find(part) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("the tool for sorts prints rates and factors, and writes them") {
  const File file;
  const Run r = run("sort --sizes 1000 3 --repeats 5 --json " + file.path);
  CHECK(r.status == 0);
  check_parts(r.out, {"prefix sum", "std::exclusive_scan", "std::stable_sort", "sort, 24 of 32 bits",
                      "sort, 64 of 64 bits", "factor 1.00"});
  check_parts(file.text(), {"\"elements_per_s\"", "\"median\"", "\"size\": 1000", "\"size\": 3"});
  CHECK(run("sort --sizes 0").status == 1);
  CHECK(run("sort --repeats 4").status == 1);
  CHECK(run("sort --sizes 10 --json /no/such/folder/x.json").status == 1);
}

TEST_CASE("the tool for lookups finds the same spheres with every method, and writes the times") {
  const File file;
  const Run r = run("lookup --sizes 300 --queries 2000 --repeats 1 --json " + file.path);
  INFO(r.out);
  CHECK(r.status == 0);
  check_parts(r.out, {"300 photons", "300 records", "octree", "27 cells", "references per sphere"});
  check_parts(file.text(), {"\"queries_per_s\"", "\"references_per_sphere\"", "\"found_per_query\""});
  CHECK(run("lookup --sizes 0").status == 1);
}

TEST_CASE("the tool for interpolation reports the methods of limiting overlap in a scene, and their cost") {
  const File file;
  const std::string scene = std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf";
  const Run r = run("interpolation " + scene +
                    " --width 48 --height 48 --repeats 1 --set cache.rays=64 --set cache.max_rays=64 --set "
                    "cache.min_radius=1 --json " +
                    file.path);
  INFO(r.out);
  CHECK(r.status == 0);
  check_parts(r.out, {"as they were placed", "thinned", "M lookups/s"});
  const auto json = nlohmann::json::parse(file.text());
  REQUIRE(json["ways"].size() == 2);
  // Thinning leaves fewer records, and fewer records per pixel.
  const auto serving = [&](size_t way) { return json["ways"][way]["served_by_mean"].get<double>(); };
  CHECK(json["ways"][1]["records"] < json["ways"][0]["records"]);
  CHECK(serving(1) < serving(0));
  CHECK(run("interpolation /no/such.gltf").status == 1);
  CHECK(run("interpolation " + scene + " --set cache.thinning=2").status == 1);
  CHECK(run("interpolation " + scene + " --set nothing").status == 1);
}

}  // namespace tools_tests
