// links: film_io
// Cache files on the command line: a render with a saved cache gives the same picture without gathering; an
// unsuitable file gives one located error line and status 1.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "film/io/image_file.h"
#include "support/folder.h"
#include "support/run.h"

namespace cache_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using Catch::Contains;

namespace {

struct Folder : test::Folder {
  std::string operator/(const char* name) const { return (path / name).string(); }
};

const std::string k_scene = std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf";
const std::string k_cached =
    " --size 48x48 --samples 4 --quiet --set components.secondary=cache --set components.tertiary=cache ";

}  // namespace

TEST_CASE("a picture rendered with a saved cache is the same, and gathers nothing") {
  const Folder f;
  const test::Run made = test::run("render " + k_scene + k_cached + "-o " + (f / "a.exr") + " --stats " +
                                   (f / "a.json") + " --cache-save " + (f / "a.cache"));
  INFO(made.out);
  REQUIRE(made.status == 0);
  const test::Run used =
      test::run("render " + k_scene + k_cached + "-o " + (f / "b.exr") + " --stats " + (f / "b.json") +
                " --cache-load " + (f / "a.cache") + " --cache-save " + (f / "b.cache"));
  INFO(used.out);
  REQUIRE(used.status == 0);
  const film::FilmImage a = film::read_exr(f / "a.exr"), b = film::read_exr(f / "b.exr");
  CHECK(a.channels == b.channels);
  CHECK(read_file(f / "a.cache") == read_file(f / "b.cache"));
  const auto first = nlohmann::json::parse(read_file(f / "a.json")),
             second = nlohmann::json::parse(read_file(f / "b.json"));
  CHECK(first["cache"]["loaded"] == 0);
  CHECK(second["cache"]["loaded"] == first["cache"]["records"]);
  CHECK(second["cache"]["records"] == first["cache"]["records"]);
  CHECK(second["ledger"].back()["prepared_s"] == 0);
  CHECK(second["rays"] < first["rays"]);

  // Records only: no picture is requested, and none is rendered.
  const test::Run only = test::run("render " + k_scene +
                                   " --size 48x48 --samples 1000000 --quiet --set components.secondary=cache "
                                   "--set components.tertiary=cache --cache-save " +
                                   (f / "c.cache"));
  INFO(only.out);
  CHECK(only.status == 0);
  CHECK(read_file(f / "c.cache") == read_file(f / "a.cache"));

  // An unsuitable file; the output file is not touched.
  const std::string kept = read_file(f / "b.cache");
  const auto refused = [&](const std::string& arguments, const std::string& expected) {
    const test::Run r =
        test::run("render " + arguments + " -o " + (f / "never.exr") + " --cache-save " + (f / "b.cache"));
    INFO(r.out);
    CHECK(r.status == 1);
    CHECK_THAT(r.out, Contains("lucerna: ") && Contains(expected));
    CHECK(std::count(r.out.begin(), r.out.end(), '\n') == 1);
    CHECK_FALSE(fs::exists(f / "never.exr"));
    CHECK(read_file(f / "b.cache") == kept);
  };
  const std::string with = "--cache-load " + (f / "a.cache"), a_cache = f / "a.cache";
  refused(k_scene + k_cached + with + " --set cache.error=0.2",
          a_cache + ": its records were made with cache.error = 0.3 (now 0.2)");
  refused(std::string(LUCERNA_SOURCE_DIR) + "/scenes/glass/glass.gltf" + k_cached + with,
          a_cache + ": records of another scene ('cornell', this is 'glass')");
  refused(k_scene + k_cached + "--cache-load " + (f / "none.cache"), "none.cache: cannot be read");
  refused(k_scene + k_cached + "--cache-load " + (f / "a.exr"), "a.exr: not an irradiance cache");
  refused(k_scene + " --size 48x48 --quiet " + with, "no component is computed by 'cache'");
  refused(k_scene + " --size 48x48 --quiet", "--cache-save: no component is computed by 'cache'");
  const test::Run nowhere =
      test::run("render " + k_scene + k_cached + "--cache-save " + (f / "no/such/folder/a.cache"));
  CHECK(nowhere.status == 1);
  CHECK_THAT(nowhere.out, Contains("no/such/folder/a.cache: cannot be written: No such file or directory"));
}

}  // namespace cache_tests
