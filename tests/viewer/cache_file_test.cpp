// links: film_io
// Caches as files in the window: a script saves one as soon as it is complete and loads it again.
#include "support.h"

#include <catch2/catch.hpp>
#include <fstream>

using namespace lucerna;

TEST_CASE("a script saves the cache when it is complete, loads it, and goes on when one is refused") {
  if (!std::filesystem::exists(LUCERNA_BINARY) || test::with_display("x").empty()) {
    WARN("skipped: no program, or neither a display nor xvfb-run");
    return;
  }
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  std::ofstream(file("broken.cache")) << "LUCCACHE and no more";
  std::ofstream(file("steps.txt"))
      << "window.size 1100 700\nwait_scene\n"
      << "cache.save " << file("early.cache") << "\n"  // there is none
      << "view.size 64 48\nset components.secondary cache\nset components.tertiary cache\n"
      << "cache.save " << file("a.cache") << "\n"  // it is not there yet: waits
      << "cache.load " << file("a.cache") << "\ncache.save " << file("b.cache") << "\n"
      << "cache.load " << file("broken.cache") << "\nset cache.error 0.4\ncache.load " << file("a.cache")
      << "\ncache.save " << file("c.cache") << "\nscript.save " << file("session.lucerna") << "\nquit\n";
  const auto outcome =
      test::run(test::with_display(std::string(LUCERNA_BINARY) + " -v scenes/cornell/cornell.gltf --script " +
                                   file("steps.txt")),
                300);
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const auto read = [&](const char* name) {
    std::ifstream in(file(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  CHECK_THAT(outcome.output, Catch::Contains("early.cache: there is no cache to save"));
  CHECK_THAT(outcome.output, Catch::Contains("a.cache: will be written when the cache is complete"));
  CHECK_THAT(outcome.output, Catch::Contains("complete for this view"));
  CHECK_THAT(outcome.output, Catch::Contains("broken.cache: cut short"));
  CHECK_THAT(outcome.output, Catch::Contains("its records were made with cache.error = 0.3 (now 0.4)"));
  CHECK_FALSE(std::filesystem::exists(file("early.cache")));
  CHECK(read("a.cache").size() > 10000);
  CHECK(read("b.cache") == read("a.cache"));
  CHECK(read("c.cache").size() > 10000);
  CHECK_THAT(read("session.lucerna"),
             Catch::Contains("cache.save " + file("a.cache") + "\ncache.load " + file("a.cache") + "\n"));
}
