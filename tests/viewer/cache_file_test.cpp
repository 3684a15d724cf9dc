// links: film_io
// Cache files in the window: a script saves a cache as soon as it is complete and loads it again.
#include "support.h"

#include <fstream>

namespace cache_file_tests {

using namespace lucerna;

TEST_CASE("a script saves the cache when it is complete, loads it, and continues if one is refused") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  std::ofstream(file("broken.cache")) << "LUCCACHE and no more";
  const auto outcome = test::program(
      "-v scenes/cornell/cornell.gltf",
      "window.size 1100 700\nwait_scene\n"
      "view.size 64 48\nset components.secondary cache\nset components.tertiary cache\ncache.save " +
          file("a.cache") +  // not complete yet: waits
          "\ncache.load " + file("a.cache") + "\ncache.save " + file("b.cache") + "\ncache.load " +
          file("broken.cache") + "\nset cache.error 0.4\ncache.load " + file("a.cache") + "\ncache.save " +
          file("c.cache") + "\nscript.save " + file("session.lucerna") + "\nquit 0\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const auto read = [&](const char* name) { return read_file(file(name)); };
  CHECK_THAT(outcome.output,
             Catch::Contains("a.cache: will be written when the irradiance cache is complete"));
  CHECK_THAT(outcome.output, Catch::Contains("complete for this view"));
  CHECK_THAT(outcome.output, Catch::Contains("broken.cache: cut short"));
  CHECK_THAT(outcome.output, Catch::Contains("its records were made with cache.error = 0.3 (now 0.4)"));
  CHECK(read("a.cache").size() > 10000);
  CHECK(read("b.cache") == read("a.cache"));
  CHECK(read("c.cache").size() > 10000);
  CHECK_THAT(read("session.lucerna"),
             Catch::Contains("cache.save " + file("a.cache") + "\ncache.load " + file("a.cache") + "\n"));
}

}  // namespace cache_file_tests
